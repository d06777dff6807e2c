//! Draws the scene: one pass for the ground, in the orbit view one for things on it, one each for walls, path and planned path, one
//! for what lies on the floor, one for the robot, one for bumps.

use panel_logic::{Bounds, Camera, MapPalette};
use wasm_bindgen::JsCast;
use web_sys::{HtmlCanvasElement, WebGl2RenderingContext as Gl, WebGlTexture, WebGlVertexArrayObject};

use super::canvas_size::fit_canvas;
use super::gl::{GlError, GrowingBuffer, Look, Program, layout, texture};
use super::marks::{MARK_NUMBERS, bump_marks, floor_marks, robot_marks};
use super::relief::{ROBOT_M, Relief, RobotMarks};
use super::scene::{Ground, Places, Redraw, Scene};
use super::shaders;

/// Marks and lines reach this far beyond their place, in CSS pixels.
const MARGIN_PX: f64 = 12.0;

/// How much of the robot is visible through a wall in front of it.
const BEHIND_WALL: f32 = 0.35;

/// Everything that lives in graphics memory.
#[derive(Debug)]
pub(crate) struct Renderer {
    pub(super) gl: Gl,
    ground: Program,
    line: Program,
    mark: Program,
    pub(super) plan: WebGlTexture,
    pub(super) swept: WebGlTexture,
    path: Layer,
    walls: Layer,
    planned_path: Layer,
    wanted: Layer,
    forbidden: Layer,
    bumps: Layer,
    lying: Layer,
    robot: Layer,
    empty_layout: WebGlVertexArrayObject,
    /// Things above the floor; made when first visible.
    pub(super) relief: Option<Relief>,
}

/// Numbers of instances that are drawn together, and how they are read.
#[derive(Debug)]
struct Layer {
    buffer: GrowingBuffer,
    layout: WebGlVertexArrayObject,
}

impl Layer {
    fn new(gl: &Gl) -> Result<Self, GlError> {
        Ok(Self {
            buffer: GrowingBuffer::new(gl)?,
            layout: layout(gl)?,
        })
    }

    fn replace(&mut self, numbers: &[f32]) {
        self.buffer.restart();
        self.buffer.catch_up(numbers);
    }

    fn draw(&self, gl: &Gl, instances: usize) {
        if instances > 0 {
            gl.bind_vertex_array(Some(&self.layout));
            gl.draw_arrays_instanced(Gl::TRIANGLE_STRIP, 0, 4, instances as i32);
        }
    }
}

/// With what a frame is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<'a> {
    pub(super) palette: &'a MapPalette,
    pub(super) eye: &'a Eye,
}

/// The camera in the form for the shaders.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    pub(super) clip: [f32; 16],
    floor: [f32; 9],
    pixel: [f32; 2],
    ratio: f64,
    /// Seen from an orbit.
    in_relief: bool,
}

impl Eye {
    fn of(camera: &Camera, gl: &Gl) -> Self {
        let (width, height) = (
            f64::from(gl.drawing_buffer_width()),
            f64::from(gl.drawing_buffer_height()),
        );
        let projection = camera.projection();
        Self {
            clip: projection.clip_matrix(),
            floor: projection.floor_matrix(),
            pixel: [(2.0 / width) as f32, (2.0 / height) as f32],
            ratio: width / camera.view().width,
            in_relief: camera.orbit().is_some(),
        }
    }
}

