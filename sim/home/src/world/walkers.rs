//! People and pets that walk. They see the robot and do not step onto it: a foot comes down beside it or not at all,
//! and a pet stops before it. Any contact is therefore caused by the robot.

use crate::plan::{DistanceField, Foot, WalkerKind, WalkerPlan};

/// Milliseconds between two steps of the walkers.
pub(crate) const WALK_MS: u64 = 20;
/// Largest distance of two points of a path, metres; a step spans a few of them.
const PERSON_STRIDE: usize = 5;
/// Time of a step.
const PERSON_STEP_MS: u64 = 640;
/// A pet goes one place on in this time: half a metre a second.
const PET_STEP_MS: u64 = 200;
/// Distance of the feet to each side of the path, metres.
const FOOT_ASIDE_M: f64 = 0.09;
/// A shoe is longer than it is wide; a disc in between.
const FOOT_M: f64 = 0.08;
const PET_M: f64 = 0.11;
/// Clearance around the robot that no foot enters, metres.
const ASIDE_M: f64 = 0.04;
/// After waiting this long a walker continues behind the robot.
const PATIENCE_MS: u64 = 4_000;

/// Everybody who walks, and where their feet are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Walkers {
    walkers: Vec<Walker>,
    pub(crate) feet: Vec<Foot>,
}

/// Somebody.
#[derive(Clone, Debug)]
struct Walker {
    plan: WalkerPlan,
    leg: usize,
    place: usize,
    /// What happens next, happens then.
    due_ms: u64,
    waits_since_ms: Option<u64>,
    left_foot: bool,
    feet: [Option<Foot>; 2],
}

/// Where the robot is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RobotDisc {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) radius_m: f64,
}

impl Walkers {
    pub(crate) fn new(plans: &[WalkerPlan]) -> Self {
        let walkers = plans.iter().filter(|plan| !plan.legs.is_empty());
        Self {
            walkers: walkers.cloned().map(Walker::new).collect(),
            feet: Vec::new(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.walkers.is_empty()
    }

    /// Lets them walk; true when a foot was set or lifted.
    pub(crate) fn walk(&mut self, now_ms: u64, robot: RobotDisc, solid: &DistanceField) -> bool {
        let mut has_moved = false;
        for walker in &mut self.walkers {
            has_moved |= walker.walk(now_ms, robot, solid);
        }
        if has_moved {
            self.feet.clear();
            let feet = self.walkers.iter().flat_map(|walker| walker.feet);
            self.feet.extend(feet.flatten());
        }
        has_moved
    }
}

impl Walker {
    fn new(plan: WalkerPlan) -> Self {
        Self {
            due_ms: plan.from_ms,
            plan,
            leg: 0,
            place: 0,
            waits_since_ms: None,
            left_foot: false,
            feet: [None; 2],
        }
    }

    fn walk(&mut self, now_ms: u64, robot: RobotDisc, solid: &DistanceField) -> bool {
        if now_ms >= self.plan.until_ms {
            let was_there = self.feet.iter().any(Option::is_some);
            self.feet = [None; 2];
            return was_there;
        }
        if now_ms < self.due_ms {
            return false;
        }
        match self.plan.kind {
            WalkerKind::Person => self.step(now_ms, robot, solid),
            WalkerKind::Pet => self.creep(now_ms, robot),
        }
    }

    fn path(&self) -> &[(f64, f64)] {
        self.plan.legs.get(self.leg).map_or(&[], Vec::as_slice)
    }

    fn at(&self, place: usize) -> (f64, f64) {
        let path = self.path();
        path.get(place.min(path.len().saturating_sub(1)))
            .copied()
            .unwrap_or_default()
    }

    /// One foot comes down ahead, the other goes up.
    fn step(&mut self, now_ms: u64, robot: RobotDisc, solid: &DistanceField) -> bool {
        let next = self.place + PERSON_STRIDE;
        let is_last = next >= self.path().len();
        let (here, there) = (self.at(self.place), self.at(next));
        let length = libm::hypot(there.0 - here.0, there.1 - here.1).max(1e-9);
        let side = if self.left_foot {
            FOOT_ASIDE_M
        } else {
            -FOOT_ASIDE_M
        };
        let aside = |side: f64| Foot {
            x_m: there.0 - (there.1 - here.1) / length * side,
            y_m: there.1 + (there.0 - here.0) / length * side,
            radius_m: FOOT_M,
        };
        let feet = if is_last {
            [Some(aside(FOOT_ASIDE_M)), Some(aside(-FOOT_ASIDE_M))]
        } else {
            [Some(aside(side)), None]
        };
        if feet.iter().flatten().any(|foot| is_in_the_way(foot, robot)) {
            if !self.has_waited(now_ms) {
                self.due_ms = now_ms + WALK_MS;
                return false;
            }
            // Over it: both feet are up for a moment.
            self.feet = [None; 2];
        } else {
            self.feet = feet.map(|foot| foot.filter(|foot| solid.at(foot.x_m, foot.y_m) > 0.0));
        }
        self.left_foot = !self.left_foot;
        self.go_on(next, now_ms, PERSON_STEP_MS);
        true
    }

    fn creep(&mut self, now_ms: u64, robot: RobotDisc) -> bool {
        let (x_m, y_m) = self.at(self.place + 1);
        let pet = Foot {
            x_m,
            y_m,
            radius_m: PET_M,
        };
        if is_in_the_way(&pet, robot) {
            if !self.has_waited(now_ms) {
                self.due_ms = now_ms + WALK_MS;
                return false;
            }
            self.feet = [None; 2];
        } else {
            self.feet = [Some(pet), None];
        }
        self.go_on(self.place + 1, now_ms, PET_STEP_MS);
        true
    }

    fn has_waited(&mut self, now_ms: u64) -> bool {
        let since_ms = *self.waits_since_ms.get_or_insert(now_ms);
        now_ms >= since_ms + PATIENCE_MS
    }

    fn go_on(&mut self, next: usize, now_ms: u64, step_ms: u64) {
        self.waits_since_ms = None;
        if next < self.path().len() {
            (self.place, self.due_ms) = (next, now_ms + step_ms);
            return;
        }
        self.leg = (self.leg + 1) % self.plan.legs.len().max(1);
        self.place = 0;
        self.due_ms = now_ms + step_ms + self.plan.rest_ms;
    }
}

fn is_in_the_way(foot: &Foot, robot: RobotDisc) -> bool {
    foot.distance_m(robot.x_m, robot.y_m) < robot.radius_m + ASIDE_M
}
