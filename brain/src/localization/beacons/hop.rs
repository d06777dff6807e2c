//! Collects motion and ranges into hops.

use crate::model::advance::Advance;
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::{BeaconRange, BeaconSignal, Observation};

/// Most beacons; more than enough for a home.
pub(super) const BEACONS_MAX: usize = 8;
/// A hop ends after this distance, metres, or this turn, radians.
const HOP_M: f64 = 0.15;
const HOP_RAD: f64 = 0.5;
/// Range error that stays the same around a place, metres, because of walls in the path. The mean of many ranges of a hop is no
/// better than this. Several hops lie in one such place, so each counts less than it would alone.
const PLACE_SIGMA_M: f64 = 0.45;
/// Greatest accepted range and standard deviation, metres.
const RANGE_MAX_M: f64 = 100.0;
const SIGMA_MAX_M: f64 = 10.0;
/// Least accepted standard deviation of one range, metres.
const SIGMA_MIN_M: f64 = 0.02;
/// Slip, metres per square root of a metre, and what each hop adds, metres.
const SLIP_M_PER_SQRT_M: f64 = 0.012;
const JITTER_M: f64 = 0.004;
/// Heading error of the wheels: slip per square root of a metre, and turns per square root of a radian. Coarse encoders lose a
/// count at each reversal.
const SLIP_RAD_PER_SQRT_M: f64 = 0.01;
const TURN_RAD_PER_SQRT_RAD: f64 = 0.015;
/// Heading error of a gyro, radians per hop and per radian turned.
const GYRO_RAD: f64 = 0.002;
const GYRO_SCALE: f64 = 0.006;

/// Motion and ranges of a hop.
#[derive(Clone, Debug, Default)]
pub(super) struct Hop {
    /// Motion by odometry.
    pub(super) step: Pose2,
    /// Distance of the centre, negative when reversing, metres.
    pub(super) distance_m: f64,
    /// Distance driven, also backwards, metres.
    pub(super) length_m: f64,
    /// Turn that the wheels counted, radians.
    pub(super) wheel_turn_rad: f64,
    /// Variances of distance and turn.
    pub(super) distance_variance_m2: f64,
    pub(super) turn_variance_rad2: f64,
    /// The turn comes from a gyro.
    pub(super) by_gyro: bool,
    /// Mean range to each beacon and its standard deviation.
    pub(super) ranges: Vec<BeaconRange>,
}

impl Hop {
    /// The hop's middle, seen from its end. Ranges are measured all along the hop.
    pub(super) fn middle(&self) -> Point2 {
        let back = self.step.inverse();
        Point2 {
            x_m: 0.5 * back.x_m,
            y_m: 0.5 * back.y_m,
        }
    }

    /// The motion after a correction of the wheels: more turn by `scale` and by `bend_rad_per_m`, more distance by `stretch`.
    pub(super) fn corrected(&self, [bend_rad_per_m, scale, stretch]: [f64; 3]) -> Pose2 {
        let (bend_rad_per_m, scale) = if self.by_gyro {
            (0.0, 0.0)
        } else {
            (bend_rad_per_m, scale)
        };
        let more_rad = scale * self.wheel_turn_rad + bend_rad_per_m * self.distance_m;
        let (sin, cos) = libm::sincos(0.5 * more_rad);
        let longer = 1.0 + stretch;
        Pose2 {
            x_m: longer * (cos * self.step.x_m - sin * self.step.y_m),
            y_m: longer * (sin * self.step.x_m + cos * self.step.y_m),
            heading_rad: self.step.heading_rad + more_rad,
        }
    }
}

/// A hop in progress.
#[derive(Clone, Debug, Default)]
pub(super) struct HopBuilder {
    hop: Hop,
    turned_rad: f64,
    sums: Vec<RangeSum>,
}

#[derive(Clone, Copy, Debug)]
struct RangeSum {
    beacon: u16,
    count: u32,
    range_m: f64,
    sigma_m: f64,
}

impl HopBuilder {
    /// Adds a step. Returns the hop if it ends here.
    pub(super) fn take(&mut self, observation: &Observation, advance: Advance) -> Option<Hop> {
        let hop = &mut self.hop;
        hop.step = hop.step.after_arc(advance.distance_m, advance.turn_rad);
        hop.distance_m += advance.distance_m;
        hop.length_m += advance.distance_m.abs();
        hop.by_gyro = advance.gyro_turn_rad.is_some();
        hop.wheel_turn_rad += advance.wheel_turn_rad;
        self.turned_rad += advance.turn_rad.abs();
        for signal in &observation.beacons {
            if let BeaconSignal::Range(range) = signal {
                self.add(*range);
            }
        }
        let over = self.hop.length_m >= HOP_M || self.turned_rad >= HOP_RAD;
        over.then(|| self.end())
    }

    fn add(&mut self, range: BeaconRange) {
        // Written so that NaN is rejected.
        let believable = range.range_m >= 0.0
            && range.range_m <= RANGE_MAX_M
            && range.sigma_m > 0.0
            && range.sigma_m <= SIGMA_MAX_M;
        if !believable {
            return;
        }
        let room = self.sums.len() < BEACONS_MAX;
        let known = self.sums.iter_mut().find(|sum| sum.beacon == range.beacon);
        match known {
            Some(sum) => {
                sum.count += 1;
                sum.range_m += range.range_m;
                sum.sigma_m = sum.sigma_m.max(range.sigma_m);
            }
            None if room => self.sums.push(RangeSum {
                beacon: range.beacon,
                count: 1,
                range_m: range.range_m,
                sigma_m: range.sigma_m.max(SIGMA_MIN_M),
            }),
            None => {}
        }
    }

    fn end(&mut self) -> Hop {
        let mut hop = core::mem::take(&mut self.hop);
        let turned_rad = core::mem::take(&mut self.turned_rad);
        hop.distance_variance_m2 = SLIP_M_PER_SQRT_M * SLIP_M_PER_SQRT_M * hop.length_m + JITTER_M * JITTER_M;
        hop.turn_variance_rad2 = if hop.by_gyro {
            let scale_rad = GYRO_SCALE * turned_rad;
            GYRO_RAD * GYRO_RAD + scale_rad * scale_rad
        } else {
            SLIP_RAD_PER_SQRT_M * SLIP_RAD_PER_SQRT_M * hop.length_m
                + TURN_RAD_PER_SQRT_RAD * TURN_RAD_PER_SQRT_RAD * turned_rad
        };
        hop.ranges = self.sums.drain(..).map(RangeSum::mean).collect();
        hop.ranges.sort_by_key(|range| range.beacon);
        hop
    }
}

impl RangeSum {
    fn mean(self) -> BeaconRange {
        let count = f64::from(self.count);
        let own_m2 = self.sigma_m * self.sigma_m / count;
        BeaconRange {
            beacon: self.beacon,
            range_m: self.range_m / count,
            sigma_m: libm::sqrt(own_m2 + PLACE_SIGMA_M * PLACE_SIGMA_M),
        }
    }
}
