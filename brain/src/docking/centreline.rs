//! The drive along the centreline between the two lobes of the dock.
//!
//! Terms are those of [`super::approach`].

use crate::mapping::{DockBeamFilter, Lobe};

/// Speed on the centreline far from the dock, and while only one lobe is received.
const LINE_M_PER_S: f64 = 0.2;
const TRIM_M_PER_S: f64 = 0.12;
/// Speed in the near field, for a soft touch of the dock contacts.
const FINAL_M_PER_S: f64 = 0.05;
/// Turn back to the centreline while only one lobe is received, radians. It is smaller in the near field, where no distance
/// is left to straighten.
const TRIM_RAD: f64 = 0.22;
const TRIM_NEAR_RAD: f64 = 0.14;
/// Correction of a base from beams alone when the robot lost the centreline and found it again, radians.
const LEARN_RAD: f64 = 0.02;
/// Sideways distance that the robot continues after it has found the centreline again, to reach its middle, metres.
const MIDDLE_M: f64 = 0.05;
const MIDDLE_NEAR_M: f64 = 0.02;
/// After this distance in the near field it drives straight, metres: 0.1 m before the contacts.
const STRAIGHT_M: f64 = 0.26;
/// The near field begins 0.36 m before the contacts. After this distance in it the robot has missed them, metres.
const NEAR_MAX_M: f64 = 0.6;
/// Longest drive on the centreline, metres: beams reach 3 m.
const LINE_MAX_M: f64 = 4.0;
/// After this time without a beam in front the centreline is lost, seconds.
const SILENCE_S: f64 = 1.0;

/// The drive along the centreline.
#[derive(Clone, Copy, Debug)]
pub(super) struct CentrelineDrive {
    base_rad: f64,
    /// The base comes from the map.
    is_known: bool,
    lobe: Lobe,
    /// Sideways distance left to the middle of the centreline.
    middle_m: f64,
    silent_s: f64,
    driven_m: f64,
    near_m: f64,
}

impl CentrelineDrive {
    /// In this direction, measured from the beams.
    pub(super) fn along(base_rad: f64) -> Self {
        Self {
            base_rad,
            is_known: false,
            lobe: Lobe::Both,
            middle_m: 0.0,
            silent_s: 0.0,
            driven_m: 0.0,
            near_m: 0.0,
        }
    }

    /// In this direction, known from the map.
    pub(super) fn of_map(base_rad: f64) -> Self {
        Self {
            is_known: true,
            ..Self::along(base_rad)
        }
    }

    /// Its direction as far as known, radians.
    pub(super) fn base_rad(&self) -> f64 {
        self.base_rad
    }

    /// Whether the robot has driven so far that it missed the contacts.
    pub(super) fn is_missed(&self) -> bool {
        self.near_m > NEAR_MAX_M || self.driven_m > LINE_MAX_M
    }

    /// Whether nothing was received in front for too long.
    pub(super) fn is_lost(&self) -> bool {
        self.silent_s > SILENCE_S
    }

    /// Updates the drive with what is received after a step.
    pub(super) fn follow(&mut self, hearing: &DockBeamFilter, distance_m: f64, time_s: f64) {
        self.silent_s = if hearing.is_in_front() {
            0.0
        } else {
            self.silent_s + time_s
        };
        self.driven_m += distance_m.max(0.0);
        if hearing.is_near() || self.near_m > 0.0 {
            self.near_m += distance_m.max(1e-6);
        }
        self.take_lobe(hearing.lobe(), distance_m);
    }

    fn take_lobe(&mut self, lobe: Lobe, distance_m: f64) {
        match lobe {
            Lobe::None => {}
            Lobe::Left | Lobe::Right => {
                self.lobe = lobe;
                self.middle_m = if self.near_m > 0.0 {
                    MIDDLE_NEAR_M
                } else {
                    MIDDLE_M
                };
            }
            Lobe::Both if self.lobe != Lobe::Both => {
                self.middle_m -= self.trim_rad() * distance_m.max(0.0);
                if self.middle_m <= 0.0 {
                    if !self.is_known {
                        self.base_rad += LEARN_RAD * toward_centreline(self.lobe);
                    }
                    self.lobe = Lobe::Both;
                }
            }
            Lobe::Both => {}
        }
    }

    fn trim_rad(&self) -> f64 {
        if self.near_m > 0.0 {
            TRIM_NEAR_RAD
        } else {
            TRIM_RAD
        }
    }

    /// Direction to drive in, radians.
    pub(super) fn setpoint_rad(&self) -> f64 {
        if self.near_m > STRAIGHT_M {
            self.base_rad
        } else {
            self.base_rad + self.trim_rad() * toward_centreline(self.lobe)
        }
    }

    /// Speed to drive at.
    pub(super) fn speed_m_per_s(&self) -> f64 {
        if self.near_m > 0.0 {
            FINAL_M_PER_S
        } else if self.lobe == Lobe::Both && self.silent_s == 0.0 {
            LINE_M_PER_S
        } else {
            TRIM_M_PER_S
        }
    }
}

/// +1 when the centreline is on the left of a robot that faces the dock, -1 on the right.
fn toward_centreline(lobe: Lobe) -> f64 {
    match lobe {
        Lobe::Left => -1.0,
        Lobe::Right => 1.0,
        Lobe::Both | Lobe::None => 0.0,
    }
}
