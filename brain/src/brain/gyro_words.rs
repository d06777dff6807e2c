//! Says when the gyro is left out of the estimate, and when it counts again.

use super::Brain;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;

impl Brain {
    /// Notes a change of what is wrong with the gyro.
    pub(super) fn tell_gyro(&mut self) {
        let fault = self.localization.gyro_fault();
        if fault == self.gyro_told {
            return;
        }
        self.gyro_told = fault;
        match fault {
            Some(fault) => self
                .mind
                .decide(DecisionKind::LeaveOutGyro, Reason::Gyro(fault), 0.0),
            None => self.mind.decide(DecisionKind::TakeUpGyro, Reason::GyroBack, 0.0),
        }
    }
}
