//! Draws the scene: one pass for the ground, one each for walls, path and planned way, one for
//! bumps, one for doors, dock and robot.

use panel_logic::{Bounds, Camera, plan_pixels};
use rvac_api::Pose;
use web_sys::{HtmlCanvasElement, WebGl2RenderingContext as Gl, WebGlTexture, WebGlVertexArrayObject};

use super::gl::{GlError, GrowingBuffer, Look, Program, texture};
use super::palette::Palette;
use super::scene::{Ground, Places, Redraw, Scene};
use super::shaders;

/// Numbers an instance of a mark has: place, heading, size, kind.
const MARK_NUMBERS: i32 = 5;

/// Kinds of marks as the shader knows them.
const BUMP: f32 = 0.0;
const CLIFF: f32 = 1.0;
const ROBOT: f32 = 2.0;
const TRUE_PLACE: f32 = 3.0;
const DOCK: f32 = 4.0;
const DOOR: f32 = 5.0;
const UNCERTAINTY: f32 = 6.0;

/// Marks and lines reach this far beyond their place, in CSS pixels.
const MARGIN_PX: f64 = 12.0;

/// Radius of a bump mark in CSS pixels.
const BUMP_RADIUS_PX: f64 = 4.5;

/// Everything that lives in graphics memory.
#[derive(Debug)]
pub(crate) struct Renderer {
    gl: Gl,
    ground: Program,
    line: Program,
    mark: Program,
    plan: WebGlTexture,
    swept: WebGlTexture,
    path: GrowingBuffer,
    path_layout: WebGlVertexArrayObject,
    walls: GrowingBuffer,
    walls_layout: WebGlVertexArrayObject,
    way: GrowingBuffer,
    way_layout: WebGlVertexArrayObject,
    bumps: GrowingBuffer,
    bumps_layout: WebGlVertexArrayObject,
    bodies: GrowingBuffer,
    bodies_layout: WebGlVertexArrayObject,
    empty_layout: WebGlVertexArrayObject,
}

/// The camera as the shaders want it.
#[derive(Clone, Copy, Debug)]
struct Eye {
    view: [f32; 4],
    pixel: [f32; 2],
    scale: f32,
    ratio: f64,
}

impl Eye {
    fn of(camera: &Camera, gl: &Gl) -> Self {
        let view = camera.view();
        let (x, y) = camera.middle();
        let (width, height) = (
            f64::from(gl.drawing_buffer_width()),
            f64::from(gl.drawing_buffer_height()),
        );
        let ratio = width / view.width;
        let clip = |pixels: f64| (2.0 * camera.scale() / pixels) as f32;
        Self {
            view: [x as f32, y as f32, clip(view.width), clip(view.height)],
            pixel: [(2.0 / width) as f32, (2.0 / height) as f32],
            scale: (camera.scale() * ratio) as f32,
            ratio,
        }
    }
}

impl Renderer {
    pub(crate) fn new(gl: &Gl) -> Result<Self, GlError> {
        let ground_uniforms = [
            "view",
            "plan",
            "swept",
            "plan_pose",
            "plan_size",
            "swept_box",
            "outside_colour",
            "grid_colour",
            "swept_colour",
            "scale",
        ];
        let mark_uniforms = [
            "view",
            "scale",
            "mark_colour",
            "body_colour",
            "front_colour",
            "halo_colour",
            "thought_colour",
        ];
        let line_uniforms = ["view", "pixel", "half_width", "line_colour"];
        let layout = || {
            gl.create_vertex_array()
                .ok_or_else(|| GlError("no vertex array".to_owned()))
        };
        let renderer = Self {
            gl: gl.clone(),
            ground: Program::new(
                gl,
                [shaders::GROUND_VERTEX, shaders::GROUND_FRAGMENT],
                &ground_uniforms,
            )?,
            line: Program::new(gl, [shaders::LINE_VERTEX, shaders::LINE_FRAGMENT], &line_uniforms)?,
            mark: Program::new(gl, [shaders::MARK_VERTEX, shaders::MARK_FRAGMENT], &mark_uniforms)?,
            plan: texture(gl, Look::Cells)?,
            swept: texture(gl, Look::Smooth)?,
            path: GrowingBuffer::new(gl)?,
            path_layout: layout()?,
            walls: GrowingBuffer::new(gl)?,
            walls_layout: layout()?,
            way: GrowingBuffer::new(gl)?,
            way_layout: layout()?,
            bumps: GrowingBuffer::new(gl)?,
            bumps_layout: layout()?,
            bodies: GrowingBuffer::new(gl)?,
            bodies_layout: layout()?,
            empty_layout: layout()?,
        };
        renderer.describe_layouts();
        Ok(renderer)
    }

