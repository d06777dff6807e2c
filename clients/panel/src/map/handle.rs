//! The interface of the map to the rest of the page: takes what is new and draws when there is something to draw.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use leptos::prelude::{RwSignal, Track, Update, request_animation_frame, window};
use panel_logic::{FrameMeter, MapPoint, RoomChoice};
use rvac_api::{
    Estimate, HomeView, MapDelta, MapSnapshot, PlannedPath, Pose, RobotDescription, SimulatedPlan,
};
use wasm_bindgen::JsCast;
use web_sys::{HtmlCanvasElement, HtmlElement, WebGl2RenderingContext, WebGlContextAttributes};

use super::gl::GlError;
use super::labels::Labels;
use super::plain::PlainRenderer;
use super::renderer::Renderer;
use super::scene::{Places, Redraw, Scene};
use crate::language::words;
use crate::theme::Theme;

/// A shared handle on the map; cheap to clone.
#[derive(Clone, Default)]
pub(crate) struct MapHandle {
    shared: Rc<Shared>,
}

#[derive(Default)]
struct Shared {
    scene: RefCell<Scene>,
    painter: RefCell<Option<Painter>>,
    canvas: RefCell<Option<HtmlCanvasElement>>,
    labels: RefCell<Labels>,
    meter: RefCell<FrameMeter>,
    /// Changes when all was redrawn, as when the camera has moved.
    seen: RwSignal<u32>,
    scheduled: Cell<bool>,
}

/// Who draws.
#[derive(Debug)]
enum Painter {
    Gl(Box<Renderer>),
    /// Where there is no WebGL 2.
    Plain(PlainRenderer),
}

impl Painter {
    fn new(canvas: &HtmlCanvasElement) -> Result<Self, GlError> {
        match context(canvas) {
            Ok(gl) => Ok(Self::Gl(Box::new(Renderer::new(&gl)?))),
            Err(error) => PlainRenderer::new(canvas).map(Self::Plain).ok_or(error),
        }
    }

    fn draw(&mut self, scene: &mut Scene, places: Places, redraw: Redraw) {
        match self {
            Self::Gl(renderer) => renderer.draw(scene, places, redraw),
            Self::Plain(renderer) => renderer.draw(scene, places, redraw),
        }
    }

    /// How many blocks are on the floor.
    fn blocks(&self) -> usize {
        match self {
            Self::Gl(renderer) => renderer.blocks(),
            Self::Plain(_) => 0,
        }
    }

    const fn name(&self) -> &'static str {
        match self {
            Self::Gl(_) => "webgl",
            Self::Plain(_) => "plain",
        }
    }
}

/// Seconds of the browser's clock.
fn now_s() -> f64 {
    window()
        .performance()
        .map_or(0.0, |performance| performance.now() / 1000.0)
}

impl MapHandle {
    /// Begins to draw on `canvas`.
    pub(crate) fn attach(&self, canvas: HtmlCanvasElement) -> Result<(), GlError> {
        *self.shared.canvas.borrow_mut() = Some(canvas);
        self.restart()
    }

    /// Makes the renderer: at the start, and after the browser took the graphics memory away.
    pub(crate) fn restart(&self) -> Result<(), GlError> {
        let canvas = self.shared.canvas.borrow();
        let canvas = canvas.as_ref().ok_or_else(|| GlError("no canvas".to_owned()))?;
        *self.shared.painter.borrow_mut() = Some(Painter::new(canvas)?);
        self.change(|scene| {
            scene.plan_changed = true;
            scene.path_restarted = true;
            scene.strokes_changed = true;
        });
        Ok(())
    }

    /// The browser took the graphics memory away.
    pub(crate) fn on_context_lost(&self) {
        *self.shared.painter.borrow_mut() = None;
    }

    /// Takes the keys: what is drawn is drawn with them, too.
    pub(crate) fn focus(&self) {
        if let Some(canvas) = self.shared.canvas.borrow().as_ref() {
            canvas.focus().ok(); // An element that cannot have it leaves it where it is.
        }
    }

    pub(crate) fn set_robot(&self, robot: Option<&RobotDescription>) {
        if let Some(robot) = robot.filter(|robot| robot.radius_m > 0.0) {
            self.change(|scene| scene.radius_m = robot.radius_m);
        }
    }

    pub(crate) fn set_plan(&self, plan: &SimulatedPlan) {
        self.change(|scene| scene.set_plan(plan));
    }

    pub(crate) fn on_home(&self, home: &HomeView) {
        self.shared.labels.borrow_mut().name(&home.rooms);
        self.change(|scene| scene.on_home(home));
    }

    /// Takes what a person has chosen.
    pub(crate) fn choose(&self, choice: &RoomChoice) {
        self.shared.labels.borrow_mut().number(&choice.drawn(words()));
        self.change(|scene| scene.choose(choice));
    }

    /// Marks where the robot waits for help, if it does.
    pub(crate) fn mark_stop(&self, place: Option<MapPoint>) {
        self.shared.labels.borrow_mut().mark_stop(place);
        self.change(|_| {});
    }

    pub(crate) fn on_planned_path(&self, path: &PlannedPath) {
        self.change(|scene| scene.on_planned_path(path));
    }

    pub(crate) fn on_estimate(&self, estimate: &Estimate) {
        self.animate(|scene| scene.on_estimate(estimate));
    }

