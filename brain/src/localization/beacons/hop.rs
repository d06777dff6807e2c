//! Collects motion and ranges into hops.

use super::filter::ERRORS;
use super::parameters::{HOP, RANGE};
use crate::model::advance::Advance;
use crate::model::geometry::{Point2, Pose2};
use crate::model::observation::{BeaconRange, BeaconSignal, Observation};
use crate::model::pose_estimate::PoseEstimate;

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
    /// Something was touched, so the wheels may have slipped.
    pub(super) touched: bool,
    /// Mean range to each beacon, with the standard deviation that noise alone gives it.
    pub(super) ranges: Vec<HopRange>,
    /// Its end, beside the motion.
    pub(super) end: HopEnd,
    /// The pose at its end by a map, now and then.
    pub(super) anchor: Option<Anchor>,
}

/// When and where a hop ended.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HopEnd {
    /// Time, microseconds.
    pub(super) time_us: u64,
    /// Pose by odometry.
    pub(super) odom: Pose2,
    /// Pose at which the map was drawn.
    pub(super) drawn: Pose2,
}

/// A pose that a map gives, with its standard deviations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    pub(super) pose: Pose2,
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// The range of a hop to a beacon.
#[derive(Clone, Copy, Debug)]
pub(super) struct HopRange {
    pub(super) beacon: u16,
    pub(super) range_m: f64,
    /// Standard deviation that noise alone gives it, metres.
    pub(super) sigma_m: f64,
    /// How often errors that stay the same around a place were counted already: a robot that turns on the spot learns nothing of them.
    pub(super) repeats: f64,
    /// Where it was measured on average, seen from the end of the hop.
    pub(super) at: Point2,
}

impl Hop {
    /// Derivatives of its turn by the wheels' bend and scale: none when a gyro tells the turn.
    pub(super) fn turn_by_errors(&self) -> (f64, f64) {
        if self.by_gyro {
            (0.0, 0.0)
        } else {
            (self.distance_m, self.wheel_turn_rad)
        }
    }

    /// The motion after a correction of the wheels: more turn by `scale` and by `bend_rad_per_m`, more distance by `stretch`.
    pub(super) fn corrected(&self, [bend_rad_per_m, scale, stretch, ..]: [f64; ERRORS]) -> Pose2 {
        let (by_bend, by_scale) = self.turn_by_errors();
        let more_rad = scale * by_scale + bend_rad_per_m * by_bend;
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
    heard: Vec<HopRanges>,
}

/// All ranges of a hop to a beacon.
#[derive(Clone, Debug)]
struct HopRanges {
    beacon: u16,
    ranges_m: Vec<f64>,
    sigma_m: f64,
    /// Sum of the places at which they were measured, seen from the start of the hop.
    places: Point2,
}

impl HopBuilder {
    /// An estimate of the last hop's end, continued to where the robot is now.
    pub(super) fn ahead_of(&self, estimate: PoseEstimate) -> PoseEstimate {
        PoseEstimate {
            pose: estimate.pose * self.hop.step,
            ..estimate
        }
    }

    /// Adds a step. Returns the hop if it ends here.
    pub(super) fn take(&mut self, observation: &Observation, advance: Advance) -> Option<Hop> {
        let hop = &mut self.hop;
        hop.step = hop.step.after_arc(advance.distance_m, advance.turn_rad);
        hop.distance_m += advance.distance_m;
        hop.length_m += advance.distance_m.abs();
        hop.by_gyro = advance.gyro_turn_rad.is_some();
        hop.touched |= observation.is_touching();
        hop.wheel_turn_rad += advance.wheel_turn_rad;
        self.turned_rad += advance.turn_rad.abs();
        for signal in &observation.beacons {
            if let BeaconSignal::Range(range) = signal {
                self.add(*range);
            }
        }
        self.hop.end.time_us = observation.time_us;
        let over = self.hop.length_m >= HOP.length_m || self.turned_rad >= HOP.turn_rad;
        over.then(|| self.end())
    }

    fn add(&mut self, range: BeaconRange) {
        // Written so that NaN is rejected.
        let believable = range.range_m > 0.0
            && range.range_m <= RANGE.range_max_m
            && range.sigma_m > 0.0
            && range.sigma_m <= RANGE.sigma_max_m;
        if !believable {
            return;
        }
        let room = self.heard.len() < RANGE.beacons_max;
        let at = self.hop.step.position();
        let known = self.heard.iter_mut().find(|of_it| of_it.beacon == range.beacon);
        match known {
            Some(of_it) if of_it.ranges_m.len() < RANGE.of_hop_max => {
                of_it.ranges_m.push(range.range_m);
                of_it.sigma_m = of_it.sigma_m.max(range.sigma_m);
                of_it.places.x_m += at.x_m;
                of_it.places.y_m += at.y_m;
            }
            None if room => self.heard.push(HopRanges {
                beacon: range.beacon,
                ranges_m: vec![range.range_m],
                sigma_m: range.sigma_m.max(RANGE.sigma_min_m),
                places: at,
            }),
            Some(_) | None => {}
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
        if hop.touched {
            hop.distance_variance_m2 += HOP.touch_m * HOP.touch_m;
            if !hop.by_gyro {
                hop.turn_variance_rad2 += HOP.touch_rad * HOP.touch_rad;
            }
        }
        let back = hop.step.inverse();
        hop.ranges = self
            .heard
            .drain(..)
            .map(|of_it| of_it.median(back, hop.length_m))
            .collect();
        hop.ranges.sort_by_key(|range| range.beacon);
        hop
    }
}

impl HopRanges {
    /// The median, which single detours and failed measurements do not shift.
    fn median(mut self, back: Pose2, length_m: f64) -> HopRange {
        self.ranges_m.sort_unstable_by(f64::total_cmp);
        let count = self.ranges_m.len();
        let at = |index: usize| self.ranges_m.get(index).copied().unwrap_or_default();
        let repeats = HOP.length_m / length_m.clamp(HOP.length_min_m, HOP.length_m);
        let each = 1.0 / count.max(1) as f64;
        HopRange {
            beacon: self.beacon,
            repeats,
            at: back.transform(Point2 {
                x_m: each * self.places.x_m,
                y_m: each * self.places.y_m,
            }),
            range_m: 0.5 * (at(count.saturating_sub(1) / 2) + at(count / 2)),
            sigma_m: self.sigma_m * median_share(count),
        }
    }
}

/// Standard deviation of the median of so many normal numbers, as a share of that of one.
fn median_share(count: usize) -> f64 {
    let count = count.max(1) as f64;
    // pi / 2 for many, 1 for one or two, which are a mean.
    libm::sqrt((1.0 + 0.57 * (1.0 - 1.0 / count)) / count)
}