    /// A segment of the path reads two points that overlap with those of its neighbours, one of walls or the planned way two
    /// of its own; a mark reads its five numbers.
    fn describe_layouts(&self) {
        let gl = &self.gl;
        let attribute = |place: u32, size: i32, [stride, offset]: [i32; 2]| {
            gl.enable_vertex_attrib_array(place);
            gl.vertex_attrib_pointer_with_i32(place, size, Gl::FLOAT, false, stride, offset);
            gl.vertex_attrib_divisor(place, 1);
        };
        gl.bind_vertex_array(Some(&self.path_layout));
        self.path.bind();
        attribute(0, 2, [8, 0]);
        attribute(1, 2, [8, 8]);
        for (layout, buffer) in [(&self.walls_layout, &self.walls), (&self.way_layout, &self.way)] {
            gl.bind_vertex_array(Some(layout));
            buffer.bind();
            attribute(0, 2, [16, 0]);
            attribute(1, 2, [16, 8]);
        }
        for (layout, buffer) in [
            (&self.bumps_layout, &self.bumps),
            (&self.bodies_layout, &self.bodies),
        ] {
            gl.bind_vertex_array(Some(layout));
            buffer.bind();
            attribute(0, 4, [MARK_NUMBERS * 4, 0]);
            attribute(1, 1, [MARK_NUMBERS * 4, 16]);
        }
        gl.bind_vertex_array(None);
    }

    /// Draws one frame, or as much of it as changed.
    pub(crate) fn draw(&mut self, scene: &mut Scene, places: Places, redraw: Redraw) {
        let resized = self.fit_canvas(&scene.camera);
        let palette = Palette::of(scene.theme);
        let eye = Eye::of(&scene.camera, &self.gl);
        self.upload_plan(scene, &palette);
        self.upload_swept(scene);
        self.gl.viewport(
            0,
            0,
            self.gl.drawing_buffer_width(),
            self.gl.drawing_buffer_height(),
        );
        match redraw {
            Redraw::Nothing => return,
            Redraw::Area(bounds) if !resized => self.limit_to(bounds, &scene.camera, eye),
            Redraw::Area(_) | Redraw::All => self.gl.disable(Gl::SCISSOR_TEST),
        }
        self.gl.disable(Gl::BLEND);
        self.draw_ground(scene, &palette, eye);
        self.gl.enable(Gl::BLEND);
        self.gl.blend_func(Gl::ONE, Gl::ONE_MINUS_SRC_ALPHA);
        self.draw_lines(scene, &palette, eye);
        self.draw_marks(scene, places, (&palette, eye));
        self.gl.bind_vertex_array(None);
    }

    /// Leaves everything as it is but these bounds and a margin for marks of a fixed size.
    fn limit_to(&self, bounds: Bounds, camera: &Camera, eye: Eye) {
        let (left, top) = camera.screen_from_map(bounds.x_min, bounds.y_max);
        let (right, bottom) = camera.screen_from_map(bounds.x_max, bounds.y_min);
        let device = |pixels: f64| (pixels * eye.ratio) as i32;
        let margin = MARGIN_PX;
        let (x, y) = (
            device(left - margin),
            self.gl.drawing_buffer_height() - device(bottom + margin),
        );
        self.gl.enable(Gl::SCISSOR_TEST);
        self.gl.scissor(
            x,
            y,
            device(right - left + 2.0 * margin),
            device(bottom - top + 2.0 * margin),
        );
    }

    /// Gives the canvas as many pixels as it covers on the screen, at most four a CSS pixel. True when that emptied it.
    fn fit_canvas(&self, camera: &Camera) -> bool {
        use wasm_bindgen::JsCast;
        let Some(canvas) = self
            .gl
            .canvas()
            .and_then(|canvas| canvas.dyn_into::<HtmlCanvasElement>().ok())
        else {
            return false;
        };
        let ratio = leptos::prelude::window().device_pixel_ratio().clamp(1.0, 2.0);
        let view = camera.view();
        let (width, height) = (
            (view.width * ratio).round() as u32,
            (view.height * ratio).round() as u32,
        );
        let resized = canvas.width() != width || canvas.height() != height;
        if resized {
            canvas.set_width(width);
            canvas.set_height(height);
        }
        resized
    }

