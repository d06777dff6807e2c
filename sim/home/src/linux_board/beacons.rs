//! Radio beacons in a home, and a radio on the robot that measures their distance, or how strongly it
//! receives them.
//!
//! The figures of ranges are those of ultra-wideband modules of the Decawave class (Sensors 22 (2022) 2927: 0.21 m in
//! motion, 0.25 m mixed): noise of [`Beacons::SIGMA_M`], a delay behind walls that always lengthens the range and is
//! constant at a place, lost replies, and occasional reflections by the ceiling.

use super::strength::Air;
use crate::{Home, Pcg, Pose};

/// Stream of random numbers, beside those of the world.
const STREAM: u64 = 6;
/// Milliseconds between two measurements; the beacons take turns.
const TURN_MS: u64 = 50;
/// Share of measurements without an answer, in sight and behind walls.
const LOST_IN_SIGHT: f64 = 0.03;
const LOST_BEHIND: f64 = 0.2;
/// Longest delay by obstacles, metres; uniformly distributed below it.
const DELAY_MAX_M: f64 = 0.6;
/// Places so near to each other have the same delay, metres.
const PATCH_M: f64 = 0.5;
/// Share of ranges that came by a detour, and how long it is at most, metres.
const DETOURS: f64 = 0.02;
const DETOUR_MAX_M: f64 = 3.0;
/// Sampling step along the line of sight, metres.
const LOOK_M: f64 = 0.04;
/// Solid cells that count as an obstacle: a leg of a chair does not.
const SOLID_STEPS: u32 = 2;

/// What was measured of a beacon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured {
    /// Distance, metres.
    Range(f64),
    /// Received power, dBm.
    Strength(f64),
}

/// What the radio measures.
#[derive(Clone, Copy, Debug)]
enum RadioKind {
    Ranges,
    Strengths(Air),
}

/// Ranges that are too long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LongRanges {
    /// Behind anything solid, by a delay that is constant around a place; and a few that came by a detour.
    BehindWalls,
    /// Around some places, whatever stands between, each by a delay of its own.
    Share {
        /// Share of such places, 0..1.
        share: f64,
        /// Least delay, metres.
        least_m: f64,
        /// Greatest delay, metres.
        most_m: f64,
    },
}

/// A beacon that falls silent for good.
#[derive(Clone, Copy, Debug)]
struct Failure {
    number: u16,
    /// After so many milliseconds.
    from_step: u64,
}

/// A beacon and its place in the plan frame, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beacon {
    pub(super) number: u16,
    pub(super) place: (f64, f64),
}

/// Beacons and radio. The same seed and the same poses give the same measurements.
#[derive(Clone, Debug)]
pub struct Beacons {
    places: Vec<(f64, f64)>,
    kind: RadioKind,
    long: LongRanges,
    failure: Option<Failure>,
    delays: u64,
    random: Pcg,
    steps: u64,
}

impl Beacons {
    /// Deviation of a range in sight, metres.
    pub const SIGMA_M: f64 = 0.2;

    /// `count` beacons where the reachable floor ends in as many directions, the first to the upper right.
    #[must_use]
    pub fn around(home: &Home, count: usize, seed: u64) -> Self {
        let mut random = Pcg::new(seed, STREAM);
        let grid = home.grid();
        let reachable = || {
            home.reachable()
                .iter()
                .enumerate()
                .filter(|(_, reachable)| **reachable)
        };
        let places = (0..count)
            .filter_map(|number| {
                let share = (number as f64 + 0.5) / count as f64;
                let (sin, cos) = libm::sincos(core::f64::consts::TAU * share);
                reachable()
                    .map(|(index, _)| grid.centre(index))
                    .max_by(|one, other| {
                        let along = |place: &(f64, f64)| cos * place.0 + sin * place.1;
                        along(one).total_cmp(&along(other))
                    })
            })
            .collect();
        Self {
            places,
            kind: RadioKind::Ranges,
            long: LongRanges::BehindWalls,
            failure: None,
            delays: u64::from(random.next_u32()) << 32 | u64::from(random.next_u32()),
            random,
            steps: 0,
        }
    }

    /// The same beacons with a radio that reports signal strength only.
    #[must_use]
    pub fn by_strength(self) -> Self {
        Self {
            kind: RadioKind::Strengths(Air::new(self.delays)),
            ..self
        }
    }

    /// The same beacons with other ranges that are too long.
    #[must_use]
    pub fn with_long_ranges(self, long: LongRanges) -> Self {
        Self { long, ..self }
    }

