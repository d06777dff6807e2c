//! Odometry: dead reckoning from wheel encoders, with the gyro's heading where there is one.

use super::calibration::Calibration;
use super::gyro_estimate::BiasMeasurement;
use super::gyro_monitor::{GyroChange, GyroMonitor};
use super::stationary::StationaryDetector;
use super::totals::Totals;
use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::gyro_fault::GyroFault;
use crate::model::learnt::GyroLearnt;
use crate::model::observation::Observation;

#[derive(Clone, Debug)]
pub(super) struct Odometry {
    track_m: f64,
    rim_max_m_per_s: f64,
    odom_from_base: Pose2,
    last: Option<Totals>,
    stationary: StationaryDetector,
    /// Bias by the zero-velocity update that the last observation ended.
    bias: Option<BiasMeasurement>,
    monitor: GyroMonitor,
    /// What the last observation showed of the gyro.
    gyro_change: Option<GyroChange>,
    pub(super) calibration: Calibration,
}

/// A wheel is believed to turn up to this many times its highest speed. More is a jump of the counters.
const JUMP_FACTOR: f64 = 3.0;
/// Distance that is believed however short the time is, metres: telemetry comes in bursts.
const JUMP_FLOOR_M: f64 = 0.05;

impl Odometry {
    pub(super) fn new(track_m: f64, rim_max_m_per_s: f64) -> Self {
        Self {
            track_m,
            rim_max_m_per_s,
            odom_from_base: Pose2::IDENTITY,
            last: None,
            stationary: StationaryDetector::default(),
            bias: None,
            monitor: GyroMonitor::new(2.0 * rim_max_m_per_s / track_m),
            gyro_change: None,
            calibration: Calibration::default(),
        }
    }

    pub(super) fn odom_from_base(&self) -> Pose2 {
        self.odom_from_base
    }

    /// Scale error of the gyro, relative, and its bias in rad/s.
    pub(super) fn gyro(&self) -> (f64, f64) {
        self.calibration.scale_and_bias()
    }

    /// Restores [`Self::gyro`] after a restart.
    pub(super) fn resume_gyro(&mut self, scale: f64, bias_rad_per_s: f64) {
        self.calibration = Calibration::resumed(GyroLearnt {
            scale,
            scale_sigma: 0.0,
            bias_rad_per_s,
        });
    }

    /// Why the gyro is left out, if it is.
    pub(super) fn gyro_fault(&self) -> Option<GyroFault> {
        self.monitor.fault()
    }

    /// What the last observation showed of the gyro.
    pub(super) fn gyro_change(&self) -> Option<GyroChange> {
        self.gyro_change
    }

    /// Bias by the zero-velocity update that the last observation ended.
    pub(super) fn measured_bias(&self) -> Option<BiasMeasurement> {
        self.bias
    }

    pub(super) fn update(&mut self, observation: &Observation) -> Advance {
        let now = Totals {
            time_us: observation.time_us,
            left_m: observation.travel_left_m,
            right_m: observation.travel_right_m,
            gyro_rad: observation.gyro_heading_rad,
        };
        if let Some(last) = self.last {
            self.watch_gyro((last, now), observation.wheel_drop);
            self.update_stationary(last, now);
        }
        let mut advance = self
            .last
            .map_or_else(Advance::default, |last| self.advance(last, now));
        if let Some(GyroChange::Out { missed_rad, .. }) = self.gyro_change {
            advance.turn_rad += missed_rad;
        }
        self.last = Some(now);
        self.calibration.count(advance);
        if advance.distance_m != 0.0 || advance.turn_rad != 0.0 {
            self.odom_from_base = self
                .odom_from_base
                .after_arc(advance.distance_m, advance.turn_rad);
        }
        advance
    }

    fn watch_gyro(&mut self, (last, now): (Totals, Totals), is_lifted: bool) {
        self.gyro_change = None;
        // In this order a wheel that rests is exactly zero.
        let wheel_rad = ((now.right_m - last.right_m) - (now.left_m - last.left_m)) / self.track_m;
        let is_believable = wheel_rad.abs() <= 2.0 * JUMP_FLOOR_M / self.track_m;
        if is_lifted || !is_believable {
            self.monitor.interrupt();
            return;
        }
        self.gyro_change = self.monitor.follow((last, now), wheel_rad);
    }

    fn update_stationary(&mut self, last: Totals, now: Totals) {
        let ended = if last.wheels_agree_with(now) {
            None
        } else {
            self.stationary.end(last)
        };
        let interval = ended.or(self.stationary.observe(now));
        let interval = interval.filter(|_| self.monitor.fault().is_none());
        self.bias = interval.map(|interval| self.calibration.update_at_rest(interval));
    }

