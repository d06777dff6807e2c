//! The body in the plan: pose, contact with solid things, bumper.

use crate::model::{RobotModel, WheelMotor};
use crate::plan::Solid;
use crate::pose::{Pose, wrap_angle};

/// A switch stays closed this long after the last step in which it was pressed: springs are slower than a step, and in
/// a corner the nearest wall changes from step to step.
const RELEASE_MS: u64 = 15;
/// A new contact counts when the last one is at least this long ago, milliseconds.
const CONTACT_PAUSE_MS: u64 = 100;
/// Most corrections in one step: a corner needs two.
const CORRECTIONS_MAX: usize = 3;
/// A depth beyond what is allowed that is left alone, metres.
const TOUCH_M: f64 = 1e-7;
/// Share of a turn that friction takes while the front leans on a wall.
const WALL_FRICTION: f64 = 0.2;
/// Steps after which cosine and sine are computed afresh.
const REFRESH_STEPS: u32 = 64;

/// The body.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    radius_m: f64,
    travel_m: f64,
    spring_n: f64,
    switch_m: f64,
    arc_cos: f64,
    overlap_sin: f64,
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) heading_rad: f64,
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    steps: u32,
    /// No solid thing is nearer to the rim than this, metres.
    pub(crate) free_m: f64,
    /// Direction of the present contact from straight ahead.
    pub(crate) contact: Option<BodyContact>,
    left_until_ms: u64,
    right_until_ms: u64,
    last_contact_ms: Option<u64>,
    pub(crate) contacts: u32,
}

/// What the body touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyContact {
    /// Cosine of its direction from straight ahead.
    pub(crate) forward: f64,
    /// Sine of its direction from straight ahead, left positive.
    pub(crate) left: f64,
    /// How far the bumper is pressed, 1 = to its end; a rigid part of the body counts as pressed.
    pub(crate) compression: f64,
    /// It is somebody's foot, or a pet.
    pub(crate) is_foot: bool,
}

/// From this compression on the contact is rigid.
pub(crate) const RIGID: f64 = 0.98;

impl Body {
    pub(crate) fn new(model: &RobotModel, pose: Pose) -> Self {
        let mut body = Self {
            radius_m: model.body.radius_m,
            travel_m: model.bumper.travel_m,
            spring_n: model.bumper.force_n,
            switch_m: model.bumper.switch_m,
            arc_cos: libm::cos(model.bumper.half_arc_rad),
            overlap_sin: libm::sin(model.bumper.overlap_rad),
            x_m: 0.0,
            y_m: 0.0,
            heading_rad: 0.0,
            cos: 1.0,
            sin: 0.0,
            steps: 0,
            free_m: 0.0,
            contact: None,
            left_until_ms: 0,
            right_until_ms: 0,
            last_contact_ms: None,
            contacts: 0,
        };
        body.place(pose);
        body
    }

    /// Puts the body somewhere.
    pub(crate) fn place(&mut self, pose: Pose) {
        (self.x_m, self.y_m, self.heading_rad) = (pose.x_m, pose.y_m, pose.heading_rad);
        (self.sin, self.cos) = libm::sincos(self.heading_rad);
        self.free_m = 0.0;
        self.contact = None;
    }

    pub(crate) const fn pose(&self) -> Pose {
        Pose::new(self.x_m, self.y_m, self.heading_rad)
    }

    /// A point of the body in the plan.
    pub(crate) fn point(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        (
            self.x_m + self.cos * x_m - self.sin * y_m,
            self.y_m + self.sin * x_m + self.cos * y_m,
        )
    }

    /// Moves along a small arc without regard to obstacles.
    pub(crate) fn advance(&mut self, distance_m: f64, turn_rad: f64) {
        let half = 0.5 * turn_rad;
        self.x_m += distance_m * (self.cos - self.sin * half);
        self.y_m += distance_m * (self.sin + self.cos * half);
        self.free_m -= distance_m.abs();
        self.turn(turn_rad);
    }

    /// Rotates the direction by a small angle: series up to the second order, refreshed before errors add up.
    fn turn(&mut self, turn_rad: f64) {
        self.heading_rad += turn_rad;
        self.steps += 1;
        if self.steps >= REFRESH_STEPS {
            self.steps = 0;
            (self.sin, self.cos) = libm::sincos(self.heading_rad);
            return;
        }
        let less = 1.0 - 0.5 * turn_rad * turn_rad;
        (self.cos, self.sin) = (
            self.cos * less - self.sin * turn_rad,
            self.sin * less + self.cos * turn_rad,
        );
    }

