//! A paper world for the brain's own tests: a disc that drives among rectangles, with the reflexes of the firmware.
//! It knows no slip, no motors and no time but its own; the real physics are in `sim/`.

pub(crate) mod beams;

use beams::Sight;
use brain::observation::{Cliffs, Contacts};
use brain::{
    Actions, Body, Brain, BrainConfig, Command, Inhibit, Inhibits, JobCommand, MapEdit, Motion, Observation,
    Point2, Pose2, Speeds,
};

use crate::script::leads_away;

pub(crate) const STEP_S: f64 = 0.02;
pub(crate) const BODY: Body = Body {
    radius_m: 0.175,
    swath_m: 0.30,
    track_m: 0.23,
};
pub(crate) const SPEEDS: Speeds = Speeds {
    cruise_m_per_s: 0.25,
    max_m_per_s: 0.35,
    turn_max_rad_per_s: 1.5,
};
const CELL_M: f64 = 0.025;
const CLIFF_LEAD_M: f64 = 0.155;

pub(crate) fn config() -> BrainConfig {
    BrainConfig::new(BODY, SPEEDS)
}

/// An axis-parallel rectangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rectangle {
    pub(crate) low: (f64, f64),
    pub(crate) high: (f64, f64),
}

impl Rectangle {
    pub(crate) fn new(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { low, high }
    }

    fn distance_m(&self, point: Point2) -> f64 {
        let dx = (self.low.0 - point.x_m).max(0.0).max(point.x_m - self.high.0);
        let dy = (self.low.1 - point.y_m).max(0.0).max(point.y_m - self.high.1);
        dx.hypot(dy)
    }

    fn nearest(&self, point: Point2) -> Point2 {
        Point2 {
            x_m: point.x_m.clamp(self.low.0, self.high.0),
            y_m: point.y_m.clamp(self.low.1, self.high.1),
        }
    }
}

/// A room with the origin in its lower left corner, and what stands in it.
pub(crate) struct Room {
    pub(crate) size_m: (f64, f64),
    pub(crate) furniture: Vec<Rectangle>,
    pub(crate) holes: Vec<Rectangle>,
}

impl Room {
    pub(crate) fn empty(size_m: (f64, f64)) -> Self {
        let (width, depth) = size_m;
        let wall = 1.0;
        let walls = vec![
            Rectangle::new((-wall, -wall), (0.0, depth + wall)),
            Rectangle::new((width, -wall), (width + wall, depth + wall)),
            Rectangle::new((-wall, -wall), (width + wall, 0.0)),
            Rectangle::new((-wall, depth), (width + wall, depth + wall)),
        ];
        Self {
            size_m,
            furniture: walls,
            holes: Vec::new(),
        }
    }

    pub(crate) fn with(mut self, furniture: &[Rectangle]) -> Self {
        self.furniture.extend_from_slice(furniture);
        self
    }

    pub(crate) fn clearance(&self, point: Point2) -> (f64, Point2) {
        let nearest = self
            .furniture
            .iter()
            .min_by(|a, b| a.distance_m(point).total_cmp(&b.distance_m(point)));
        let nearest = nearest.expect("a room has walls");
        (nearest.distance_m(point), nearest.nearest(point))
    }
}

/// The robot in the room, and the judge.
pub(crate) struct World {
    pub(crate) room: Room,
    pub(crate) pose: Pose2,
    pub(crate) observation: Observation,
    pub(crate) violations: Vec<String>,
    pub(crate) swept: Vec<bool>,
    /// Infrared eyes, if the robot has any.
    pub(crate) sight: Option<Sight>,
    columns: usize,
    motion: (f64, f64),
}

impl World {
    pub(crate) fn new(room: Room, pose: Pose2) -> Self {
        let columns = (room.size_m.0 / CELL_M) as usize;
        let rows = (room.size_m.1 / CELL_M) as usize;
        Self {
            room,
            pose,
            observation: Observation {
                gyro_heading_rad: Some(0.0),
                ..Observation::default()
            },
            violations: Vec::new(),
            swept: vec![false; columns * rows],
            sight: None,
            columns,
            motion: (0.0, 0.0),
        }
    }

    /// Moves for one step as the brain asked, and perceives.
    pub(crate) fn step(&mut self, actions: &Actions) {
        self.check(actions);
        let wish = match actions.motion {
            Motion::Drive {
                speed_m_per_s,
                turn_rad_per_s,
            } => (speed_m_per_s, turn_rad_per_s),
            Motion::Halt | Motion::Rest => (0.0, 0.0),
        };
        // Motors follow within about 60 ms.
        self.motion.0 += (wish.0 - self.motion.0) * (STEP_S / 0.06);
        self.motion.1 += (wish.1 - self.motion.1) * (STEP_S / 0.06);
        let (distance_m, turn_rad) = (self.motion.0 * STEP_S, self.motion.1 * STEP_S);
        let before = self.pose;
        self.pose = self.pushed_out(before.after_arc(distance_m, turn_rad));
        let made = before.inverse().transform(self.pose.position());
        self.roll(made.x_m, turn_rad);
        self.perceive(wish.0);
        if actions.cleaners {
            self.sweep();
        }
    }

