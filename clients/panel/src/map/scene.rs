//! What is to be seen on the map.

use panel_logic::{Bounds, Camera, Playout, SweptGrid, View, home_plan, outlined, plan_bounds};
use rvac_api::{BumpMark, HomeView, MapDelta, MapSnapshot, Pose, SimulatedPlan};

use crate::theme::Theme;

/// The robot is never drawn smaller than this, in CSS pixels.
const ROBOT_RADIUS_MIN_PX: f64 = 8.0;

/// Who moves the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CameraMode {
    /// Shows everything, also when there is more.
    Fitted,
    /// Keeps the robot in the middle.
    Following,
    /// Stays where a person put it.
    Free,
}

/// What the next frame must draw anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Redraw {
    /// Nothing.
    Nothing,
    /// What lies in these bounds of the map.
    Area(Bounds),
    /// Everything.
    All,
}

impl Redraw {
    /// Both.
    #[must_use]
    pub(crate) fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, _) | (_, Self::All) => Self::All,
            (Self::Nothing, redraw) | (redraw, Self::Nothing) => redraw,
            (Self::Area(a), Self::Area(b)) => Self::Area(a.with(b)),
        }
    }
}

/// The scene. Whoever changes it says in `redraw` what must be drawn anew; robot and true place see to themselves.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) camera: Camera,
    pub(crate) mode: CameraMode,
    pub(crate) theme: Theme,
    pub(crate) radius_m: f64,
    pub(crate) believed: Playout,
    pub(crate) truth: Playout,
    pub(crate) plan: Option<SimulatedPlan>,
    pub(crate) plan_changed: bool,
    /// The plan is that of a simulated home, which says more than what the robot knows.
    plan_is_true: bool,
    pub(crate) swept: SweptGrid,
    pub(crate) swept_cells: usize,
    pub(crate) cell_m: f64,
    pub(crate) path: Vec<f32>,
    pub(crate) path_restarted: bool,
    pub(crate) bumps: Vec<BumpMark>,
    pub(crate) redraw: Redraw,
    map: u32,
    bodies: Option<Bounds>,
    newest: [Option<Pose>; 2],
    drawn_s: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            mode: CameraMode::Fitted,
            theme: Theme::Light,
            radius_m: 0.175,
            believed: Playout::default(),
            truth: Playout::default(),
            plan: None,
            plan_changed: true,
            plan_is_true: false,
            swept: SweptGrid::default(),
            swept_cells: 0,
            cell_m: 0.05,
            path: Vec::new(),
            path_restarted: true,
            bumps: Vec::new(),
            redraw: Redraw::All,
            map: 0,
            bodies: None,
            newest: [None; 2],
            drawn_s: 0.0,
        }
    }
}

/// Where the robot is drawn in this frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Places {
    pub(crate) believed: Option<Pose>,
    pub(crate) truth: Option<Pose>,
}

impl Scene {
    pub(crate) fn set_plan(&mut self, plan: &SimulatedPlan) {
        self.plan = Some(outlined(plan));
        self.plan_is_true = true;
        self.plan_changed = true;
        self.refit();
    }

    /// Takes what the robot knows of the home, unless the truth is there.
    pub(crate) fn on_home(&mut self, home: &HomeView) {
        if !self.plan_is_true && home.width > 0 {
            self.plan = Some(home_plan(home));
            self.plan_changed = true;
            self.refit();
        }
    }

    pub(crate) fn set_theme(&mut self, theme: Theme) {
        self.theme = theme;
        self.plan_changed = true;
        self.redraw = Redraw::All;
    }

    /// Takes a whole map in place of what was there.
    pub(crate) fn on_snapshot(&mut self, snapshot: &MapSnapshot) {
        self.map = snapshot.map;
        if snapshot.cell_m > 0.0 {
            self.cell_m = snapshot.cell_m;
        }
        self.swept.clear();
        self.swept_cells = 0;
        self.path.clear();
        self.path_restarted = true;
        self.bumps.clear();
        self.redraw = Redraw::All;
        self.add(&snapshot.swept, &snapshot.path_mm, &snapshot.bumps);
    }

    /// Takes what was added. What belongs to another map waits for its snapshot.
    pub(crate) fn on_delta(&mut self, delta: &MapDelta) {
        if delta.map == self.map {
            self.add(&delta.swept, &delta.path_mm, &delta.bumps);
        }
    }

