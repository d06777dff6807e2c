//! Ground truth, for checks and drawings; the firmware never gets it.

use crate::Pose;

/// The truth after the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Simulated milliseconds.
    pub time_ms: u64,
    /// Pose of the centre between the wheels in the plan frame.
    pub pose: Pose,
    /// Speed along the robot's x, m/s.
    pub speed_m_per_s: f64,
    /// Turn rate, rad/s.
    pub turn_rad_per_s: f64,
    /// Speed of the left wheel's rim against the body, m/s.
    pub rim_left_m_per_s: f64,
    /// Speed of the right wheel's rim against the body, m/s.
    pub rim_right_m_per_s: f64,
    /// Distance driven by the centre so far, metres.
    pub path_m: f64,
    /// Share of the reachable floor that the swath has passed, 0..1.
    pub swept_share: f64,
    /// Area of the reachable floor that the swath has passed, square metres.
    pub swept_m2: f64,
    /// Area of it that the swath has passed a second time, ten seconds or more after the first, square metres.
    pub swept_twice_m2: f64,
    /// Share of the dirt that has been taken up, 0..1; this needs main brush and suction.
    pub dirt_share: f64,
    /// Direction of the present contact from straight ahead, radians, at most 10 ms old; `None` = the body touches
    /// nothing.
    pub contact_rad: Option<f64>,
    /// Times the body came into contact with something.
    pub contacts: u32,
    /// Number of contacts of the body with the foot of a walker or with a pet.
    pub foot_contacts: u32,
    /// Longest time for which the wheels kept driving against a person with rigid contact, milliseconds.
    pub foot_pushed_max_ms: u32,
    /// The left wheel is over a drop.
    pub left_over_cliff: bool,
    /// The right wheel is over a drop.
    pub right_over_cliff: bool,
    /// The centre passed over an edge: the robot fell down the stairs and lies there until it is put down elsewhere.
    pub fallen: bool,
    /// Somebody holds the robot up.
    pub lifted: bool,
    /// The dock's contacts touch.
    pub docked: bool,
    /// Charge of the battery, 0..1.
    pub battery_charge: f64,
    /// Temperature of the hottest cell, degrees Celsius.
    pub battery_hottest_c: f64,
    /// Mean temperature of the cells, degrees Celsius.
    pub battery_c: f64,
    /// At the pack's terminals, volts.
    pub battery_v: f64,
    /// Into the pack positive, ampere.
    pub battery_a: f64,
}

impl Truth {
    /// At least one wheel has no floor under it: lifted, over a drop, or fallen.
    #[must_use]
    pub const fn hanging(&self) -> bool {
        self.lifted || self.fallen || self.left_over_cliff || self.right_over_cliff
    }
}

impl Truth {
    pub(crate) const fn at(pose: Pose) -> Self {
        Self {
            time_ms: 0,
            pose,
            speed_m_per_s: 0.0,
            turn_rad_per_s: 0.0,
            rim_left_m_per_s: 0.0,
            rim_right_m_per_s: 0.0,
            path_m: 0.0,
            swept_share: 0.0,
            swept_m2: 0.0,
            swept_twice_m2: 0.0,
            dirt_share: 0.0,
            contact_rad: None,
            contacts: 0,
            foot_contacts: 0,
            foot_pushed_max_ms: 0,
            left_over_cliff: false,
            right_over_cliff: false,
            fallen: false,
            lifted: false,
            docked: false,
            battery_charge: 1.0,
            battery_hottest_c: 22.0,
            battery_c: 22.0,
            battery_v: 0.0,
            battery_a: 0.0,
        }
    }
}
