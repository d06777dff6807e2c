//! Parameters of recovery.

use core::ops::Range;

/// When a robot counts as penned.
pub(super) struct PenParameters {
    /// The robot has left a box whose diagonal exceeds this, metres. It is longer than a closet and shorter than any
    /// room in which people would let a robot clean.
    pub(super) left_m: f64,
    /// A held robot has moved off at this distance, metres.
    pub(super) moved_off_m: f64,
    /// After this time in one box the robot is penned, seconds. A box of that size is clean in less than a minute.
    pub(super) patience_s: f64,
    /// After each behavior the task has this time to get out by itself, seconds.
    pub(super) patience_again_s: f64,
    /// A job that ends with most of the home unswept after this time in one box ends in a pen, seconds.
    pub(super) ends_in_pen_s: f64,
}

pub(super) const PEN: PenParameters = PenParameters {
    left_m: 2.3,
    moved_off_m: 0.3,
    patience_s: 240.0,
    patience_again_s: 45.0,
    ends_in_pen_s: 20.0,
};

/// When a commanded robot counts as not moving (S15).
pub(super) struct ProgressParameters {
    /// Not moving for this long means that the robot is stuck, seconds.
    pub(super) patience_s: f64,
    /// Distance that counts as moving, metres.
    pub(super) moved_m: f64,
    /// Turn that counts as moving, radians.
    pub(super) turned_rad: f64,
    /// Slower commands are ignored, m/s: the dead band of a motor may swallow them.
    pub(super) speed_min_m_per_s: f64,
    /// As `speed_min_m_per_s`, rad/s.
    pub(super) turn_min_rad_per_s: f64,
}

pub(super) const PROGRESS: ProgressParameters = ProgressParameters {
    patience_s: 2.0,
    moved_m: 0.02,
    turned_rad: 0.1,
    speed_min_m_per_s: 0.03,
    turn_min_rad_per_s: 0.25,
};

/// When wheels count as slipping (S14).
pub(super) struct SlipParameters {
    /// Length of a comparison, seconds.
    pub(super) window_s: f64,
    /// Disagreement in one window that cannot come from unequal wheels or a drifting gyro, radians: 0.4 rad/s.
    pub(super) disagreement_rad: f64,
    /// Slipping this long is a reason to stop, seconds.
    pub(super) patience_s: f64,
}

pub(super) const SLIP: SlipParameters = SlipParameters {
    window_s: 0.5,
    disagreement_rad: 0.2,
    patience_s: 5.0,
};

/// The manoeuvres of the recovery behaviors.
pub(super) struct RecoveryManoeuvreParameters {
    /// Distance of backing out, metres.
    pub(super) back_out_m: f64,
    /// Random turn after backing out, radians.
    pub(super) back_out_turn_rad: Range<f64>,
    /// Time of the first swing of a wiggle, seconds.
    pub(super) wiggle_first_s: f64,
    /// Time of its two other swings, seconds.
    pub(super) wiggle_s: f64,
    /// Random turn after a wiggle, radians.
    pub(super) wiggle_turn_rad: Range<f64>,
    /// Distance of reversing, metres.
    pub(super) reverse_m: f64,
    /// Random turn after reversing, radians.
    pub(super) reverse_turn_rad: Range<f64>,
    /// Time along a contour, seconds: once round a closet.
    pub(super) contour_s: f64,
    /// Distance to back off before waiting, metres.
    pub(super) wait_back_m: f64,
    /// Time for people to leave, seconds.
    pub(super) wait_s: f64,
}

pub(super) const MANOEUVRES: RecoveryManoeuvreParameters = RecoveryManoeuvreParameters {
    back_out_m: 0.12,
    back_out_turn_rad: 1.0..2.2,
    wiggle_first_s: 0.5,
    wiggle_s: 0.8,
    wiggle_turn_rad: 1.5..2.8,
    reverse_m: 0.15,
    reverse_turn_rad: 2.2..3.1,
    contour_s: 75.0,
    wait_back_m: 0.02,
    wait_s: 60.0,
};
