//! Detects a faulty gyro by what the wheels say over the same seconds.
//!
//! A slipping wheel and a faulty gyro both make the two disagree, and look different: slip follows the motion, so the gyro's rate
//! changes with the wheels' rate though not by the same amount. A faulty gyro goes on with one value whatever the wheels do, keeps a
//! constant distance from them, or turns the other way. What cannot be told apart within the span counts as slip (S14).
//!
//! - *Bucket*: what both turned in [`BUCKET_S`].
//! - *Span*: the last [`SPAN`] buckets.

use super::totals::Totals;
use crate::model::gyro_fault::GyroFault;

/// Length of a bucket, seconds: some ten reports, so that their jitter in time does not count.
const BUCKET_S: f64 = 0.2;
/// Buckets of a span: 2.4 s, less than slip may last before the robot stops.
const SPAN: usize = 12;
/// A gap between two observations after which the span begins anew, seconds.
const GAP_S: f64 = 0.5;

/// Limits of the judgement.
struct GyroMonitorParameters {
    /// Rates within this share of their mean,
    same_share: f64,
    /// plus this, are the same value: the resolution of a reported heading over a bucket, twice, rad/s.
    same_rad_per_s: f64,
    /// A smaller rate may be a bias, rad/s.
    bias_rad_per_s: f64,
    /// Disagreement over a span that is more than unequal wheels and a drifting gyro, radians.
    apart_rad: f64,
    /// The wheels' rate must have changed by this much, so that a steady slip is not taken for a constant value, rad/s.
    varied_rad_per_s: f64,
    /// The wheels turn by this much, radians, and not one step of the heading follows. A real gyro that is held still shows noise.
    unmoved_rad: f64,
    /// Turn of the wheels over a span that shows whether the gyro turns the other way, radians.
    turned_rad: f64,
    /// Ratio of the gyro's turn to the wheels' outside of which no slip explains it.
    ratio_min: f64,
    ratio_max: f64,
    /// Deviation of a bucket from that ratio, share of the wheels' turn.
    ratio_noise: f64,
    /// Changes of sign of a disagreement of more than `noisy_rad_per_s` within a span that no body makes.
    noisy_changes: usize,
    noisy_rad_per_s: f64,
    /// The same while the wheels rest, when only a hand turns the robot to and fro.
    noisy_at_rest_changes: usize,
    noisy_at_rest_rad_per_s: f64,
    /// Wheels that turn by less in each bucket rest, radians: less than a step of an encoder, more than rounding.
    rest_rad: f64,
    /// Turn of the wheels over a span with which a gyro must agree before it counts again, radians,
    agreed_turn_rad: f64,
    /// and in each bucket to this rate, rad/s.
    agreed_rad_per_s: f64,
    /// It must have been out for this long, seconds; doubled with each fault,
    out_s: f64,
    /// up to this.
    out_max_s: f64,
}

const MONITOR: GyroMonitorParameters = GyroMonitorParameters {
    same_share: 0.05,
    same_rad_per_s: 3.6e-3,
    bias_rad_per_s: 0.03,
    apart_rad: 0.35,
    varied_rad_per_s: 0.5,
    unmoved_rad: 1.0,
    turned_rad: 1.5,
    ratio_min: -0.3,
    ratio_max: 1.5,
    ratio_noise: 0.25,
    noisy_changes: 6,
    noisy_rad_per_s: 0.3,
    noisy_at_rest_changes: 4,
    noisy_at_rest_rad_per_s: 0.1,
    rest_rad: 1e-3,
    agreed_turn_rad: 0.5,
    agreed_rad_per_s: 0.25,
    out_s: 5.0,
    out_max_s: 320.0,
};

/// What wheels and gyro turned in the same time.
#[derive(Clone, Copy, Debug, Default)]
struct Bucket {
    time_s: f64,
    wheel_rad: f64,
    gyro_rad: f64,
}

impl Bucket {
    fn wheel_rate(self) -> f64 {
        self.wheel_rad / self.time_s
    }

    fn gyro_rate(self) -> f64 {
        self.gyro_rad / self.time_s
    }

    fn apart_rad(self) -> f64 {
        self.gyro_rad - self.wheel_rad
    }

    fn apart_rate(self) -> f64 {
        self.gyro_rate() - self.wheel_rate()
    }
}

/// Least and greatest of some rates.
#[derive(Clone, Copy, Debug)]
struct RateRange {
    least: f64,
    greatest: f64,
}

