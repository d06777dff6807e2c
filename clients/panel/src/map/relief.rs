//! Things above the floor in the orbit view: walls cut off to show the rooms, the dock, the body of the robot.

use panel_logic::{BLOCK_NUMBERS, MapPalette, Rgb, WallBlocks};
use rvac_api::Pose;
use web_sys::{WebGl2RenderingContext as Gl, WebGlVertexArrayObject};

use super::gl::{GlError, GrowingBuffer, Program, layout};
use super::relief_shaders::{
    BLOCK_CORNERS, BLOCK_FRAGMENT, BLOCK_VERTEX, DRUM_CORNERS, DRUM_FRAGMENT, DRUM_VERTEX,
};
use super::renderer::Frame;
use super::scene::Scene;

/// Walls are cut off here, metres: high enough to be walls, low enough to see what is behind them.
pub(super) const WALL_M: f64 = 0.4;
/// Height of the robot, metres: robots of this kind fit under a cupboard.
pub(super) const ROBOT_M: f64 = 0.09;
/// The dock in its own frame, which has its contacts at zero and faces along x: the plate on which the robot drives, and the tower.
const DOCK_PARTS: [([f32; 4], f32); 2] = [
    ([0.0, -0.12, 0.15, 0.12], 0.015),
    ([-0.05, -0.12, 0.02, 0.12], 0.16),
];

/// Robots as marks on the floor, and how high they stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct RobotMarks<'a> {
    pub(super) layout: &'a WebGlVertexArrayObject,
    pub(super) count: i32,
    pub(super) height_m: f64,
}

/// Blocks and bodies in graphics memory.
#[derive(Debug)]
pub(super) struct Relief {
    gl: Gl,
    block: Program,
    drum: Program,
    walls: WallBlocks,
    walls_buffer: GrowingBuffer,
    walls_layout: WebGlVertexArrayObject,
    dock_buffer: GrowingBuffer,
    dock_layout: WebGlVertexArrayObject,
    is_stale: bool,
}

/// Colours of a kind of block.
#[derive(Clone, Copy, Debug)]
struct Paint {
    top: Rgb,
    side: Rgb,
}

impl Relief {
    pub(super) fn new(gl: &Gl) -> Result<Self, GlError> {
        let block_uniforms = ["eye", "pose", "height", "top_colour", "side_colour"];
        let drum_uniforms = ["eye", "height", "body_colour", "front_colour"];
        let relief = Self {
            gl: gl.clone(),
            block: Program::new(gl, [BLOCK_VERTEX, BLOCK_FRAGMENT], &block_uniforms)?,
            drum: Program::new(gl, [DRUM_VERTEX, DRUM_FRAGMENT], &drum_uniforms)?,
            walls: WallBlocks::default(),
            walls_buffer: GrowingBuffer::new(gl)?,
            walls_layout: layout(gl)?,
            dock_buffer: GrowingBuffer::new(gl)?,
            dock_layout: layout(gl)?,
            is_stale: true,
        };
        for (layout, buffer) in [
            (&relief.walls_layout, &relief.walls_buffer),
            (&relief.dock_layout, &relief.dock_buffer),
        ] {
            gl.bind_vertex_array(Some(layout));
            buffer.bind();
            gl.enable_vertex_attrib_array(0);
            gl.vertex_attrib_pointer_with_i32(0, 4, Gl::FLOAT, false, 16, 0);
            gl.vertex_attrib_divisor(0, 1);
        }
        gl.bind_vertex_array(None);
        Ok(relief)
    }

    /// The plan has changed.
    pub(super) fn expect_another_plan(&mut self) {
        self.is_stale = true;
    }

    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        self.walls.numbers().len() / BLOCK_NUMBERS
    }

    /// Draws walls, furniture and dock. They hide what is drawn after them and lies behind them.
    pub(super) fn draw_standing(&mut self, scene: &Scene, palette: &MapPalette, eye: &[f32; 16]) {
        if std::mem::take(&mut self.is_stale) {
            self.walls.renew(scene.plan());
            self.walls_buffer.restart();
            self.walls_buffer.catch_up(self.walls.numbers());
        }
        let gl = &self.gl;
        gl.enable(Gl::DEPTH_TEST);
        gl.depth_func(Gl::LEQUAL);
        gl.depth_mask(true);
        gl.enable(Gl::CULL_FACE);
        self.block.select();
        self.block.set_matrix("eye", eye);
        if let Some(plan) = scene.plan() {
            let paint = Paint {
                top: palette.wall_top,
                side: palette.wall_side,
            };
            self.place(plan.origin, WALL_M as f32, paint);
            gl.bind_vertex_array(Some(&self.walls_layout));
            gl.draw_arrays_instanced(Gl::TRIANGLES, 0, BLOCK_CORNERS, self.blocks() as i32);
        }
        if let Some(dock) = scene.dock() {
            self.draw_dock(dock, palette);
        }
        self.gl.depth_mask(false);
        self.gl.disable(Gl::CULL_FACE);
    }

    fn draw_dock(&mut self, dock: Pose, palette: &MapPalette) {
        for (sides, height) in DOCK_PARTS {
            self.dock_buffer.restart();
            self.dock_buffer.catch_up(&sides);
            let paint = Paint {
                top: palette.front,
                side: palette.body,
            };
            self.place(dock, height, paint);
            self.gl.bind_vertex_array(Some(&self.dock_layout));
            self.gl.draw_arrays_instanced(Gl::TRIANGLES, 0, BLOCK_CORNERS, 1);
        }
    }

    fn place(&self, pose: Pose, height: f32, paint: Paint) {
        let (sin, cos) = pose.heading.sin_cos();
        self.block
            .set("pose", &[pose.x as f32, pose.y as f32, cos as f32, sin as f32]);
        self.block.set("height", &[height]);
        self.block.set("top_colour", &paint.top);
        self.block.set("side_colour", &paint.side);
    }

    /// Draws the sides of these robots.
    pub(super) fn draw_robot(&self, marks: RobotMarks<'_>, Frame { palette, eye }: Frame<'_>) {
        let gl = &self.gl;
        gl.depth_mask(true);
        gl.enable(Gl::CULL_FACE);
        self.drum.select();
        self.drum.set_matrix("eye", &eye.clip);
        self.drum.set("height", &[marks.height_m as f32]);
        self.drum.set("body_colour", &palette.body);
        self.drum.set("front_colour", &palette.front);
        gl.bind_vertex_array(Some(marks.layout));
        gl.draw_arrays_instanced(Gl::TRIANGLE_STRIP, 0, DRUM_CORNERS, marks.count);
        gl.depth_mask(false);
        gl.disable(Gl::CULL_FACE);
    }
}