    /// The same beacons, of which the last falls silent after so many milliseconds.
    #[must_use]
    pub fn with_failure(self, after_ms: u64) -> Self {
        let last = self.places.len().checked_sub(1);
        Self {
            failure: last
                .and_then(|last| u16::try_from(last).ok())
                .map(|number| Failure {
                    number,
                    from_step: after_ms,
                }),
            ..self
        }
    }

    /// The same beacons, of which somebody has moved one by so much, metres. A number that there is not is ignored.
    #[must_use]
    pub fn with_moved(mut self, number: usize, by_m: (f64, f64)) -> Self {
        if let Some(place) = self.places.get_mut(number) {
            *place = (place.0 + by_m.0, place.1 + by_m.1);
        }
        self
    }

    /// Places of the beacons in the plan frame, metres.
    #[must_use]
    pub fn places(&self) -> &[(f64, f64)] {
        &self.places
    }

    /// One millisecond later the robot is at `pose` of the plan: number of a beacon and what was measured of it, if
    /// something was now.
    pub fn step(&mut self, home: &Home, pose: Pose) -> Option<(u16, Measured)> {
        self.steps += 1;
        if !self.steps.is_multiple_of(TURN_MS) || self.places.is_empty() {
            return None;
        }
        let turn = (self.steps / TURN_MS) as usize % self.places.len();
        let place = *self.places.get(turn)?;
        let number = u16::try_from(turn).ok()?;
        let is_silent = |failure: &Failure| failure.number == number && self.steps >= failure.from_step;
        if self.failure.as_ref().is_some_and(is_silent) {
            return None;
        }
        let beacon = Beacon { number, place };
        let measured = match self.kind {
            RadioKind::Ranges => Measured::Range(self.measure(home, pose, beacon)?),
            RadioKind::Strengths(air) => {
                let mean_dbm = air.mean_dbm(home, pose, beacon);
                Measured::Strength(Air::receive(mean_dbm, &mut self.random)?)
            }
        };
        Some((number, measured))
    }

    fn measure(&mut self, home: &Home, pose: Pose, Beacon { number, place }: Beacon) -> Option<f64> {
        let away_m = libm::hypot(place.0 - pose.x_m, place.1 - pose.y_m);
        let behind = is_behind(home, (pose.x_m, pose.y_m), place);
        let lost = if behind { LOST_BEHIND } else { LOST_IN_SIGHT };
        if self.random.unit() < lost {
            return None;
        }
        let mut range_m = away_m + Self::SIGMA_M * self.random.normal();
        match self.long {
            LongRanges::BehindWalls => {
                if behind {
                    range_m += DELAY_MAX_M * self.drawn_around(number, pose, 0);
                }
                if self.random.unit() < DETOURS {
                    range_m += DETOUR_MAX_M * self.random.unit();
                }
            }
            LongRanges::Share {
                share,
                least_m,
                most_m,
            } => {
                if self.drawn_around(number, pose, 1) < share {
                    range_m += least_m + (most_m - least_m) * self.drawn_around(number, pose, 2);
                }
            }
        }
        Some(range_m.max(0.0))
    }

    /// A number between 0 and 1 that is constant for a beacon around a place; one for each `draw`.
    fn drawn_around(&self, number: u16, pose: Pose, draw: u64) -> f64 {
        let patch = |value: f64| libm::floor(value / PATCH_M) as i64 as u64;
        let mut hash = self.delays ^ draw.wrapping_mul(0xbf58_476d_1ce4_e5b9);
        hash ^= u64::from(number).wrapping_mul(0xd6e8_feb8_6659_fd93);
        hash ^= patch(pose.x_m).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^= patch(pose.y_m).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        hash = (hash ^ (hash >> 31)).wrapping_mul(0xd6e8_feb8_6659_fd93);
        f64::from((hash >> 32) as u32) / 4_294_967_296.0
    }
}