impl RateRange {
    fn of(rates: impl Iterator<Item = f64>) -> Self {
        rates.fold(
            Self {
                least: f64::INFINITY,
                greatest: f64::NEG_INFINITY,
            },
            |range, rate| Self {
                least: range.least.min(rate),
                greatest: range.greatest.max(rate),
            },
        )
    }

    fn width(self) -> f64 {
        self.greatest - self.least
    }

    fn middle(self) -> f64 {
        0.5 * (self.least + self.greatest)
    }

    fn is_one_value(self) -> bool {
        self.width() <= MONITOR.same_share * self.middle().abs() + MONITOR.same_rad_per_s
    }
}

/// A change of the verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum GyroChange {
    /// It is left out from now on. The heading of the last seconds was wrong by this: to be added, radians.
    Out { fault: GyroFault, missed_rad: f64 },
    /// It agrees with the wheels again and counts.
    Back,
}

/// Compares gyro and wheels.
#[derive(Clone, Debug)]
pub(super) struct GyroMonitor {
    /// Fastest turn that the wheels can make, rad/s.
    turn_max_rad_per_s: f64,
    open: Bucket,
    span: [Bucket; SPAN],
    filled: usize,
    /// Wheels' turn since the gyro's heading last changed, and its extremes, radians.
    unmoved: Unmoved,
    fault: Option<GyroFault>,
    out_s: f64,
    faults: i32,
}

/// What the wheels have turned since the heading of the gyro last changed.
#[derive(Clone, Copy, Debug, Default)]
struct Unmoved {
    wheel_rad: f64,
    least_rad: f64,
    greatest_rad: f64,
}

impl Unmoved {
    fn turn(&mut self, wheel_rad: f64) {
        self.wheel_rad += wheel_rad;
        self.least_rad = self.least_rad.min(self.wheel_rad);
        self.greatest_rad = self.greatest_rad.max(self.wheel_rad);
    }

    fn extent_rad(self) -> f64 {
        self.greatest_rad - self.least_rad
    }
}

impl GyroMonitor {
    pub(super) fn new(turn_max_rad_per_s: f64) -> Self {
        Self {
            turn_max_rad_per_s,
            open: Bucket::default(),
            span: [Bucket::default(); SPAN],
            filled: 0,
            unmoved: Unmoved::default(),
            fault: None,
            out_s: 0.0,
            faults: 0,
        }
    }

    /// Why the gyro does not count now.
    pub(super) fn fault(&self) -> Option<GyroFault> {
        self.fault
    }

    /// Whatever comes next does not belong to the motion before: the robot was lifted, or reports are missing.
    pub(super) fn interrupt(&mut self) {
        self.open = Bucket::default();
        self.filled = 0;
        self.unmoved = Unmoved::default();
    }

    /// Takes what the wheels turned between two observations.
    pub(super) fn follow(&mut self, (last, now): (Totals, Totals), wheel_rad: f64) -> Option<GyroChange> {
        let time_s = now.time_us.saturating_sub(last.time_us) as f64 * 1e-6;
        let (Some(before_rad), Some(after_rad)) = (last.gyro_rad, now.gyro_rad) else {
            self.interrupt();
            return None;
        };
        if time_s > GAP_S {
            self.interrupt();
            return None;
        }
        let gyro_rad = after_rad - before_rad;
        if gyro_rad != 0.0 {
            self.unmoved = Unmoved::default();
        }
        self.unmoved.turn(wheel_rad);
        self.out_s += time_s;
        self.open = Bucket {
            time_s: self.open.time_s + time_s,
            wheel_rad: self.open.wheel_rad + wheel_rad,
            gyro_rad: self.open.gyro_rad + gyro_rad,
        };
        if self.open.time_s >= BUCKET_S {
            self.close_bucket();
        }
        match self.fault {
            None => self.judge(),
            Some(_) => self.forgive(),
        }
    }

    fn close_bucket(&mut self) {
        self.span.rotate_left(1);
        if let Some(last) = self.span.last_mut() {
            *last = core::mem::take(&mut self.open);
        }
        self.filled = (self.filled + 1).min(SPAN);
    }

    /// Sum over the span.
    fn sum(&self, of: impl Fn(&Bucket) -> f64) -> f64 {
        self.span.iter().map(of).sum()
    }

    /// What the wheels turned in the span, either way.
    fn turned_rad(&self) -> f64 {
        self.sum(|bucket| bucket.wheel_rad.abs())
    }

