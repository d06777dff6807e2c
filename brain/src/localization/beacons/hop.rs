//! Collects motion and ranges into hops.

use super::parameters::{HOP, RANGE};
use crate::model::advance::Advance;
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::{BeaconRange, BeaconSignal, Observation};

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
        let over = self.hop.length_m >= HOP.length_m || self.turned_rad >= HOP.turn_rad;
        over.then(|| self.end())
    }

    fn add(&mut self, range: BeaconRange) {
        // Written so that NaN is rejected.
        let believable = range.range_m >= 0.0
            && range.range_m <= RANGE.range_max_m
            && range.sigma_m > 0.0
            && range.sigma_m <= RANGE.sigma_max_m;
        if !believable {
            return;
        }
        let room = self.sums.len() < RANGE.beacons_max;
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
                sigma_m: range.sigma_m.max(RANGE.sigma_min_m),
            }),
            None => {}
        }
    }

    fn end(&mut self) -> Hop {
        let mut hop = core::mem::take(&mut self.hop);
        let turned_rad = core::mem::take(&mut self.turned_rad);
        hop.distance_variance_m2 =
            HOP.slip_m_per_sqrt_m * HOP.slip_m_per_sqrt_m * hop.length_m + HOP.jitter_m * HOP.jitter_m;
        hop.turn_variance_rad2 = if hop.by_gyro {
            let scale_rad = HOP.gyro_scale * turned_rad;
            HOP.gyro_rad * HOP.gyro_rad + scale_rad * scale_rad
        } else {
            HOP.slip_rad_per_sqrt_m * HOP.slip_rad_per_sqrt_m * hop.length_m
                + HOP.turn_rad_per_sqrt_rad * HOP.turn_rad_per_sqrt_rad * turned_rad
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
            sigma_m: libm::sqrt(own_m2 + RANGE.place_sigma_m * RANGE.place_sigma_m),
        }
    }
}
