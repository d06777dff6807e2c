//! What is to be seen on the map.

use panel_logic::{
    Bounds, Camera, ITEMS_MAX, MapPoint, Orbit, Playout, RoomChoice, SweptGrid, View, dock_contacts,
    home_plan, no_go_strokes, outlined, path_dashes, plan_bounds, room_at, wall_strokes, zone_strokes,
};
use rvac_api::{
    BumpMark, DoorView, Estimate, HomeView, MapDelta, MapSnapshot, PlannedPath, Pose, SimulatedPlan,
};

use crate::theme::Theme;

/// The robot is never drawn smaller than this, in CSS pixels.
const ROBOT_RADIUS_MIN_PX: f64 = 8.0;

/// Length of a dash of the planned path, metres.
const DASH_M: f64 = 0.06;
/// Widest uncertainty that is drawn, metres: beyond it only the words help.
const UNCERTAINTY_MAX_M: f64 = 20.0;

/// What lies under path and robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ground {
    /// The robot's map of the home.
    Known,
    /// The floor plan of a simulated home.
    True,
}

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

/// What the next frame must redraw.
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

/// The scene. Each change notes in `redraw` what must be redrawn; robot and true pose do so by themselves.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) camera: Camera,
    pub(crate) mode: CameraMode,
    pub(crate) theme: Theme,
    pub(crate) radius_m: f64,
    pub(crate) believed: Playout,
    pub(crate) truth: Playout,
    pub(crate) plan_changed: bool,
    ground: Ground,
    true_plan: Option<SimulatedPlan>,
    known_plan: Option<SimulatedPlan>,
    home: Option<HomeView>,
    chosen: Vec<u16>,
    doors: Vec<DoorView>,
    /// Walls as strokes, and the planned path as dashes.
    pub(crate) walls: Vec<f32>,
    pub(crate) planned_path: Vec<f32>,
    /// Borders of zones and spots that are to be cleaned, of what is forbidden for the next job, and of what is for good.
    pub(crate) wanted: Vec<f32>,
    pub(crate) avoided: Vec<f32>,
    pub(crate) forbidden: Vec<f32>,
    pub(crate) strokes_changed: bool,
    uncertainty_m: f64,
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
    relief_failure: Option<String>,
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
            plan_changed: true,
            ground: Ground::Known,
            true_plan: None,
            known_plan: None,
            home: None,
            chosen: Vec::new(),
            doors: Vec::new(),
            walls: Vec::new(),
            planned_path: Vec::new(),
            wanted: Vec::new(),
            avoided: Vec::new(),
            forbidden: Vec::new(),
            strokes_changed: true,
            uncertainty_m: 0.0,
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
            relief_failure: None,
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
    /// Takes the plan of a simulated home, and shows it.
    pub(crate) fn set_plan(&mut self, plan: &SimulatedPlan) {
        self.true_plan = Some(outlined(plan));
        self.show(Ground::True);
    }

    /// Takes the robot's map of the home.
    pub(crate) fn on_home(&mut self, home: &HomeView) {
        self.home = (home.width > 0).then(|| home.clone());
        self.draw_home();
        self.doors = home.doors.iter().take(ITEMS_MAX).copied().collect();
        self.walls = wall_strokes(home);
        let no_go = home.no_go.iter().take(ITEMS_MAX);
        self.forbidden = no_go.flat_map(|kept| no_go_strokes(&kept.shape)).collect();
        self.strokes_changed = true;
        if self.ground == Ground::Known {
            self.show(Ground::Known);
        }
    }

    /// Takes what a person has chosen.
    pub(crate) fn choose(&mut self, choice: &RoomChoice) {
        let rooms = choice.rooms();
        if self.chosen != rooms {
            self.chosen = rooms;
            self.draw_home();
            self.plan_changed = true;
        }
        self.wanted = choice
            .borders()
            .flat_map(|border| zone_strokes(&border))
            .collect();
        self.avoided = choice.avoid().iter().flat_map(no_go_strokes).collect();
        self.strokes_changed = true;
    }

    /// The home as last received from the robot.
    pub(crate) fn home(&self) -> Option<&HomeView> {
        self.home.as_ref()
    }

    /// The room under a place of the map.
    pub(crate) fn room_at(&self, place: MapPoint) -> Option<u16> {
        room_at(self.home.as_ref()?, place)
    }

    fn draw_home(&mut self) {
        self.known_plan = self.home.as_ref().map(|home| home_plan(home, &self.chosen));
    }

    /// Takes where the robot means to drive.
    pub(crate) fn on_planned_path(&mut self, path: &PlannedPath) {
        self.planned_path = path_dashes(path, DASH_M);
        self.strokes_changed = true;
    }

    /// Takes the robot's estimate; false when the picture stays the same.
    pub(crate) fn on_estimate(&mut self, estimate: &Estimate) -> bool {
        // Twice the standard deviation: 19 times of 20 it is inside.
        let drawn = !estimate.lost && estimate.sigma_m.is_finite();
        let spread_m = if drawn { 2.0 * estimate.sigma_m } else { 0.0 };
        let spread_m = spread_m.clamp(0.0, UNCERTAINTY_MAX_M);
        let changed = (spread_m - self.uncertainty_m).abs() > 0.005;
        if changed {
            self.uncertainty_m = spread_m;
        }
        changed
    }

    /// Lays this under path and robot.
    pub(crate) fn show(&mut self, ground: Ground) {
        self.ground = ground;
        self.plan_changed = true;
        self.refit();
    }

    /// What lies under path and robot.
    pub(crate) fn ground(&self) -> Ground {
        self.ground
    }

    /// That as a plan, if there is one.
    pub(crate) fn plan(&self) -> Option<&SimulatedPlan> {
        match self.ground {
            Ground::Known => self.known_plan.as_ref(),
            Ground::True => self.true_plan.as_ref(),
        }
    }

    /// The contacts of the dock. A floor plan has their place; the robot's map has that of a robot which stands on the dock.
    pub(crate) fn dock(&self) -> Option<Pose> {
        let reported = self.plan()?.dock?;
        Some(match self.ground {
            Ground::Known => dock_contacts(reported, self.radius_m),
            Ground::True => reported,
        })
    }

    /// Doors to be drawn.
    pub(crate) fn doors(&self) -> impl Iterator<Item = &DoorView> {
        let shown = self.ground == Ground::Known;
        self.doors.iter().filter(move |_| shown)
    }

    /// Radius of the disc in which the robot very likely is, metres; 0 when it cannot be drawn.
    pub(crate) fn uncertainty_m(&self) -> f64 {
        self.uncertainty_m
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
        self.sweep(&snapshot.swept, &snapshot.swept_sigma);
        self.add(&snapshot.swept, &snapshot.path_mm, &snapshot.bumps);
    }

    /// Takes what was added. What belongs to another map waits for its snapshot.
    pub(crate) fn on_delta(&mut self, delta: &MapDelta) {
        if delta.map == self.map {
            self.sweep(&delta.swept, &delta.swept_sigma);
            self.add(&delta.swept, &delta.path_mm, &delta.bumps);
        }
    }

    fn sweep(&mut self, swept: &[i32], sigma: &[u32]) {
        self.swept.mark_all(swept, sigma, self.cell_m);
        self.swept_cells += swept.len() / 2;
    }

    fn add(&mut self, swept: &[i32], path_mm: &[i32], bumps: &[BumpMark]) {
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
        if self.plan().is_none() && self.mode == CameraMode::Fitted && !swept.is_empty() {
            self.refit();
        }
    }

    fn touch(&mut self, x: f64, y: f64, radius: f64) {
        self.redraw = self.redraw.with(Redraw::Area(Bounds::around(x, y, radius)));
    }

    /// Takes the estimated pose; false when it is unchanged.
    pub(crate) fn on_pose(&mut self, pose: Pose, now_s: f64) -> bool {
        let moved = differs(self.newest[0].replace(pose), pose);
        if moved {
            self.believed.push(pose, now_s);
        }
        moved
    }

    /// Takes the true pose of a simulated robot; false when it is unchanged.
    pub(crate) fn on_truth(&mut self, pose: Pose, now_s: f64) -> bool {
        let moved = differs(self.newest[1].replace(pose), pose);
        if moved {
            self.truth.push(pose, now_s);
        }
        moved
    }

    /// Looks at the map from an orbit, or from straight above.
    pub(crate) fn look_from(&mut self, orbit: Option<Orbit>) {
        let orbit = orbit.filter(|_| self.relief_failure.is_none());
        self.camera.look_from(orbit);
        self.refit();
    }

    /// Things above the floor cannot be drawn here.
    pub(crate) fn refuse_relief(&mut self, why: String) {
        self.relief_failure = Some(why);
        self.look_from(None);
    }

    /// Why the map stays flat, if it must.
    pub(crate) fn relief_failure(&self) -> Option<&str> {
        self.relief_failure.as_deref()
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
        if let Some(bounds) = self.plan().and_then(plan_bounds) {
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

    /// Moves on to `now_s` and returns where the robot is drawn and what the frame must redraw.
    pub(crate) fn advance(&mut self, now_s: f64) -> (Places, Redraw) {
        let elapsed_s = (now_s - self.drawn_s).clamp(0.0, 0.1);
        self.drawn_s = now_s;
        let places = Places {
            believed: self.believed.sample(now_s),
            truth: self.truth.sample(now_s),
        };
        if let (CameraMode::Following, Some(pose)) = (self.mode, places.believed) {
            let before = self.camera.middle();
            self.camera.follow(MapPoint::of(&pose), elapsed_s);
            let MapPoint { x, y } = self.camera.middle();
            // A hundredth of a pixel cannot be seen.
            if (x - before.x).hypot(y - before.y) * self.camera.scale() > 0.01 {
                self.redraw = Redraw::All;
            }
        }
        let covered = [places.believed, places.truth].into_iter().flatten();
        let radius = (self.body_radius_m() * 1.5).max(self.uncertainty_m);
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