    fn upload_plan(&self, scene: &mut Scene, palette: &Palette) {
        if !std::mem::take(&mut scene.plan_changed) {
            return;
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

    fn upload_swept(&self, scene: &mut Scene) {
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

    fn draw_ground(&self, scene: &Scene, palette: &Palette, eye: Eye) {
        let program = &self.ground;
        program.select();
        self.gl.active_texture(Gl::TEXTURE1);
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.swept));
        self.gl.active_texture(Gl::TEXTURE0);
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.plan));
        program.set_sampler("plan", 0);
        program.set_sampler("swept", 1);
        program.set("view", &eye.view);
        program.set("scale", &[eye.scale]);
        program.set("outside_colour", &palette.outside);
        program.set("grid_colour", &palette.grid);
        program.set("swept_colour", &palette.swept);
        if let Some(plan) = scene.plan() {
            let (sin, cos) = plan.origin.heading.sin_cos();
            program.set(
                "plan_pose",
                &[plan.origin.x as f32, plan.origin.y as f32, cos as f32, sin as f32],
            );
            let side = |cells: u32| (f64::from(cells) * plan.cell_m) as f32;
            program.set("plan_size", &[side(plan.width), side(plan.height)]);
        } else {
            program.set("plan_pose", &[0.0, 0.0, 1.0, 0.0]);
            program.set("plan_size", &[1.0, 1.0]);
        }
        let (x0, y0) = scene.swept.origin();
        let (width, height) = scene.swept.size();
        let metres = |cells: i32| (f64::from(cells) * scene.cell_m) as f32;
        program.set(
            "swept_box",
            &[
                metres(x0),
                metres(y0),
                metres(width.max(1)),
                metres(height.max(1)),
            ],
        );
        self.gl.bind_vertex_array(Some(&self.empty_layout));
        self.gl.draw_arrays(Gl::TRIANGLE_STRIP, 0, 4);
    }

    fn draw_lines(&mut self, scene: &mut Scene, palette: &Palette, eye: Eye) {
        if std::mem::take(&mut scene.path_restarted) {
            self.path.restart();
        }
        self.path.catch_up(&scene.path);
        if std::mem::take(&mut scene.strokes_changed) {
            self.walls.restart();
            self.walls.catch_up(&scene.walls);
            self.way.restart();
            self.way.catch_up(&scene.way);
        }
        self.line.select();
        self.line.set("view", &eye.view);
        self.line.set("pixel", &eye.pixel);
        let walls = if scene.ground() == Ground::Known {
            scene.walls.len() / 4
        } else {
            0
        };
        let segments = (scene.path.len() / 2).saturating_sub(1);
        for (layout, segments, (half_width_px, colour)) in [
            (&self.walls_layout, walls, (1.0, &palette.wall)),
            (&self.path_layout, segments, (0.8, &palette.path)),
            (&self.way_layout, scene.way.len() / 4, (1.0, &palette.thought)),
        ] {
            if segments > 0 {
                self.line.set("half_width", &[(half_width_px * eye.ratio) as f32]);
                self.line.set("line_colour", colour);
                self.gl.bind_vertex_array(Some(layout));
                self.gl
                    .draw_arrays_instanced(Gl::TRIANGLE_STRIP, 0, 4, segments as i32);
            }
        }
    }

    fn draw_marks(&mut self, scene: &Scene, places: Places, (palette, eye): (&Palette, Eye)) {
        self.mark.select();
        self.mark.set("view", &eye.view);
        self.mark.set("scale", &[eye.scale]);
        self.mark.set("mark_colour", &palette.mark);
        self.mark.set("body_colour", &palette.body);
        self.mark.set("front_colour", &palette.front);
        self.mark.set("halo_colour", &palette.halo);
        self.mark.set("thought_colour", &palette.thought);
        let bumps = bump_marks(scene, eye.ratio);
        let bodies = body_marks(scene, places);
        self.bumps.restart();
        self.bumps.catch_up(&bumps);
        self.bodies.restart();
        self.bodies.catch_up(&bodies);
        for (layout, numbers) in [
            (&self.bumps_layout, bumps.len()),
            (&self.bodies_layout, bodies.len()),
        ] {
            let instances = numbers as i32 / MARK_NUMBERS;
            if instances > 0 {
                self.gl.bind_vertex_array(Some(layout));
                self.gl.draw_arrays_instanced(Gl::TRIANGLE_STRIP, 0, 4, instances);
            }
        }
    }
}

/// Radius of the mark in a door, of its width: a hint, and no obstacle to the eye.
const DOOR_SHARE: f64 = 0.25;

/// A negative size is one in device pixels.
fn bump_marks(scene: &Scene, ratio: f64) -> Vec<f32> {
    let size = -(BUMP_RADIUS_PX * ratio) as f32;
    let mark = |bump: &rvac_api::BumpMark| {
        let kind = if bump.contact { BUMP } else { CLIFF };
        [bump.x as f32, bump.y as f32, 0.0, size, kind]
    };
    scene.bumps.iter().flat_map(mark).collect()
}

fn body_marks(scene: &Scene, places: Places) -> Vec<f32> {
    let radius = scene.body_radius_m();
    let mark = |pose: Pose, size: f64, kind: f32| {
        [
            pose.x as f32,
            pose.y as f32,
            pose.heading as f32,
            size as f32,
            kind,
        ]
    };
    let dock = scene
        .plan()
        .and_then(|plan| plan.dock)
        .map(|pose| mark(pose, radius * 0.8, DOCK));
    let doors = scene.doors().map(|door| {
        let at = Pose {
            x: door.x,
            y: door.y,
            ..Pose::default()
        };
        mark(at, DOOR_SHARE * door.width_m, DOOR)
    });
    let spread = scene.uncertainty_m();
    let spread = places
        .believed
        .filter(|_| spread > 0.0)
        .map(|pose| mark(pose, spread, UNCERTAINTY));
    let truth = places.truth.map(|pose| mark(pose, radius, TRUE_PLACE));
    let robot = places.believed.map(|pose| mark(pose, radius, ROBOT));
    let bodies = [dock, spread, robot, truth].into_iter().flatten();
    doors.chain(bodies).flatten().collect()
}
