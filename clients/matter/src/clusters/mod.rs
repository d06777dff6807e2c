//! The clusters of the robot: what a home reads of it and asks it for.

mod modes;
mod operation;
mod power;
mod run_mode;
mod service_area;
mod suction;

pub(crate) use operation::{Operation, write_fault};
pub(crate) use power::Power;
pub(crate) use run_mode::RunMode;
pub(crate) use service_area::Areas;
pub(crate) use suction::Suction;

use rs_matter::dm::clusters::identify::{
    EffectIdentifierEnum, IdentifyAction, IdentifyHooks, IdentifyTypeEnum,
};
use rs_matter::error::ErrorCode;

use crate::robot::Robot;

/// The robot beeps when a home asks which one it is.
impl IdentifyHooks for Robot {
    fn identify_type(&self) -> IdentifyTypeEnum {
        if self.view().beeps {
            IdentifyTypeEnum::AudibleBeep
        } else {
            IdentifyTypeEnum::None
        }
    }

    fn identify(&self, action: IdentifyAction) {
        let ends = [
            EffectIdentifierEnum::FinishEffect,
            EffectIdentifierEnum::StopEffect,
        ];
        let beeps = match action {
            IdentifyAction::Time(_) => true,
            IdentifyAction::Effect(effect, _) => !ends.contains(&effect),
            IdentifyAction::Cancel => false,
        };
        if beeps && self.allows() {
            self.beep();
        }
    }
}

/// A flood of commands gets this answer.
fn limit(robot: &Robot) -> Result<(), ErrorCode> {
    robot.allows().then_some(()).ok_or(ErrorCode::Busy)
}
