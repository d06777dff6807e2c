//! What the robot has learnt of itself goes to the disk after each run, and a robot that was seen before begins with it.

use rvac_api::LogLevel;

use super::Core;
use crate::Outputs;
use crate::journal::Part;
use crate::learnt::{StoredLearnings, told};

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
        if self.config.learnt.take(mind.device(), mind.brain().learnt()) {
            outputs.learnt = Some(StoredLearnings::from(&self.config.learnt));
        }
    }
}
