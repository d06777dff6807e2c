//! What the robot has learnt of itself: it goes to the disk after each run, a robot that was seen before begins with it, and
//! people may look at it and have it forgotten.

use brain::LearntPart;
use rvac_api::{EnergyLearnt, GyroLearnt, LearntView, LogLevel, Update};

use super::awaited::{Awaited, Change};
use super::refusal::Refusal;
use super::{Core, recorder};
use crate::Outputs;
use crate::RunEnd;
use crate::journal::Part;
use crate::learnt::{Kept, StoredLearnings, told};
use crate::outputs::{Delivery, LearntOrder, Recipients};
use crate::scheduler::Asker;

/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;

/// A robot shall learn something anew.
pub(super) const FORGETTING: Change<Kept> = Change {
    refused_as: "learnt-unwritable",
    waiting: |core| &mut core.learnt,
    // The robot that is here learns anew all the same, and with its next run the disk hears of that.
    take_back: |core, before| {
        core.config.learnt.take(before);
    },
};

/// Those who wait until the disk has forgotten, with what was kept before.
pub(super) type LearntDesk = Awaited<Kept>;

impl Core {
    /// Tells what a robot of this name begins with.
    pub(super) fn tell_learnt(&mut self, now_us: u64, device: &str, outputs: &mut Outputs) {
        if let Some(text) = told(&self.config.learnt.of(device)) {
            self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
        }
    }

    /// Hands out what the robot has learnt, if it is news.
    pub(super) fn keep_learnt(&mut self, outputs: &mut Outputs) {
        let Some(mind) = self.mind.as_ref().filter(|mind| !mind.brain().estimate().lost) else {
            return;
        };
        let kept = Kept {
            device: mind.device().to_owned(),
            learnt: mind.brain().learnt(),
            learnt_s: self.scheduler.set_clock_s(),
        };
        if self.config.learnt.take(kept) {
            self.write_learnt(outputs);
        }
    }

    fn write_learnt(&mut self, outputs: &mut Outputs) {
        outputs.learnt = Some(LearntOrder {
            number: self.learnt.next_order(),
            learnt: StoredLearnings::from(&self.config.learnt),
        });
    }

    /// A client asks what is kept.
    pub(super) fn show_learnt(&self, (client, id): Asker, outputs: &mut Outputs) -> Result<(), Refusal> {
        let here = self.mind.as_ref().map(|mind| mind.device());
        let devices = self.config.learnt.iter().map(|kept| view(kept, here));
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update: Update::Learnt {
                id,
                devices: devices.collect(),
            },
        });
        Ok(())
    }

    /// A client has something forgotten. Answered when the disk has it.
    pub(super) fn forget_learnt(
        &mut self,
        (now_us, asker): (u64, Asker),
        (device, part): (&str, Option<rvac_api::LearntPart>),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let parts = parts(part);
        let is_here = self.mind.as_ref().is_some_and(|mind| mind.device() == device);
        let is_free = |mind: &crate::mind::Mind| mind.rests() && !mind.holds_commands();
        if is_here && !self.mind.as_ref().is_some_and(is_free) {
            return Err("job-runs".into());
        }
        let known = self.config.learnt.forget(device, parts);
        let before = match known {
            Some(before) => before,
            None if is_here => Kept::default(),
            None => return Err("nothing-learnt".into()),
        };
        if is_here {
            self.forget_in_mind(now_us, parts, outputs);
        }
        self.write_learnt(outputs);
        self.learnt.wait(asker, before);
        Ok(())
    }

    /// A recording that is about to end ends before, because a replay would know nothing of this.
    fn forget_in_mind(&mut self, now_us: u64, parts: &[LearntPart], outputs: &mut Outputs) {
        let recording = self.config.recording;
        let Some(mind) = &mut self.mind else { return };
        if mind.is_recorded() {
            outputs.home = mind.home_to_keep();
            mind.end_run(now_us, RunEnd::Finished, &mut recorder(recording, outputs));
        }
        mind.forget(parts);
    }
}

fn parts(part: Option<rvac_api::LearntPart>) -> &'static [LearntPart] {
    match part {
        Some(rvac_api::LearntPart::Gyro) => &[LearntPart::Gyro],
        Some(rvac_api::LearntPart::Energy) => &[LearntPart::Energy],
        None => &[LearntPart::Gyro, LearntPart::Energy],
    }
}

fn view(kept: &Kept, here: Option<&str>) -> LearntView {
    let Kept {
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