    fn add(&mut self, swept: &[i32], path_mm: &[i32], bumps: &[BumpMark]) {
        self.swept.mark_all(swept);
        self.swept_cells += swept.len() / 2;
        let joint = self.path.len().saturating_sub(2);
        let whole_points = path_mm.len() / 2 * 2;
        self.path.extend(
            path_mm
                .iter()
                .take(whole_points)
                .map(|&millimetres| millimetres as f32 / 1000.0),
        );
        self.bumps.extend_from_slice(bumps);
        let cell = self.cell_m;
        for place in swept.chunks_exact(2) {
            if let &[ix, iy] = place {
                self.touch(f64::from(ix) * cell, f64::from(iy) * cell, 2.0 * cell);
            }
        }
        if whole_points > 0 {
            for index in (joint..self.path.len()).step_by(2) {
                let (x, y) = (self.path.get(index), self.path.get(index + 1));
                self.touch(
                    x.map_or(0.0, |x| f64::from(*x)),
                    y.map_or(0.0, |y| f64::from(*y)),
                    0.0,
                );
            }
        }
        for bump in bumps {
            self.touch(bump.x, bump.y, 0.0);
        }
        if self.plan.is_none() && self.mode == CameraMode::Fitted && !swept.is_empty() {
            self.refit();
        }
    }

    fn touch(&mut self, x: f64, y: f64, radius: f64) {
        self.redraw = self.redraw.with(Redraw::Area(Bounds::around(x, y, radius)));
    }

    /// Takes where the robot believes to be; false when it stands where it stood.
    pub(crate) fn on_pose(&mut self, pose: Pose, now_s: f64) -> bool {
        let moved = differs(self.newest[0].replace(pose), pose);
        if moved {
            self.believed.push(pose, now_s);
        }
        moved
    }

    /// Takes where a simulated robot really is; false when it stands where it stood.
    pub(crate) fn on_truth(&mut self, pose: Pose, now_s: f64) -> bool {
        let moved = differs(self.newest[1].replace(pose), pose);
        if moved {
            self.truth.push(pose, now_s);
        }
        moved
    }

    /// Shows everything again if that is what the camera does.
    pub(crate) fn refit(&mut self) {
        self.redraw = Redraw::All;
        if self.mode == CameraMode::Fitted {
            self.camera.fit(self.extent());
        }
    }

    pub(crate) fn resize(&mut self, view: View) {
        self.camera.resize(view);
        self.refit();
    }

    /// All that there is: the plan, or what was swept, and at least three metres around the start.
    fn extent(&self) -> Bounds {
        if let Some(bounds) = self.plan.as_ref().and_then(plan_bounds) {
            return bounds;
        }
        let start = Bounds::around(0.0, 0.0, 1.5);
        let (x0, y0) = self.swept.origin();
        let (width, height) = self.swept.size();
        if width == 0 {
            return start;
        }
        let at = |cell: i32| f64::from(cell) * self.cell_m;
        start.with(Bounds {
            x_min: at(x0),
            y_min: at(y0),
            x_max: at(x0 + width),
            y_max: at(y0 + height),
        })
    }

    /// Moves on to `now_s` and says where the robot is drawn and what the frame must draw anew.
    pub(crate) fn advance(&mut self, now_s: f64) -> (Places, Redraw) {
        let elapsed_s = (now_s - self.drawn_s).clamp(0.0, 0.1);
        self.drawn_s = now_s;
        let places = Places {
            believed: self.believed.sample(now_s),
            truth: self.truth.sample(now_s),
        };
        if let (CameraMode::Following, Some(pose)) = (self.mode, places.believed) {
            let before = self.camera.middle();
            self.camera.follow((pose.x, pose.y), elapsed_s);
            let (x, y) = self.camera.middle();
            // A hundredth of a pixel cannot be seen.
            if (x - before.0).hypot(y - before.1) * self.camera.scale() > 0.01 {
                self.redraw = Redraw::All;
            }
        }
        let covered = [places.believed, places.truth].into_iter().flatten();
        let radius = self.body_radius_m() * 1.5;
        let bodies = covered
            .map(|pose| Bounds::around(pose.x, pose.y, radius))
            .reduce(Bounds::with);
        let areas = [self.bodies, bodies].into_iter().flatten().map(Redraw::Area);
        let redraw = areas.fold(self.redraw, Redraw::with);
        self.bodies = bodies;
        self.redraw = Redraw::Nothing;
        (places, redraw)
    }

    /// Radius with which the robot is drawn: never too small to be seen.
    pub(crate) fn body_radius_m(&self) -> f64 {
        self.radius_m.max(ROBOT_RADIUS_MIN_PX / self.camera.scale())
    }

    /// Whether the robot moves on the picture, so that the next frame differs from this one.
    pub(crate) fn is_moving(&self, now_s: f64) -> bool {
        self.believed.is_moving(now_s) || self.truth.is_moving(now_s)
    }
}

fn differs(before: Option<Pose>, after: Pose) -> bool {
    before.is_none_or(|before| (before.x, before.y, before.heading) != (after.x, after.y, after.heading))
}
