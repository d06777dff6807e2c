//! Calibration that the robot has learned: it goes to the disk after each run, a robot that was seen before begins with it, and
//! people may read it and delete it.

use brain::{Learnt, LearntPart};
use rvac_api::{EnergyLearnt, GyroLearnt, LearntView, LogLevel, Update};

use super::audience::{Asker, Asking, Teller};
use super::awaited::{Awaited, Settled};
use super::journal::LogSource;
use crate::Outputs;
use crate::learnt::{Learnings, RobotRecord, StoredLearnings, summary};
use crate::outputs::LearntOrder;
use crate::refusal::Refusal;

/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;

/// What clients ask of what was learnt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LearntRequest {
    /// What is kept.
    Show,
    /// A robot shall learn something again.
    Forget(Forgetting),
}

/// What a robot shall forget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Forgetting {
    /// The robot's name.
    pub(crate) device: String,
    /// What; `None` = all.
    pub(crate) part: Option<rvac_api::LearntPart>,
}

impl Forgetting {
    pub(crate) fn parts(&self) -> &'static [LearntPart] {
        match self.part {
            Some(rvac_api::LearntPart::Gyro) => &[LearntPart::Gyro],
            Some(rvac_api::LearntPart::Energy) => &[LearntPart::Energy],
            None => &[LearntPart::Gyro, LearntPart::Energy],
        }
    }
}

/// What robots have learnt, and those who wait until the disk has forgotten, with what was kept before.
#[derive(Debug, Default)]
pub(crate) struct LearntDesk {
    learnings: Learnings,
    forgetting: Awaited<RobotRecord>,
}

impl LearntDesk {
    pub(crate) fn new(learnings: Learnings) -> Self {
        Self {
            learnings,
            ..Self::default()
        }
    }

    /// What a robot of this name begins with.
    pub(crate) fn of(&self, device: &str) -> Learnt {
        self.learnings.of(device)
    }

    /// Tells what a robot of this name begins with.
    pub(crate) fn introduce(&self, device: &str, teller: &mut Teller<'_>) {
        if let Some(text) = summary(&self.of(device)) {
            teller.log(LogLevel::Info, LogSource::Vthal, text);
        }
    }

    /// Hands out what the robot has learnt, if it is news.
    pub(crate) fn keep(&mut self, kept: RobotRecord, outputs: &mut Outputs) {
        if self.learnings.take(kept) {
            self.write(outputs);
        }
    }

    fn write(&mut self, outputs: &mut Outputs) {
        if let Some(number) = self.forgetting.change() {
            outputs.learnt = Some(LearntOrder {
                number,
                learnt: StoredLearnings::from(&self.learnings),
            });
        }
    }

    /// What is kept; `here` is the robot that is attached.
    pub(crate) fn show(&self, asker: Asker, here: Option<&str>) -> Update {
        Update::Learnt {
            id: asker.id,
            devices: self.learnings.iter().map(|kept| view(kept, here)).collect(),
        }
    }

    /// Forgets something of a robot. Whoever asked is answered when the disk has it. The robot that is here may have learnt
    /// something that is not kept yet.
    ///
    /// # Errors
    /// Nothing is known of the robot.
    pub(crate) fn forget(
        &mut self,
        Asking { asker, request }: &Asking<Forgetting>,
        here: Option<&str>,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let known = self.learnings.forget(&request.device, request.parts());
        let before = match known {
            Some(before) => before,
            None if here == Some(&request.device) => RobotRecord::default(),
            None => return Err("nothing-learnt".into()),
        };
        self.write(outputs);
        self.forgetting.wait(*asker, before);
        Ok(())
    }

    /// The disk has what it was given under this number, or says why it has not. The attached robot learns again all the same,
    /// and its next run writes that to the disk.
    pub(crate) fn kept(&mut self, number: u64, result: Result<(), String>, teller: &mut Teller<'_>) {
        let result = result.map_err(|text| Refusal {
            reason: "learnt-unwritable",
            text,
        });
        let Settled { undone, hands_over } = self.forgetting.kept(number, result, teller);
        for before in undone {
            self.learnings.take(before);
        }
        if hands_over {
            self.write(teller.outputs);
        }
    }
}

fn view(kept: &RobotRecord, here: Option<&str>) -> LearntView {
    let RobotRecord {
        device,
        learnt,
        learnt_s,
    } = kept;
    LearntView {
        device: device.clone(),
        here: here == Some(device),
        learnt_s: *learnt_s,
        gyro: learnt.gyro.map(|gyro| GyroLearnt {
            scale: gyro.scale,
            scale_sigma: gyro.scale_sigma,
            bias_rad_per_s: gyro.bias_rad_per_s,
        }),
        energy: (learnt.energy.seen_s > 0.0).then_some(EnergyLearnt {
            cleaning_per_h: HOUR_S * learnt.energy.cleaning_per_s,
            driving_per_h: HOUR_S * learnt.energy.driving_per_s,
            seen_s: learnt.energy.seen_s,
        }),
    }
}