    /// Obstacles are hard and smooth: the disc slides along them.
    fn pushed_out(&self, pose: Pose2) -> Pose2 {
        let (clearance_m, nearest) = self.room.clearance(pose.position());
        if clearance_m >= BODY.radius_m || clearance_m == 0.0 {
            return if clearance_m == 0.0 { self.pose } else { pose };
        }
        let grow = BODY.radius_m / clearance_m;
        let x_m = nearest.x_m + (pose.x_m - nearest.x_m) * grow;
        let y_m = nearest.y_m + (pose.y_m - nearest.y_m) * grow;
        let pushed = Pose2 { x_m, y_m, ..pose };
        // Two obstacles at once leave no way.
        if self.room.clearance(pushed.position()).0 < BODY.radius_m - 1e-6 {
            self.pose
        } else {
            pushed
        }
    }

    fn roll(&mut self, distance_m: f64, turn_rad: f64) {
        let observation = &mut self.observation;
        observation.time_us += 20_000;
        observation.travel_left_m += distance_m - 0.5 * BODY.track_m * turn_rad;
        observation.travel_right_m += distance_m + 0.5 * BODY.track_m * turn_rad;
        observation.gyro_heading_rad = observation.gyro_heading_rad.map(|heading| heading + turn_rad);
    }

    fn perceive(&mut self, wished_m_per_s: f64) {
        let pushes = wished_m_per_s > 0.0 || self.observation.contacts.any();
        let mut contacts = Contacts::default();
        for thing in &self.room.furniture {
            let local = self.pose.inverse().transform(thing.nearest(self.pose.position()));
            let bearing_rad = local.y_m.atan2(local.x_m);
            if pushes && local.x_m > 0.0 && local.x_m.hypot(local.y_m) < BODY.radius_m + 0.008 {
                contacts.left |= bearing_rad > -0.2;
                contacts.right |= bearing_rad < 0.2;
            }
        }
        let hole = |side_m: f64| {
            let eye = self.pose.transform(Point2 {
                x_m: CLIFF_LEAD_M,
                y_m: side_m,
            });
            self.room.holes.iter().any(|hole| hole.distance_m(eye) == 0.0)
        };
        let cliffs = Cliffs {
            left: hole(0.1),
            middle: hole(0.0),
            right: hole(-0.1),
        };
        if let Some(sight) = &self.sight {
            let moment = self.observation.time_us;
            self.observation.proximity = sight.look(self.pose, &self.room.furniture, moment);
        }
        self.observation.contacts = contacts;
        self.observation.cliffs = cliffs;
        self.observation.inhibits = Inhibits::NONE;
        if contacts.any() {
            self.observation.inhibits.insert(Inhibit::Bumper);
        }
        if cliffs.any() {
            self.observation.inhibits.insert(Inhibit::Cliff);
        }
    }

    /// What the firmware would have to refuse is a violation.
    fn check(&mut self, actions: &Actions) {
        let Motion::Drive {
            speed_m_per_s,
            turn_rad_per_s,
        } = actions.motion
        else {
            return;
        };
        let held = !self.observation.inhibits.is_empty();
        if held && !leads_away(speed_m_per_s, turn_rad_per_s, &self.observation) {
            self.violations.push(format!(
                "{:?} against {:?}",
                actions.motion, self.observation.inhibits
            ));
        }
        if self.observation.cliffs.any() && speed_m_per_s < -0.1 {
            self.violations
                .push(format!("{:?} is too fast at a cliff", actions.motion));
        }
    }

    fn sweep(&mut self) {
        let half_m = 0.5 * BODY.swath_m;
        let steps = (2.0 * half_m / (0.5 * CELL_M)) as i32;
        for step in 0..=steps {
            let point = self.pose.transform(Point2 {
                x_m: 0.0,
                y_m: -half_m + 0.5 * CELL_M * f64::from(step),
            });
            let (x, y) = ((point.x_m / CELL_M) as usize, (point.y_m / CELL_M) as usize);
            if x < self.columns
                && let Some(cell) = self.swept.get_mut(y * self.columns + x)
            {
                *cell = true;
            }
        }
    }

    /// Share of the floor that the robot's centre can reach within half a swath that was swept.
    pub(crate) fn covered(&self) -> f64 {
        let free = |index: &usize| {
            let (x, y) = (index % self.columns, index / self.columns);
            let point = Point2 {
                x_m: (x as f64 + 0.5) * CELL_M,
                y_m: (y as f64 + 0.5) * CELL_M,
            };
            self.room.clearance(point).0 > BODY.radius_m - 0.5 * BODY.swath_m
        };
        let (swept, all) = (0..self.swept.len())
            .filter(free)
            .fold((0, 0), |(swept, all), index| {
                (swept + usize::from(self.swept[index]), all + 1)
            });
        swept as f64 / all as f64
    }
}

/// Runs a brain in a world for a while.
pub(crate) fn run(world: &mut World, brain: &mut Brain, command: Option<JobCommand>, seconds: f64) {
    step_for(world, brain, command.map(Command::Job), seconds);
}

/// Edits the map of a brain in a world.
pub(crate) fn edit(world: &mut World, brain: &mut Brain, edit: MapEdit) {
    step_for(world, brain, Some(Command::Edit(edit)), 0.1);
}

fn step_for(world: &mut World, brain: &mut Brain, command: Option<Command>, seconds: f64) {
    let mut commands = Vec::from_iter(command);
    for _ in 0..(seconds / STEP_S) as u32 {
        let actions = brain.step(&world.observation, &commands);
        commands.clear();
        world.step(&actions);
    }
}