    fn advance(&self, last: Totals, now: Totals) -> Advance {
        let time_s = now.time_us.saturating_sub(last.time_us) as f64 * 1e-6;
        let (left_m, right_m) = (now.left_m - last.left_m, now.right_m - last.right_m);
        let believable_m = JUMP_FLOOR_M + JUMP_FACTOR * self.rim_max_m_per_s * time_s;
        // The comparison is written so that NaN is not believed either.
        let believable = left_m.abs() <= believable_m && right_m.abs() <= believable_m;
        if !believable {
            return Advance {
                time_s,
                ..Advance::default()
            };
        }
        let wheel_turn_rad = (right_m - left_m) / self.track_m;
        let gyro_turn_rad = self.gyro_turn(last, now, time_s);
        Advance {
            time_s,
            distance_m: 0.5 * (left_m + right_m),
            turn_rad: gyro_turn_rad.unwrap_or(wheel_turn_rad),
            wheel_turn_rad,
            gyro_turn_rad,
            ..Advance::default()
        }
    }

    fn gyro_turn(&self, last: Totals, now: Totals, time_s: f64) -> Option<f64> {
        if self.monitor.fault().is_some() {
            return None;
        }
        let seen_rad = now.gyro_rad? - last.gyro_rad?;
        if self.stationary.is_stationary(now, seen_rad, time_s) {
            return Some(0.0);
        }
        let turn_rad = self.calibration.corrected_rad(seen_rad, time_s);
        let rim_turn_max_rad =
            2.0 * (JUMP_FLOOR_M + JUMP_FACTOR * self.rim_max_m_per_s * time_s) / self.track_m;
        (turn_rad.abs() <= rim_turn_max_rad).then_some(turn_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::Odometry;
    use crate::model::observation::Observation;

    fn at(time_us: u64, left_m: f64, right_m: f64) -> Observation {
        Observation {
            time_us,
            travel_left_m: left_m,
            travel_right_m: right_m,
            ..Observation::default()
        }
    }

    #[test]
    fn the_first_observation_moves_nothing() {
        let mut odometry = Odometry::new(0.2, 0.5);
        assert_eq!(odometry.update(&at(5, 12.0, 13.0)).distance_m, 0.0);
        assert_eq!(odometry.odom_from_base().x_m, 0.0);
    }

    #[test]
    fn bias_does_not_turn_a_robot_at_rest_however_often_it_reports() {
        let step_rad = 0.01_f64.to_radians();
        let mut odometry = Odometry::new(0.2, 0.5);
        let mut seen = Vec::new();
        for report in 0..60_000_u64 {
            // Two reports in 25 ms, one soon after the other.
            let time_us = report / 2 * 25_000 + report % 2 * 3_000;
            let heading_rad = (1e-3 * time_us as f64 * 1e-6 / step_rad).round() * step_rad;
            odometry.update(&Observation {
                gyro_heading_rad: Some(heading_rad),
                ..at(time_us, 0.0, 0.0)
            });
            seen.push(odometry.odom_from_base().heading_rad);
        }
        let settled = seen.get(100).copied().unwrap();
        assert_eq!(seen.last().copied(), Some(settled), "twelve minutes later");
    }

    #[test]
    fn the_gyro_outvotes_the_wheels() {
        let mut odometry = Odometry::new(0.2, 0.5);
        odometry.update(&Observation {
            gyro_heading_rad: Some(1.0),
            ..at(0, 0.0, 0.0)
        });
        let advance = odometry.update(&Observation {
            gyro_heading_rad: Some(1.1),
            ..at(1_000_000, 0.2, 0.2)
        });
        assert!((advance.turn_rad - 0.1).abs() < 1e-12);
        assert_eq!(advance.wheel_turn_rad, 0.0);
    }

    #[test]
    fn jumps_of_the_totals_are_not_motion() {
        let mut odometry = Odometry::new(0.2, 0.5);
        odometry.update(&at(0, 0.0, 0.0));
        odometry.update(&at(20_000, -57.0, 3.0));
        odometry.update(&at(40_000, f64::NAN, 3.0));
        odometry.update(&at(60_000, -57.0, 3.0));
        assert_eq!(odometry.odom_from_base().x_m, 0.0);
        odometry.update(&at(80_000, -56.99, 3.01));
        assert!((odometry.odom_from_base().x_m - 0.01).abs() < 1e-9);
    }
}