    /// Names rooms in this element, which lies over the canvas.
    pub(crate) fn name_rooms_in(&self, place: HtmlElement) {
        self.shared.labels.borrow_mut().put_into(place);
        self.change(|_| {});
    }

    pub(crate) fn set_theme(&self, theme: Theme) {
        self.change(|scene| scene.set_theme(theme));
    }

    pub(crate) fn on_pose(&self, pose: Pose) {
        self.animate(|scene| scene.on_pose(pose, now_s()));
        if let Some(canvas) = self.shared.canvas.borrow().as_ref() {
            let text = format!("{:.3},{:.3},{:.3}", pose.x, pose.y, pose.heading);
            canvas.set_attribute("data-pose", &text).ok(); // For tests; the picture does not depend on it.
        }
    }

    pub(crate) fn on_truth(&self, pose: Pose) {
        self.animate(|scene| scene.on_truth(pose, now_s()));
    }

    pub(crate) fn on_snapshot(&self, snapshot: &MapSnapshot) {
        self.animate(|scene| {
            scene.on_snapshot(snapshot);
            true
        });
    }

    pub(crate) fn on_delta(&self, delta: &MapDelta) {
        self.animate(|scene| {
            scene.on_delta(delta);
            true
        });
    }

    /// Callers are notified when the camera may have moved.
    pub(crate) fn follow_camera(&self) {
        self.shared.seen.track();
    }

    /// Reads the scene.
    pub(crate) fn with<T>(&self, read: impl FnOnce(&Scene) -> T) -> T {
        read(&self.shared.scene.borrow())
    }

    /// Changes the scene and has all of it drawn.
    pub(crate) fn change(&self, change: impl FnOnce(&mut Scene)) {
        self.animate(|scene| {
            change(scene);
            scene.redraw = Redraw::All;
            true
        });
    }

    /// Changes parts of the scene, which says itself whether and what is to be drawn.
    fn animate(&self, change: impl FnOnce(&mut Scene) -> bool) {
        let changed = change(&mut self.shared.scene.borrow_mut());
        if changed {
            self.schedule();
        }
    }

    /// Frames per second while the picture moves.
    pub(crate) fn frames_per_second(&self) -> Option<f64> {
        self.shared.meter.borrow().per_second()
    }

    /// Writes what tests and curious people read from the canvas.
    pub(crate) fn publish_figures(&self) {
        let canvas = self.shared.canvas.borrow();
        let Some(canvas) = canvas.as_ref() else { return };
        let set = |name: &str, value: String| {
            canvas.set_attribute(name, &value).ok(); // The names are valid ones.
        };
        set("data-ground", self.with(|scene| format!("{:?}", scene.ground())));
        set(
            "data-way-dashes",
            self.with(|scene| (scene.planned_path.len() / 4).to_string()),
        );
        if let Some(rate) = self.frames_per_second() {
            set("data-frames-per-second", format!("{rate:.1}"));
        }
        if let Some((median, p95)) = self.shared.meter.borrow().median_and_p95_ms() {
            set("data-frame-ms", format!("{median:.1} {p95:.1}"));
        }
        let path_points = self.with(|scene| scene.path.len() / 2);
        set("data-path-points", path_points.to_string());
        let in_relief = self.with(|scene| scene.camera.orbit().is_some());
        set("data-view", if in_relief { "3d" } else { "2d" }.to_owned());
        if let Some(painter) = self.shared.painter.borrow().as_ref() {
            set("data-blocks", painter.blocks().to_string());
            set("data-painter", painter.name().to_owned());
        }
        set(
            "data-swept-cells",
            self.with(|scene| scene.swept_cells.to_string()),
        );
    }

    fn schedule(&self) {
        if self.shared.painter.borrow().is_none() || self.shared.scheduled.replace(true) {
            return;
        }
        let map = self.clone();
        request_animation_frame(move || {
            map.shared.scheduled.set(false);
            map.draw();
        });
    }

    fn draw(&self) {
        let now = now_s();
        let mut scene = self.shared.scene.borrow_mut();
        let moving = scene.is_moving(now);
        let (places, redraw) = scene.advance(now);
        if let Some(painter) = self.shared.painter.borrow_mut().as_mut() {
            painter.draw(&mut scene, places, redraw);
        }
        if redraw == Redraw::All {
            self.shared.labels.borrow().place(&scene);
        }
        drop(scene);
        if redraw == Redraw::All {
            self.shared.seen.update(|count| *count = count.wrapping_add(1));
        }
        if moving {
            self.shared.meter.borrow_mut().frame(now);
            self.schedule();
        }
    }
}

fn context(canvas: &HtmlCanvasElement) -> Result<WebGl2RenderingContext, GlError> {
    let attributes = WebGlContextAttributes::new();
    attributes.set_alpha(false);
    attributes.set_depth(true);
    attributes.set_antialias(false);
    // Frames draw only what changed on top of the frame before.
    attributes.set_preserve_drawing_buffer(true);
    let context = canvas
        .get_context_with_context_options("webgl2", &attributes)
        .ok()
        .flatten();
    let context = context.and_then(|context| context.dyn_into::<WebGl2RenderingContext>().ok());
    context.ok_or_else(|| GlError(words().map.no_webgl.to_owned()))
}
