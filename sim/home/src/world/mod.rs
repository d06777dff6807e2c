//! A robot in a home, advanced millisecond by millisecond.

mod actuation;
mod fault;
mod sensors;
mod truth;

use std::sync::Arc;

pub use actuation::{Actuation, Bridge};
pub use fault::{SensorFault, SensorId};
pub use sensors::{DOCK_LEFT, DOCK_NEAR, DOCK_RIGHT, GyroReading, LidarScan, Sensors};
pub use truth::Truth;

use crate::{Home, Noise, Pose, RobotModel};

/// A robot in a home. The same seed and the same sequence of calls give the same bits.
#[derive(Clone, Debug)]
pub struct World {
    home: Arc<Home>,
    sensors: Sensors,
    truth: Truth,
}

impl World {
    /// Puts a robot into a home: at `start` (plan frame), or where the home says. Whatever differs from run to run
    /// (wheel errors, gyro bias, albedo, dirt) comes from `noise` and `seed`.
    #[must_use]
    #[expect(
        clippy::too_many_arguments,
        reason = "home, robot, noise, seed and start are five different things"
    )]
    pub fn new(
        home: Arc<Home>,
        _model: &RobotModel,
        _noise: &Noise,
        _seed: u64,
        start: Option<Pose>,
    ) -> Self {
        let truth = Truth::at(start.unwrap_or(home.start()));
        Self {
            home,
            sensors: Sensors::default(),
            truth,
        }
    }

    /// Advances exactly one millisecond with these outputs of the firmware.
    pub fn step(&mut self, _actuation: &Actuation) {
        self.truth.time_ms += 1;
    }

    /// What the firmware can read now.
    #[must_use]
    pub const fn sensors(&self) -> &Sensors {
        &self.sensors
    }

    /// What is really so.
    #[must_use]
    pub const fn truth(&self) -> &Truth {
        &self.truth
    }

    /// The home as it is now, doors included.
    #[must_use]
    pub const fn home(&self) -> &Arc<Home> {
        &self.home
    }

    /// The cells of the reachable floor that the swath has passed, in the order of the grid's cells.
    #[must_use]
    pub fn swept(&self) -> &[bool] {
        &[]
    }

    /// Somebody lifts the robot: both wheels hang, it does not move any more.
    pub fn lift(&mut self) {
        self.truth.lifted = true;
    }

    /// Puts the robot down where it was lifted, or where it fell down.
    pub fn put_down(&mut self) {
        self.truth.lifted = false;
    }

    /// Puts the robot down somewhere else (plan frame).
    pub fn put_down_at(&mut self, pose: Pose) {
        self.truth.pose = pose;
        self.put_down();
    }

    /// Somebody presses a button until it is released. A number that the robot has not is ignored.
    pub fn press_button(&mut self, button: u8) {
        self.sensors.buttons |= 1u8.checked_shl(button.into()).unwrap_or(0);
    }

    /// Somebody lets go of a button.
    pub fn release_button(&mut self, button: u8) {
        self.sensors.buttons &= !1u8.checked_shl(button.into()).unwrap_or(0);
    }

    /// Takes the dust box out.
    pub fn remove_dust_box(&mut self) {
        self.sensors.dust_box = false;
    }

    /// Puts the dust box in.
    pub fn insert_dust_box(&mut self) {
        self.sensors.dust_box = true;
    }

    /// Sets the charge of the battery, clamped to 0..1.
    pub fn set_battery_charge(&mut self, charge: f64) {
        self.truth.battery_charge = charge.clamp(0.0, 1.0);
    }

    /// Makes a sensor lie, or (`None`) tell the truth again. A sensor that the robot has not is ignored.
    pub fn set_fault(&mut self, _sensor: SensorId, _fault: Option<SensorFault>) {}
}
