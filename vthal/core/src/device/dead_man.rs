//! The dead man of the device layer: the same for every make of robot.
//!
//! A drive command is valid for a time. When it expires without a newer command the wheels are stopped, even if the
//! robot would keep its last command for ever. While it is valid it is repeated often enough for robots that stop by
//! themselves.

use super::Drive;

/// Longest time a drive command may be valid.
pub(crate) const VALID_FOR_MAX_US: u64 = 1_000_000;

/// A command to the wheels that is still valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setpoint {
    /// What the wheels do.
    pub drive: Drive,
    /// When it ends.
    pub valid_until_us: u64,
}

impl Setpoint {
    /// Standing still under control.
    #[must_use]
    pub(crate) fn is_zero(&self) -> bool {
        self.drive == Drive::STAND
    }
}

/// The command that the wheels need now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum WheelOrder {
    /// Nothing.
    Keep,
    /// Send this.
    Send(Setpoint),
    /// The command has expired: stop.
    Stand,
}

/// Pause between repetitions of an unchanged command: three of them fall into a lease of 120 ms on the wire.
const REPEAT_US: u64 = 30_000;

/// Watches over the newest drive command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeadMan {
    setpoint: Option<Setpoint>,
    /// When the setpoint was last sent; `None` if it has not been sent yet.
    sent_us: Option<u64>,
}

impl DeadMan {
    /// Nothing is commanded.
    pub(crate) const fn new() -> Self {
        Self {
            setpoint: None,
            sent_us: None,
        }
    }

    /// Takes a new command. One that only prolongs the present one is sent when a repetition is due, any other at once.
    pub(crate) fn set(&mut self, setpoint: Setpoint) {
        let same_motion = self.setpoint.is_some_and(|old| old.drive == setpoint.drive);
        if !same_motion {
            self.sent_us = None;
        }
        self.setpoint = Some(setpoint);
    }

    /// What is permitted has changed: the command is sent again at once.
    pub(crate) const fn repeat_now(&mut self) {
        self.sent_us = None;
    }

    /// Forgets the command without sending anything to the wheels.
    pub(crate) fn forget(&mut self) {
        *self = Self::new();
    }

    /// What is commanded, if anything.
    #[must_use]
    pub(crate) fn setpoint(&self) -> Option<Setpoint> {
        self.setpoint
    }

    /// The command that the wheels need at `now_us`. A [`WheelOrder::Send`] counts as sent.
    pub(crate) fn poll(&mut self, now_us: u64) -> WheelOrder {
        let Some(setpoint) = self.setpoint else {
            return WheelOrder::Keep;
        };
        if now_us >= setpoint.valid_until_us {
            let moved = !setpoint.is_zero();
            self.forget();
            return if moved {
                WheelOrder::Stand
            } else {
                WheelOrder::Keep
            };
        }
        if self.sent_us.is_some_and(|sent_us| now_us < sent_us + REPEAT_US) {
            return WheelOrder::Keep;
        }
        self.sent_us = Some(now_us);
        WheelOrder::Send(setpoint)
    }

    /// When [`DeadMan::poll`] next has a command.
    #[must_use]
    pub(crate) fn next_wake_us(&self) -> Option<u64> {
        let setpoint = self.setpoint?;
        let repeat_us = self.sent_us.map_or(0, |sent_us| sent_us + REPEAT_US);
        Some(repeat_us.min(setpoint.valid_until_us))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Drive;
    use super::{DeadMan, Setpoint, WheelOrder};

    const FORWARD: Setpoint = Setpoint {
        drive: Drive {
            speed_m_per_s: 0.2,
            turn_rad_per_s: 0.0,
        },
        valid_until_us: 250_000,
    };

    #[test]
    fn a_command_that_is_not_renewed_ends_in_standing_once() {
        let mut dead_man = DeadMan::new();
        dead_man.set(FORWARD);
        assert_eq!(dead_man.poll(0), WheelOrder::Send(FORWARD));
        assert_eq!(dead_man.poll(29_999), WheelOrder::Keep);
        assert_eq!(dead_man.next_wake_us(), Some(30_000));
        assert_eq!(dead_man.poll(30_000), WheelOrder::Send(FORWARD));
        assert_eq!(dead_man.poll(60_000), WheelOrder::Send(FORWARD));
        assert_eq!(dead_man.poll(250_000), WheelOrder::Stand);
        assert_eq!(dead_man.poll(250_001), WheelOrder::Keep);
        assert_eq!(dead_man.next_wake_us(), None);
    }

    #[test]
    fn a_change_goes_out_at_once_and_a_renewal_waits() {
        let mut dead_man = DeadMan::new();
        dead_man.set(FORWARD);
        dead_man.poll(0);
        dead_man.set(Setpoint {
            valid_until_us: 260_000,
            ..FORWARD
        });
        assert_eq!(dead_man.poll(10_000), WheelOrder::Keep);
        let turning = Setpoint {
            drive: Drive {
                turn_rad_per_s: 0.5,
                ..FORWARD.drive
            },
            valid_until_us: 270_000,
        };
        dead_man.set(turning);
        assert_eq!(dead_man.poll(20_000), WheelOrder::Send(turning));
    }
}
