//! Keeps the charger's gate shut while a motor may draw current.

use core::sync::atomic::{AtomicU32, Ordering};

/// A motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InterlockedMotor {
    /// Left wheel.
    WheelLeft = 1,
    /// Right wheel.
    WheelRight = 2,
    /// Main brush.
    BrushMain = 4,
    /// Side brushes.
    BrushSides = 8,
    /// Suction.
    Vacuum = 16,
}

/// Motors that may draw current. Written by the main program, read by interrupt handlers.
#[derive(Debug)]
struct Interlock {
    /// A bit for each, as [`InterlockedMotor`] numbers them.
    driven: AtomicU32,
}

/// The interlock of this chip.
static INTERLOCK: Interlock = Interlock::new();

impl Interlock {
    const fn new() -> Self {
        Self {
            driven: AtomicU32::new(0),
        }
    }

    #[inline(always)]
    fn note(&self, motor: InterlockedMotor, driven: bool) {
        let motors = self.driven.load(Ordering::Relaxed);
        let changed = if driven {
            motors | motor as u32
        } else {
            motors & !(motor as u32)
        };
        self.driven.store(changed, Ordering::Relaxed);
    }

    #[inline(always)]
    fn is_any_driven(&self) -> bool {
        self.driven.load(Ordering::Relaxed) != 0
    }
}

impl InterlockedMotor {
    /// Notes whether the motor may draw current. Called from the main program only.
    pub(super) fn note(self, driven: bool) {
        INTERLOCK.note(self, driven);
    }
}

/// Whether any motor may draw current.
#[inline(always)]
#[must_use]
pub(super) fn any_motor_driven() -> bool {
    INTERLOCK.is_any_driven()
}

#[cfg(test)]
mod tests {
    use super::{Interlock, InterlockedMotor};

    const MOTORS: [InterlockedMotor; 5] = [
        InterlockedMotor::WheelLeft,
        InterlockedMotor::WheelRight,
        InterlockedMotor::BrushMain,
        InterlockedMotor::BrushSides,
        InterlockedMotor::Vacuum,
    ];

    #[test]
    fn a_motor_is_forgotten_only_when_that_one_stops() {
        for first in MOTORS {
            for second in MOTORS.into_iter().filter(|second| *second != first) {
                let interlock = Interlock::new();
                assert!(!interlock.is_any_driven());
                interlock.note(first, true);
                interlock.note(second, true);
                interlock.note(first, false);
                assert!(interlock.is_any_driven(), "{second:?} runs after {first:?}");
                interlock.note(second, false);
                assert!(!interlock.is_any_driven(), "{first:?} and {second:?} stand");
            }
        }
    }
}
