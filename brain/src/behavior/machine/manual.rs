//! A person drives (S23).

use super::{Behavior, Mode};
use crate::model::action::Motion;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

/// The newest command of the person who drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::behavior) struct ManualDrive {
    pub(super) speed_m_per_s: f64,
    pub(super) turn_rad_per_s: f64,
    pub(super) valid_until_us: u64,
    pub(super) cleaners: bool,
    /// The firmware was ready at least once since manual driving began.
    pub(super) ready: bool,
}

impl Behavior {
    /// A command of the person who drives, the first or a further one.
    pub(super) fn take_wheel(&mut self, drive: ManualDrive, context: &mut TaskContext) {
        self.centre_first = false;
        match self.mode {
            Mode::Manual(earlier) => {
                self.mode = Mode::Manual(ManualDrive {
                    ready: earlier.ready,
                    ..drive
                })
            }
            _ => self.enter(Mode::Manual(drive), Reason::Command, context),
        }
    }

    /// Manual driving ends; the stick counts as centred.
    pub(super) fn release_wheel(&mut self, context: &mut TaskContext) {
        self.centre_first = false;
        if matches!(self.mode, Mode::Manual(_)) {
            self.hold(Reason::Released, context);
        }
    }

    pub(super) fn drive_manually(&mut self, drive: ManualDrive) -> Motion {
        if self.facts.disarmed.any() {
            self.ask_to_arm();
            return Motion::Rest;
        }
        self.mode = Mode::Manual(ManualDrive { ready: true, ..drive });
        let speeds = self.config.speeds;
        Motion::Drive {
            speed_m_per_s: within(drive.speed_m_per_s, speeds.max_m_per_s),
            turn_rad_per_s: within(drive.turn_rad_per_s, speeds.turn_max_rad_per_s),
        }
    }
}

/// Within -limit..=limit; NaN stands still.
fn within(value: f64, limit: f64) -> f64 {
    if value.is_nan() {
        0.0
    } else {
        value.clamp(-limit, limit)
    }
}