impl Renderer {
    pub(crate) fn new(gl: &Gl) -> Result<Self, GlError> {
        let ground_uniforms = [
            "floor_from_clip",
            "plan",
            "swept",
            "plan_pose",
            "plan_size",
            "swept_box",
            "outside_colour",
            "grid_colour",
            "swept_colour",
        ];
        let mark_uniforms = [
            "eye",
            "pixel",
            "lift",
            "fade",
            "mark_colour",
            "body_colour",
            "front_colour",
            "halo_colour",
            "thought_colour",
        ];
        let line_uniforms = ["eye", "pixel", "half_width", "line_colour"];
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
            path: Layer::new(gl)?,
            walls: Layer::new(gl)?,
            planned_path: Layer::new(gl)?,
            wanted: Layer::new(gl)?,
            forbidden: Layer::new(gl)?,
            bumps: Layer::new(gl)?,
            lying: Layer::new(gl)?,
            robot: Layer::new(gl)?,
            empty_layout: layout(gl)?,
            relief: None,
        };
        renderer.describe_layouts();
        Ok(renderer)
    }

    /// A segment of the path reads two points that overlap with those of its neighbours, one of walls or the planned path two
    /// of its own; a mark reads its five numbers.
    fn describe_layouts(&self) {
        let gl = &self.gl;
        let attribute = |place: u32, size: i32, [stride, offset]: [i32; 2]| {
            gl.enable_vertex_attrib_array(place);
            gl.vertex_attrib_pointer_with_i32(place, size, Gl::FLOAT, false, stride, offset);
            gl.vertex_attrib_divisor(place, 1);
        };
        let strokes =
            [&self.walls, &self.planned_path, &self.wanted, &self.forbidden].map(|layer| (layer, 16));
        for (layer, stride) in strokes.into_iter().chain([(&self.path, 8)]) {
            gl.bind_vertex_array(Some(&layer.layout));
            layer.buffer.bind();
            attribute(0, 2, [stride, 0]);
            attribute(1, 2, [stride, 8]);
        }
        let mark_bytes = MARK_NUMBERS as i32 * 4;
        for layer in [&self.bumps, &self.lying, &self.robot] {
            gl.bind_vertex_array(Some(&layer.layout));
            layer.buffer.bind();
            attribute(0, 4, [mark_bytes, 0]);
            attribute(1, 1, [mark_bytes, 16]);
        }
        gl.bind_vertex_array(None);
    }

    /// Draws one frame, or as much of it as changed.
    pub(crate) fn draw(&mut self, scene: &mut Scene, places: Places, redraw: Redraw) {
        let canvas = self.gl.canvas();
        let canvas = canvas.and_then(|canvas| canvas.dyn_into::<HtmlCanvasElement>().ok());
        let resized = canvas.is_some_and(|canvas| fit_canvas(&canvas, &scene.camera));
        let palette = scene.theme.palette();
        self.prepare_relief(scene);
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
            Redraw::Area(bounds) if !resized => self.limit_to(bounds, &scene.camera, &eye),
            Redraw::Area(_) | Redraw::All => self.gl.disable(Gl::SCISSOR_TEST),
        }
        self.gl.disable(Gl::DEPTH_TEST);
        self.gl.disable(Gl::BLEND);
        let frame = Frame {
            palette: &palette,
            eye: &eye,
        };
        self.draw_ground(scene, frame);
        if let Some(relief) = self.relief.as_mut().filter(|_| eye.in_relief) {
            self.gl.depth_mask(true);
            self.gl.clear(Gl::DEPTH_BUFFER_BIT);
            relief.draw_standing(scene, &palette, &eye.clip);
        }
        self.gl.enable(Gl::BLEND);
        self.gl.blend_func(Gl::ONE, Gl::ONE_MINUS_SRC_ALPHA);
        self.draw_lines(scene, frame);
        self.draw_marks(scene, places, frame);
        self.gl.bind_vertex_array(None);
    }

    /// How many blocks are on the floor.
    pub(crate) fn blocks(&self) -> usize {
        self.relief.as_ref().map_or(0, Relief::blocks)
    }

    /// Makes what is needed to see the map from an orbit. Where that cannot be made the map stays flat.
    fn prepare_relief(&mut self, scene: &mut Scene) {
        if scene.camera.orbit().is_none() || self.relief.is_some() {
            return;
        }
        match Relief::new(&self.gl) {
            Ok(relief) => self.relief = Some(relief),
            Err(GlError(why)) => scene.refuse_relief(why),
        }
    }

    /// Leaves everything as it is but these bounds and a margin for marks of a fixed size.
    fn limit_to(&self, bounds: Bounds, camera: &Camera, eye: &Eye) {
        let seen = camera.screen_box(bounds, if eye.in_relief { ROBOT_M } else { 0.0 });
        let device = |pixels: f64| (pixels * eye.ratio) as i32;
        let margin = MARGIN_PX;
        let (x, y) = (
            device(seen.left - margin),
            self.gl.drawing_buffer_height() - device(seen.bottom + margin),
        );
        self.gl.enable(Gl::SCISSOR_TEST);
        self.gl.scissor(
            x,
            y,
            device(seen.right - seen.left + 2.0 * margin),
            device(seen.bottom - seen.top + 2.0 * margin),
        );
    }

    fn draw_ground(&self, scene: &Scene, Frame { palette, eye }: Frame<'_>) {
        let program = &self.ground;
        program.select();
        self.gl.active_texture(Gl::TEXTURE1);
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.swept));
        self.gl.active_texture(Gl::TEXTURE0);
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.plan));
        program.set_sampler("plan", 0);
        program.set_sampler("swept", 1);
        program.set_matrix("floor_from_clip", &eye.floor);
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

    fn draw_lines(&mut self, scene: &mut Scene, Frame { palette, eye }: Frame<'_>) {
        if std::mem::take(&mut scene.path_restarted) {
            self.path.buffer.restart();
        }
        self.path.buffer.catch_up(&scene.path);
        if std::mem::take(&mut scene.strokes_changed) {
            self.walls.replace(&scene.walls);
            self.planned_path.replace(&scene.planned_path);
            self.wanted.replace(&scene.wanted);
            self.forbidden
                .replace(&[scene.forbidden.as_slice(), &scene.avoided].concat());
        }
        self.line.select();
        self.line.set_matrix("eye", &eye.clip);
        self.line.set("pixel", &eye.pixel);
        // Walls drawn as blocks need no stroke.
        let has_strokes = scene.ground() == Ground::Known && !eye.in_relief;
        let walls = if has_strokes { scene.walls.len() / 4 } else { 0 };
        let forbidden = (scene.forbidden.len() + scene.avoided.len()) / 4;
        let segments = (scene.path.len() / 2).saturating_sub(1);
        for (layer, segments, (half_width_px, colour)) in [
            (&self.walls, walls, (1.0, &palette.wall)),
            (&self.path, segments, (0.8, &palette.path)),
            (
                &self.planned_path,
                scene.planned_path.len() / 4,
                (1.0, &palette.thought),
            ),
            (&self.forbidden, forbidden, (1.5, &palette.forbidden)),
            (&self.wanted, scene.wanted.len() / 4, (1.5, &palette.wanted)),
        ] {
            self.line.set("half_width", &[(half_width_px * eye.ratio) as f32]);
            self.line.set("line_colour", colour);
            layer.draw(&self.gl, segments);
        }
    }

    fn draw_marks(&mut self, scene: &Scene, places: Places, frame: Frame<'_>) {
        let eye = frame.eye;
        let bumps = bump_marks(scene, eye.ratio);
        let lying = floor_marks(scene, places, eye.in_relief);
        let robot = robot_marks(scene, places);
        for (layer, numbers) in [
            (&mut self.bumps, &bumps),
            (&mut self.lying, &lying),
            (&mut self.robot, &robot),
        ] {
            layer.replace(numbers);
        }
        let instances = |numbers: &[f32]| numbers.len() / MARK_NUMBERS;
        // A robot that is enlarged to be visible is as much higher.
        let height_m = ROBOT_M * scene.body_radius_m() / scene.radius_m;
        let lift_m = if eye.in_relief { height_m } else { 0.0 };
        self.begin_marks(frame, lift_m);
        // What touches the robot is seen before all else; in the flat picture bumps lie below it.
        if !eye.in_relief {
            self.bumps.draw(&self.gl, instances(&bumps));
        }
        self.lying.draw(&self.gl, instances(&lying));
        if let Some(relief) = self.relief.as_ref().filter(|_| eye.in_relief) {
            self.gl.disable(Gl::DEPTH_TEST);
            self.mark.set("fade", &[BEHIND_WALL]);
            self.robot.draw(&self.gl, instances(&robot));
            self.bumps.draw(&self.gl, instances(&bumps));
            self.gl.enable(Gl::DEPTH_TEST);
            let marks = RobotMarks {
                layout: &self.robot.layout,
                count: instances(&robot) as i32,
                height_m,
            };
            relief.draw_robot(marks, frame);
            self.mark.select();
            self.mark.set("fade", &[1.0]);
            self.bumps.draw(&self.gl, instances(&bumps));
        }
        self.robot.draw(&self.gl, instances(&robot));
    }

    fn begin_marks(&self, Frame { palette, eye }: Frame<'_>, lift_m: f64) {
        let mark = &self.mark;
        mark.select();
        mark.set_matrix("eye", &eye.clip);
        mark.set("pixel", &eye.pixel);
        mark.set("lift", &[lift_m as f32]);
        mark.set("fade", &[1.0]);
        mark.set("mark_colour", &palette.mark);
        mark.set("body_colour", &palette.body);
        mark.set("front_colour", &palette.front);
        mark.set("halo_colour", &palette.halo);
        mark.set("thought_colour", &palette.thought);
    }
}
