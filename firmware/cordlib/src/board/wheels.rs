//! The two driven wheels.

use rvac_units::Throttle;

/// Drive of one wheel's bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WheelDrive {
    /// The motor's terminals are shorted: PWM compare 0, the wheel brakes.
    Brake,
    /// The bridge is driven with this duty, forward positive. Full scale is a duty of 1. Cordlib compensates the dead band
    /// of the motor, not the board.
    Duty(Throttle),
}

impl WheelDrive {
    /// The duty, 0 when braking.
    #[must_use]
    pub const fn duty(self) -> Throttle {
        match self {
            Self::Brake => Throttle::ZERO,
            Self::Duty(duty) => duty,
        }
    }
}

/// The bridges of both wheels.
pub trait WheelMotors {
    /// Sets both bridges. Called when an output changes, and every 10 ms while nothing does: a board may brake by itself
    /// when the calls stop.
    fn drive(&mut self, left: WheelDrive, right: WheelDrive);
}

/// Totals of the wheel encoders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WheelCounts {
    /// Left wheel, forward positive, wraps through the whole `i32` range.
    pub left: i32,
    /// Right wheel, forward positive, wraps through the whole `i32` range.
    pub right: i32,
}

/// Encoders of both wheels, counted by the board.
pub trait Encoders {
    /// Whether there are any.
    const PRESENT: bool;

    /// The totals now; both zero when there are no encoders.
    fn counts(&mut self) -> WheelCounts;
}
