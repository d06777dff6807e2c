//! A person's hand that pushes the robot over the floor, turns it on the spot, or turns a wheel of a lifted robot.

use home::{World, wrap_angle};

use super::request::WheelChoice;

/// Speed of the rims, m/s: slow enough for every encoder.
const RIM_M_PER_S: f64 = 0.4;
/// Most metres or turns of one movement.
pub(super) const AMOUNT_MAX: f64 = 1000.0;
/// A hand that is blocked stops after this multiple of the movement's time.
const PATIENCE: f64 = 2.0;

/// A movement of the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HandPath {
    /// So many metres over the floor, straight ahead positive.
    Push(f64),
    /// So many turns on the spot, counter-clockwise positive.
    Turn(f64),
    /// So many metres of the rim of one wheel, forward positive.
    Roll(WheelChoice, f64),
}

impl HandPath {
    /// Whether a person would do that: more takes the hand hours, during which nobody else can take hold.
    pub(super) fn is_possible(self) -> bool {
        let (Self::Push(amount) | Self::Turn(amount) | Self::Roll(_, amount)) = self;
        amount.abs() <= AMOUNT_MAX
    }
}

/// How a movement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathEnd {
    /// All of it was made.
    Done,
    /// The robot is blocked.
    Blocked,
}

/// A hand in motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hand {
    path: HandPath,
    /// Metres or radians that are left.
    left: f64,
    left_ms: u64,
    before: MotionBaseline,
}

/// Positions at the start of the movement.
#[derive(Clone, Copy, Debug)]
struct MotionBaseline {
    x_m: f64,
    y_m: f64,
    heading_rad: f64,
    rims_m: [f64; 2],
}

impl MotionBaseline {
    fn of(world: &World) -> Self {
        let pose = world.truth().pose;
        Self {
            x_m: pose.x_m,
            y_m: pose.y_m,
            heading_rad: pose.heading_rad,
            rims_m: world
                .encoder_positions()
                .map(|counts| counts * world.model().drive.count_m),
        }
    }
}

impl Hand {
    /// Takes hold.
    pub(super) fn grip(path: HandPath, world: &mut World) -> Self {
        let half_track_m = 0.5 * world.model().drive.track_m;
        let (left, rim_m, sign, rims) = match path {
            HandPath::Push(distance_m) => (distance_m.abs(), distance_m.abs(), distance_m, [1.0, 1.0]),
            HandPath::Turn(turns) => {
                let angle = turns.abs() * std::f64::consts::TAU;
                (angle, angle * half_track_m, turns, [-1.0, 1.0])
            }
            HandPath::Roll(WheelChoice::Left, distance_m) => {
                (distance_m.abs(), distance_m.abs(), distance_m, [1.0, 0.0])
            }
            HandPath::Roll(WheelChoice::Right, distance_m) => {
                (distance_m.abs(), distance_m.abs(), distance_m, [0.0, 1.0])
            }
        };
        let speed = RIM_M_PER_S.copysign(sign);
        world.turn_wheels(Some(rims.map(|share| share * speed)));
        Self {
            path,
            left,
            left_ms: ((PATIENCE * 1000.0 * rim_m / RIM_M_PER_S) as u64).saturating_add(1),
            before: MotionBaseline::of(world),
        }
    }

    /// A millisecond has passed; lets go at the end.
    pub(super) fn follow(&mut self, world: &mut World) -> Option<PathEnd> {
        let now = MotionBaseline::of(world);
        self.left -= match self.path {
            HandPath::Push(_) => (now.x_m - self.before.x_m).hypot(now.y_m - self.before.y_m),
            HandPath::Turn(_) => wrap_angle(now.heading_rad - self.before.heading_rad).abs(),
            HandPath::Roll(wheel, _) => {
                let side = usize::from(wheel == WheelChoice::Right);
                (now.rims_m[side] - self.before.rims_m[side]).abs()
            }
        };
        self.left_ms = self.left_ms.saturating_sub(1);
        self.before = now;
        let end = match (self.left <= 0.0, self.left_ms) {
            (true, _) => PathEnd::Done,
            (false, 0) => PathEnd::Blocked,
            (false, _) => return None,
        };
        world.turn_wheels(None);
        Some(end)
    }
}

#[cfg(test)]
mod tests {
    use super::{AMOUNT_MAX, HandPath};

    #[test]
    fn no_hand_moves_for_hours_or_by_what_is_no_number() {
        for amount in [AMOUNT_MAX, -AMOUNT_MAX, 0.25] {
            assert!(HandPath::Turn(amount).is_possible(), "{amount}");
        }
        for amount in [1e18, -1e18, 1_001.0, f64::NAN, f64::INFINITY] {
            assert!(!HandPath::Turn(amount).is_possible(), "{amount}");
            assert!(!HandPath::Push(amount).is_possible(), "{amount}");
        }
    }
}
