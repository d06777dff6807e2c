//! Gyros that lie in each way, and a sound one beside wheels that slip.

use super::{GyroChange, GyroMonitor, Totals};
use crate::model::gyro_fault::GyroFault;

/// Fastest turn of the robot, rad/s.
const TURN_MAX: f64 = 3.0;
/// A step of a reported heading, radians.
const STEP_RAD: f64 = 1.75e-4;

/// A robot that turns and stops by turns; what the gyro makes of it, by time and rate, is `seen`.
struct TurningRobot {
    monitor: GyroMonitor,
    last: Totals,
    gyro_rad: f64,
    /// Share of the wheels' turn that the body makes.
    grip: f64,
    /// Rate of the wheels by time.
    wheels: fn(f64) -> f64,
}

impl TurningRobot {
    fn new() -> Self {
        let last = Totals {
            time_us: 0,
            left_m: 0.0,
            right_m: 0.0,
            gyro_rad: Some(0.0),
        };
        Self {
            monitor: GyroMonitor::new(TURN_MAX),
            last,
            gyro_rad: 0.0,
            grip: 1.0,
            wheels: Self::turns_and_rests,
        }
    }

    fn resting() -> Self {
        Self {
            wheels: |_| 0.0,
            ..Self::new()
        }
    }

    /// 1.5 s of turn, 1.5 s ahead, turn the other way, rest.
    fn turns_and_rests(time_s: f64) -> f64 {
        match (time_s / 1.5) as u64 % 4 {
            0 => 1.2,
            2 => -1.2,
            _ => 0.0,
        }
    }

    /// Seconds until the verdict changes, and the change.
    fn follow(&mut self, seconds: u32, seen: impl Fn(f64, f64) -> f64) -> Option<(f64, GyroChange)> {
        let from_us = self.last.time_us;
        for step in 1..=u64::from(seconds) * 50 {
            // Reports come a little early or late.
            let jitter_us = step * 7919 % 3000;
            let time_us = from_us + step * 20_000 + jitter_us;
            let time_s = time_us as f64 * 1e-6;
            let passed_s = (time_us - self.last.time_us) as f64 * 1e-6;
            let wheel_rate = (self.wheels)(time_s);
            self.gyro_rad += passed_s * seen(time_s, self.grip * wheel_rate);
            let now = Totals {
                time_us,
                gyro_rad: Some((self.gyro_rad / STEP_RAD).round() * STEP_RAD),
                ..self.last
            };
            let change = self.monitor.follow((self.last, now), passed_s * wheel_rate);
            self.last = now;
            if let Some(change) = change {
                return Some(((time_us - from_us) as f64 * 1e-6, change));
            }
        }
        None
    }
}

/// A sound gyro: a bias, a scale and some noise.
fn sound(time_s: f64, rate: f64) -> f64 {
    1.02 * rate + 0.01 + 0.02 * libm::sin(37.0 * time_s)
}

fn fault_of(seen: impl Fn(f64, f64) -> f64) -> (f64, GyroFault) {
    match TurningRobot::new().follow(20, seen) {
        Some((after_s, GyroChange::Out { fault, .. })) => (after_s, fault),
        other => panic!("{other:?}"),
    }
}

#[test]
fn each_kind_of_fault_has_its_name_within_seconds() {
    for (name, expected, seen) in [
        (
            "12 degrees a second",
            GyroFault::Frozen,
            Box::new(|_, _| 0.21) as Box<dyn Fn(f64, f64) -> f64>,
        ),
        ("zero", GyroFault::Frozen, Box::new(|_, _| 0.0)),
        ("at the rail", GyroFault::AtItsLimit, Box::new(|_, _| 4.36)),
        ("the other way", GyroFault::Disagrees, Box::new(|_, rate| -rate)),
        (
            "twice as much",
            GyroFault::Disagrees,
            Box::new(|_, rate| 2.0 * rate),
        ),
        ("an offset", GyroFault::Disagrees, Box::new(|_, rate| rate + 0.3)),
        (
            "noise",
            GyroFault::Disagrees,
            Box::new(|time_s, rate| {
                rate + if ((time_s / 0.2) as u64).is_multiple_of(2) {
                    2.0
                } else {
                    -2.0
                }
            }),
        ),
    ] {
        let (after_s, fault) = fault_of(seen);
        assert_eq!(fault, expected, "{name}");
        assert!(after_s < 8.0, "{name}: {after_s} s");
    }
}

#[test]
fn a_sound_gyro_is_never_left_out() {
    assert_eq!(TurningRobot::new().follow(3600, sound), None);
}

#[test]
fn noise_shows_sooner_while_the_wheels_rest() {
    // The heading swings by a degree and a half to each side, which a turn would hide.
    let noisy = |time_s: f64, rate: f64| rate + 0.26 * libm::sin(16.0 * time_s).signum();
    let mut turning = TurningRobot {
        wheels: |_| 1.2,
        ..TurningRobot::new()
    };
    assert_eq!(turning.follow(10, noisy), None);
    let change = TurningRobot::resting().follow(10, noisy);
    let is_named = |(after_s, change): (f64, GyroChange)| {
        let fault = GyroFault::Disagrees;
        after_s < 4.0 && matches!(change, GyroChange::Out { fault: named, .. } if named == fault)
    };
    assert!(change.is_some_and(is_named), "{change:?}");
    assert_eq!(TurningRobot::resting().follow(3600, sound), None);
}

#[test]
fn slip_is_no_fault_of_the_gyro() {
    for grip in [0.0, 0.3, 0.6] {
        let mut drive = TurningRobot {
            grip,
            ..TurningRobot::new()
        };
        assert_eq!(drive.follow(60, sound), None, "grip {grip}");
    }
}

#[test]
fn the_missed_turn_is_told() {
    let Some((_, GyroChange::Out { missed_rad, .. })) = TurningRobot::new().follow(20, |_, _| 0.0) else {
        panic!("no fault");
    };
    assert!((missed_rad - 1.0).abs() < 0.1, "{missed_rad}");
}

#[test]
fn a_gyro_that_agrees_over_a_turn_counts_again_and_each_fault_makes_that_longer() {
    let mut drive = TurningRobot::new();
    let mut waits = Vec::new();
    for _ in 0..3 {
        drive.follow(20, |_, _| 0.0).unwrap();
        let (after_s, change) = drive.follow(60, sound).unwrap();
        assert_eq!(change, GyroChange::Back);
        waits.push(after_s);
    }
    assert!(waits.is_sorted() && waits.first() < waits.last(), "{waits:?}");
}