/// Whether an obstacle blocks the line of sight.
fn is_behind(home: &Home, from: (f64, f64), to: (f64, f64)) -> bool {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let steps = libm::ceil(libm::hypot(dx, dy) / LOOK_M).max(1.0) as u32;
    let mut solid = 0;
    for step in 1..steps {
        let share = f64::from(step) / f64::from(steps);
        if home
            .grid()
            .at(from.0 + share * dx, from.1 + share * dy)
            .is_solid()
        {
            solid += 1;
        }
        if solid >= SOLID_STEPS {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::{Beacons, LongRanges, Measured};
    use crate::{Home, Pose, RobotModel};

    /// Two rooms with a wall between them and a door at its upper end.
    const PLAN: &str = "format = \"librervac-home\"\nversion = 1\n\
        [[room]]\npolygon = [[0, 0], [3, 0], [3, 3], [0, 3]]\n\
        [[room]]\npolygon = [[3.1, 0], [6, 0], [6, 3], [3.1, 3]]\n\
        [[room]]\npolygon = [[2.9, 2], [3.2, 2], [3.2, 2.9], [2.9, 2.9]]\n";

    fn errors_m(at: Pose) -> (Vec<f64>, usize) {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("flat", PLAN, &model).unwrap();
        let mut beacons = Beacons::around(&home, 4, 7);
        assert_eq!(beacons.places().len(), 4);
        let (x_m, y_m) = beacons.places()[0];
        let mut errors = Vec::new();
        let mut asked = 0;
        for step in 1..=200_000_u64 {
            asked += usize::from(step.is_multiple_of(200));
            if let Some((0, Measured::Range(range_m))) = beacons.step(&home, at) {
                errors.push(range_m - libm::hypot(x_m - at.x_m, y_m - at.y_m));
            }
        }
        (errors, asked)
    }

    #[test]
    fn in_sight_ranges_are_right_on_average_and_behind_a_wall_too_long() {
        let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
        let (seen, asked) = errors_m(Pose::new(4.5, 2.0, 0.0));
        assert!(mean(&seen).abs() < 0.1, "{}", mean(&seen));
        assert!(seen.len() > asked * 9 / 10, "{} of {asked}", seen.len());
        let (behind, _) = errors_m(Pose::new(0.6, 0.6, 0.0));
        assert!(behind.len() < seen.len(), "fewer answers come through a wall");
    }

    /// Errors of the ranges to the first beacon, at places all over the first room, a second at each.
    fn errors_all_over_m(beacons: Beacons) -> Vec<Vec<f64>> {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("flat", PLAN, &model).unwrap();
        let mut beacons = beacons;
        let (x_m, y_m) = beacons.places()[0];
        let mut places = Vec::new();
        for number in 0..400 {
            let (column, row) = (number % 20, number / 20);
            let at = Pose::new(0.1 + 0.14 * f64::from(column), 0.1 + 0.14 * f64::from(row), 0.0);
            let mut errors = Vec::new();
            for _ in 0..4_000 {
                if let Some((0, Measured::Range(range_m))) = beacons.step(&home, at) {
                    errors.push(range_m - libm::hypot(x_m - at.x_m, y_m - at.y_m));
                }
            }
            places.push(errors);
        }
        places
    }

    fn flat_beacons(seed: u64) -> Beacons {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("flat", PLAN, &model).unwrap();
        Beacons::around(&home, 4, seed)
    }

    #[test]
    fn a_share_of_all_places_has_ranges_that_are_too_long_by_an_amount_of_its_own() {
        let long = LongRanges::Share {
            share: 0.25,
            least_m: 1.0,
            most_m: 2.0,
        };
        let (mut all, mut too_long) = (0_u32, 0_u32);
        for seed in 1..=8 {
            for errors in errors_all_over_m(flat_beacons(seed).with_long_ranges(long)) {
                assert!(errors.len() > 4, "{} ranges at a place", errors.len());
                let mean_m = errors.iter().sum::<f64>() / errors.len() as f64;
                let spread_m = errors
                    .iter()
                    .map(|error| (error - mean_m).abs())
                    .fold(0.0, f64::max);
                assert!(
                    spread_m < 5.5 * Beacons::SIGMA_M,
                    "one place, one delay: {spread_m}"
                );
                assert!(mean_m < 2.3, "{mean_m}");
                all += 1;
                too_long += u32::from(mean_m > 0.75);
            }
        }
        let share = f64::from(too_long) / f64::from(all);
        assert!((0.15..0.35).contains(&share), "{share}");
    }

    #[test]
    fn the_last_beacon_falls_silent_for_good_and_the_others_do_not() {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("flat", PLAN, &model).unwrap();
        let mut beacons = flat_beacons(3).with_failure(30_000);
        let mut heard = [[0_u32; 4]; 2];
        for step in 1..=90_000_u64 {
            let Some((number, _)) = beacons.step(&home, Pose::new(4.5, 2.0, 0.0)) else {
                continue;
            };
            heard[usize::from(step >= 30_000)][usize::from(number)] += 1;
        }
        assert!(heard[0].iter().all(|count| *count > 100), "{heard:?}");
        assert_eq!(heard[1][3], 0, "{heard:?}");
        assert!(heard[1][..3].iter().all(|count| *count > 200), "{heard:?}");
    }
}
