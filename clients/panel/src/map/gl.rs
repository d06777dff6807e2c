//! The few wrappers around WebGL2 that the renderer needs.

use js_sys::Float32Array;
use web_sys::{
    WebGl2RenderingContext as Gl, WebGlBuffer, WebGlProgram, WebGlTexture, WebGlUniformLocation,
    WebGlVertexArrayObject,
};

/// Why the map cannot be drawn, in the words of the graphics driver.
#[derive(Clone, Debug)]
pub(crate) struct GlError(pub(crate) String);

/// A linked program with its uniforms.
#[derive(Debug)]
pub(crate) struct Program {
    gl: Gl,
    program: WebGlProgram,
    uniforms: Vec<(&'static str, WebGlUniformLocation)>,
}

impl Program {
    /// Compiles and links. `uniforms` are the names that will be set.
    pub(crate) fn new(gl: &Gl, sources: [&str; 2], uniforms: &[&'static str]) -> Result<Self, GlError> {
        let program = gl
            .create_program()
            .ok_or_else(|| GlError("no program".to_owned()))?;
        for (kind, source) in [Gl::VERTEX_SHADER, Gl::FRAGMENT_SHADER].into_iter().zip(sources) {
            let shader = gl
                .create_shader(kind)
                .ok_or_else(|| GlError("no shader".to_owned()))?;
            gl.shader_source(&shader, source);
            gl.compile_shader(&shader);
            if !gl
                .get_shader_parameter(&shader, Gl::COMPILE_STATUS)
                .as_bool()
                .unwrap_or(false)
            {
                return Err(GlError(gl.get_shader_info_log(&shader).unwrap_or_default()));
            }
            gl.attach_shader(&program, &shader);
        }
        gl.link_program(&program);
        if !gl
            .get_program_parameter(&program, Gl::LINK_STATUS)
            .as_bool()
            .unwrap_or(false)
        {
            return Err(GlError(gl.get_program_info_log(&program).unwrap_or_default()));
        }
        let places = uniforms
            .iter()
            .filter_map(|name| Some((*name, gl.get_uniform_location(&program, name)?)));
        let uniforms = places.collect();
        Ok(Self {
            gl: gl.clone(),
            program,
            uniforms,
        })
    }

    /// Makes it the program that draws.
    pub(crate) fn select(&self) {
        self.gl.use_program(Some(&self.program));
    }

    /// Sets a uniform of one to four components; a name that the compiler optimised away is ignored.
    pub(crate) fn set(&self, name: &str, value: &[f32]) {
        let place = self.place(name);
        match value {
            [x] => self.gl.uniform1f(place, *x),
            [x, y] => self.gl.uniform2f(place, *x, *y),
            [x, y, z] => self.gl.uniform3f(place, *x, *y, *z),
            [x, y, z, w] => self.gl.uniform4f(place, *x, *y, *z, *w),
            _ => {}
        }
    }

    /// Sets a matrix of three or four columns.
    pub(crate) fn set_matrix(&self, name: &str, columns: &[f32]) {
        let place = self.place(name);
        if columns.len() == 9 {
            self.gl.uniform_matrix3fv_with_f32_array(place, false, columns);
        } else {
            self.gl.uniform_matrix4fv_with_f32_array(place, false, columns);
        }
    }

    fn place(&self, name: &str) -> Option<&WebGlUniformLocation> {
        self.uniforms
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, place)| place)
    }

    /// Says which texture unit a sampler reads.
    pub(crate) fn set_sampler(&self, name: &str, unit: i32) {
        let place = self.place(name);
        self.gl.uniform1i(place, unit);
    }
}

/// A buffer of numbers that grows at its end.
#[derive(Debug)]
pub(crate) struct GrowingBuffer {
    gl: Gl,
    buffer: WebGlBuffer,
    capacity: usize,
    filled: usize,
}

impl GrowingBuffer {
    pub(crate) fn new(gl: &Gl) -> Result<Self, GlError> {
        let buffer = gl
            .create_buffer()
            .ok_or_else(|| GlError("no buffer".to_owned()))?;
        Ok(Self {
            gl: gl.clone(),
            buffer,
            capacity: 0,
            filled: 0,
        })
    }

    /// Makes it the buffer that attributes are read from.
    pub(crate) fn bind(&self) {
        self.gl.bind_buffer(Gl::ARRAY_BUFFER, Some(&self.buffer));
    }

    /// Forgets the content.
    pub(crate) fn restart(&mut self) {
        self.filled = 0;
    }

    /// Brings the content up to `all`, of which what was uploaded before has not changed.
    pub(crate) fn catch_up(&mut self, all: &[f32]) {
        self.bind();
        if all.len() > self.capacity {
            self.capacity = (all.len() * 2).max(1024);
            self.gl
                .buffer_data_with_i32(Gl::ARRAY_BUFFER, (self.capacity * 4) as i32, Gl::DYNAMIC_DRAW);
            self.filled = 0;
        }
        let fresh = all.get(self.filled..).unwrap_or_default();
        if !fresh.is_empty() {
            let numbers = Float32Array::from(fresh);
            let at = (self.filled * 4) as i32;
            self.gl
                .buffer_sub_data_with_i32_and_array_buffer_view(Gl::ARRAY_BUFFER, at, &numbers);
            self.filled = all.len();
        }
    }
}

/// An empty description of what attributes are read from where.
pub(crate) fn layout(gl: &Gl) -> Result<WebGlVertexArrayObject, GlError> {
    gl.create_vertex_array()
        .ok_or_else(|| GlError("no vertex array".to_owned()))
}

/// Filter of a texture that is drawn larger or smaller than it is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Look {
    /// Sharp cells when large, averaged when small.
    Cells,
    /// Smooth everywhere.
    Smooth,
}

/// A texture with clamped edges.
pub(crate) fn texture(gl: &Gl, look: Look) -> Result<WebGlTexture, GlError> {
    let texture = gl
        .create_texture()
        .ok_or_else(|| GlError("no texture".to_owned()))?;
    gl.bind_texture(Gl::TEXTURE_2D, Some(&texture));
    let (large, small) = match look {
        Look::Cells => (Gl::NEAREST, Gl::LINEAR_MIPMAP_LINEAR),
        Look::Smooth => (Gl::LINEAR, Gl::LINEAR),
    };
    gl.tex_parameteri(Gl::TEXTURE_2D, Gl::TEXTURE_MAG_FILTER, large as i32);
    gl.tex_parameteri(Gl::TEXTURE_2D, Gl::TEXTURE_MIN_FILTER, small as i32);
    gl.tex_parameteri(Gl::TEXTURE_2D, Gl::TEXTURE_WRAP_S, Gl::CLAMP_TO_EDGE as i32);
    gl.tex_parameteri(Gl::TEXTURE_2D, Gl::TEXTURE_WRAP_T, Gl::CLAMP_TO_EDGE as i32);
    Ok(texture)
}
