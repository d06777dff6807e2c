//! The drive along the centreline between the two lobes of the dock.
//!
//! Terms are those of [`super::approach`].

use super::parameters::CENTRELINE;
use crate::mapping::{DockBeamFilter, Lobe};

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
    /// In this direction, measured from the beams: from the robot to the dock. Beside the middle that crosses the centreline.
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
        self.near_m > CENTRELINE.near_max_m || self.driven_m > CENTRELINE.drive_max_m
    }

    /// Whether nothing was received in front for too long.
    pub(super) fn is_lost(&self) -> bool {
        self.silent_s > CENTRELINE.silence_max_s
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
                if self.lobe == Lobe::Both && !self.is_known {
                    self.base_rad -= CENTRELINE.base_step_rad * toward_centreline(lobe);
                }
                self.lobe = lobe;
                self.middle_m = if self.near_m > 0.0 {
                    CENTRELINE.to_middle_near_m
                } else {
                    CENTRELINE.to_middle_m
                };
            }
            Lobe::Both if self.lobe != Lobe::Both => {
                self.middle_m -= self.trim_rad() * distance_m.max(0.0);
                if self.middle_m <= 0.0 {
                    self.lobe = Lobe::Both;
                }
            }
            Lobe::Both => {}
        }
    }

    fn trim_rad(&self) -> f64 {
        if self.near_m > 0.0 {
            CENTRELINE.trim_near_rad
        } else {
            CENTRELINE.trim_rad
        }
    }

    /// Direction to drive in, radians.
    pub(super) fn setpoint_rad(&self) -> f64 {
        if self.near_m > CENTRELINE.straight_from_m {
            self.base_rad
        } else {
            self.base_rad + self.trim_rad() * toward_centreline(self.lobe)
        }
    }

    /// Speed to drive at.
    pub(super) fn speed_m_per_s(&self) -> f64 {
        if self.near_m > 0.0 {
            CENTRELINE.near_m_per_s
        } else if self.lobe == Lobe::Both && self.silent_s == 0.0 {
            CENTRELINE.far_m_per_s
        } else {
            CENTRELINE.trim_m_per_s
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
