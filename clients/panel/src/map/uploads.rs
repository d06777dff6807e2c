//! Brings floor plan and swept area into their textures.

use panel_logic::{MapPalette, plan_pixels};
use web_sys::WebGl2RenderingContext as Gl;

use super::renderer::Renderer;
use super::scene::Scene;

impl Renderer {
    pub(super) fn upload_plan(&mut self, scene: &mut Scene, palette: &MapPalette) {
        if !std::mem::take(&mut scene.plan_changed) {
            return;
        }
        if let Some(relief) = &mut self.relief {
            relief.expect_another_plan();
        }
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.plan));
        let drawn = scene.plan().and_then(|plan| {
            let pixels = plan_pixels(plan, palette.plan)?;
            Some((plan.width as i32, plan.height as i32, pixels))
        });
        let (width, height, pixels) = drawn.unwrap_or_else(|| (1, 1, vec![0; 4]));
        let rgba = Gl::RGBA8 as i32;
        self.gl
            .tex_image_2d_with_i32_and_i32_and_i32_and_format_and_type_and_opt_u8_array(
                Gl::TEXTURE_2D,
                0,
                rgba,
                width,
                height,
                0,
                Gl::RGBA,
                Gl::UNSIGNED_BYTE,
                Some(&pixels),
            )
            .ok(); // It only fails for pixels of the wrong number.
        self.gl.generate_mipmap(Gl::TEXTURE_2D);
    }

    pub(super) fn upload_swept(&self, scene: &mut Scene) {
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.swept));
        let (width, height) = scene.swept.size();
        if scene.swept.take_resized() || width == 0 {
            let cells = if width == 0 { &[0][..] } else { scene.swept.bytes() };
            self.gl.pixel_storei(Gl::UNPACK_ALIGNMENT, 1);
            self.gl
                .tex_image_2d_with_i32_and_i32_and_i32_and_format_and_type_and_opt_u8_array(
                    Gl::TEXTURE_2D,
                    0,
                    Gl::R8 as i32,
                    width.max(1),
                    height.max(1),
                    0,
                    Gl::RED,
                    Gl::UNSIGNED_BYTE,
                    Some(cells),
                )
                .ok(); // It only fails for cells of the wrong number.
            return;
        }
        let Some(rows) = scene.swept.take_dirty() else {
            return;
        };
        let cells = scene.swept.rows(rows);
        self.gl
            .tex_sub_image_2d_with_i32_and_i32_and_u32_and_type_and_opt_u8_array(
                Gl::TEXTURE_2D,
                0,
                0,
                rows.first as i32,
                width,
                (rows.end - rows.first) as i32,
                Gl::RED,
                Gl::UNSIGNED_BYTE,
                Some(cells),
            )
            .ok(); // It only fails for cells of the wrong number.
    }
}