    /// Whether a bucket has just filled the span, or filled it again.
    fn is_due(&self) -> bool {
        self.filled == SPAN && self.open.time_s == 0.0
    }

    fn judge(&mut self) -> Option<GyroChange> {
        let (fault, missed_rad) = if self.unmoved.extent_rad() >= MONITOR.unmoved_rad {
            (GyroFault::Frozen, self.unmoved.wheel_rad)
        } else if self.is_due() {
            (self.fault_of_span()?, -self.sum(|bucket| bucket.apart_rad()))
        } else {
            return None;
        };
        self.fault = Some(fault);
        self.faults += 1;
        self.out_s = 0.0;
        Some(GyroChange::Out { fault, missed_rad })
    }

    fn fault_of_span(&self) -> Option<GyroFault> {
        let gyro = RateRange::of(self.span.iter().map(|bucket| bucket.gyro_rate()));
        let wheels = RateRange::of(self.span.iter().map(|bucket| bucket.wheel_rate()));
        let apart = RateRange::of(self.span.iter().map(|bucket| bucket.apart_rate()));
        if self.sum(|bucket| bucket.apart_rad().abs()) < MONITOR.apart_rad {
            return None;
        }
        let varied = wheels.width() >= MONITOR.varied_rad_per_s;
        let is_bias = gyro.middle().abs() < MONITOR.bias_rad_per_s;
        if gyro.is_one_value() && gyro.middle().abs() > self.turn_max_rad_per_s {
            return Some(GyroFault::AtItsLimit);
        }
        if gyro.is_one_value() && !is_bias && (varied || self.is_at_rest()) {
            return Some(GyroFault::Frozen);
        }
        let is_offset = apart.is_one_value() && apart.middle().abs() >= MONITOR.bias_rad_per_s;
        if (is_offset && varied) || self.turns_otherwise() || self.is_noisy() {
            return Some(GyroFault::Disagrees);
        }
        None
    }

    /// It turns the other way, or far too much, by one ratio.
    fn turns_otherwise(&self) -> bool {
        if self.turned_rad() < MONITOR.turned_rad {
            return false;
        }
        let square = self.sum(|bucket| bucket.wheel_rad * bucket.wheel_rad);
        let ratio = self.sum(|bucket| bucket.gyro_rad * bucket.wheel_rad) / square;
        let residual = self.sum(|bucket| {
            let off_rad = bucket.gyro_rad - ratio * bucket.wheel_rad;
            off_rad * off_rad
        });
        let is_steady = residual <= MONITOR.ratio_noise * MONITOR.ratio_noise * square;
        is_steady && !(MONITOR.ratio_min..=MONITOR.ratio_max).contains(&ratio)
    }

    fn is_at_rest(&self) -> bool {
        self.span
            .iter()
            .all(|bucket| bucket.wheel_rad.abs() < MONITOR.rest_rad)
    }

    fn is_noisy(&self) -> bool {
        let (least_rad_per_s, least_changes) = if self.is_at_rest() {
            (MONITOR.noisy_at_rest_rad_per_s, MONITOR.noisy_at_rest_changes)
        } else {
            (MONITOR.noisy_rad_per_s, MONITOR.noisy_changes)
        };
        let strong = |bucket: &&Bucket| bucket.apart_rate().abs() >= least_rad_per_s;
        let signs: Vec<bool> = self
            .span
            .iter()
            .filter(strong)
            .map(|bucket| bucket.apart_rate() > 0.0)
            .collect();
        let changes = signs
            .iter()
            .zip(signs.iter().skip(1))
            .filter(|(a, b)| a != b)
            .count();
        changes >= least_changes
    }

    /// Whether it has agreed with the wheels over a turn.
    fn forgive(&mut self) -> Option<GyroChange> {
        let out_min_s = (MONITOR.out_s * libm::exp2(f64::from(self.faults - 1))).min(MONITOR.out_max_s);
        if !self.is_due() || self.out_s < out_min_s {
            return None;
        }
        let turned_rad = self.turned_rad();
        let agrees = |bucket: &Bucket| bucket.apart_rate().abs() <= MONITOR.agreed_rad_per_s;
        let is_close = self.sum(|bucket| bucket.apart_rad()).abs() <= 0.1 * (1.0 + turned_rad);
        if turned_rad < MONITOR.agreed_turn_rad || !is_close || !self.span.iter().all(agrees) {
            return None;
        }
        self.fault = None;
        self.interrupt();
        Some(GyroChange::Back)
    }
}

#[cfg(test)]
mod tests;