    /// Pushes the body out of what it ran into, and presses the bumper.
    pub(crate) fn collide(&mut self, solid: Solid<'_>, now_ms: u64) {
        if self.free_m > 0.0 {
            self.contact = None;
            return;
        }
        self.free_m = solid.at(self.x_m, self.y_m) - self.radius_m;
        if self.free_m >= 0.0 {
            self.contact = None;
            return;
        }
        let mut depth_m = -self.free_m;
        for _ in 0..CORRECTIONS_MAX {
            let (away, allowed_m) = self.touch(solid, depth_m, now_ms);
            let excess_m = depth_m - allowed_m;
            if excess_m <= TOUCH_M {
                break;
            }
            self.x_m += away.0 * excess_m;
            self.y_m += away.1 * excess_m;
            depth_m = self.radius_m - solid.at(self.x_m, self.y_m);
            if depth_m <= allowed_m + TOUCH_M {
                break;
            }
        }
        let pause = self.last_contact_ms.map(|last| now_ms - last);
        if pause.is_none_or(|pause| pause > CONTACT_PAUSE_MS) {
            self.contacts += 1;
        }
        self.last_contact_ms = Some(now_ms);
    }

    /// Takes note of what is touched at this depth; gives the direction out of it and the depth that the bumper allows.
    fn touch(&mut self, solid: Solid<'_>, depth_m: f64, now_ms: u64) -> ((f64, f64), f64) {
        let (nx, ny) = solid.away(self.x_m, self.y_m);
        let forward = -(nx * self.cos + ny * self.sin);
        let left = -(ny * self.cos - nx * self.sin);
        let gives_way = forward >= self.arc_cos;
        let compression = if gives_way {
            (depth_m / self.travel_m).min(1.0)
        } else {
            1.0
        };
        self.contact = Some(BodyContact {
            forward,
            left,
            compression,
            is_foot: solid.nearest_foot(self.x_m, self.y_m).is_some(),
        });
        if gives_way && depth_m >= self.switch_m {
            self.press(left, now_ms);
        }
        ((nx, ny), if gives_way { self.travel_m } else { 0.0 })
    }

    /// A body at rest keeps its contacts and the state of its bumper.
    pub(crate) const fn rest(&mut self, now_ms: u64) {
        if self.contact.is_none() {
            return;
        }
        self.last_contact_ms = Some(now_ms);
        if self.left_until_ms >= now_ms {
            self.left_until_ms = now_ms + RELEASE_MS;
        }
        if self.right_until_ms >= now_ms {
            self.right_until_ms = now_ms + RELEASE_MS;
        }
    }

    /// Lifted, the body touches nothing.
    pub(crate) const fn leave_contact(&mut self) {
        self.contact = None;
    }

    fn press(&mut self, left: f64, now_ms: u64) {
        if left >= -self.overlap_sin {
            self.left_until_ms = now_ms + RELEASE_MS;
        }
        if left <= self.overlap_sin {
            self.right_until_ms = now_ms + RELEASE_MS;
        }
    }

    /// Left and right switch.
    pub(crate) fn pressed(&self, now_ms: u64) -> (bool, bool) {
        (now_ms < self.left_until_ms, now_ms < self.right_until_ms)
    }

    /// Direction of the present contact, radians from straight ahead.
    pub(crate) fn contact_rad(&self) -> Option<f64> {
        self.contact
            .map(|contact| wrap_angle(libm::atan2(contact.left, contact.forward)))
    }

    /// Force against one wheel that drives into this direction (1 forward, -1 backward): the bumper's springs, then as
    /// much as the wheel can bring before it slips.
    pub(crate) fn push_n(&self, direction: f64, motor: &WheelMotor) -> f64 {
        let Some(contact) = self.contact else {
            return 0.0;
        };
        let against = (contact.forward * direction).max(0.0);
        if contact.compression >= RIGID {
            motor.traction_n * against
        } else {
            0.5 * self.spring_n * contact.compression * against
        }
    }

    /// Share of a turn that friction takes now.
    pub(crate) fn wall_friction(&self) -> f64 {
        match self.contact {
            Some(contact) if contact.compression >= RIGID => WALL_FRICTION * contact.forward.abs(),
            _ => 0.0,
        }
    }
}
