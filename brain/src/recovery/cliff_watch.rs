//! Watches the times of cliffs. The firmware latches at the third cliff within five seconds (S8), and then only a person
//! can start the robot again. Whatever drives it, after two cliffs the robot stands still until the first of them is long
//! enough ago.

use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

/// Two cliffs within this time are enough, microseconds: a little more than the firmware's five seconds.
const WINDOW_US: u64 = 5_500_000;

/// Times of the last two cliffs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CliffWatch {
    cliffs_us: [Option<u64>; 2],
    waits: bool,
}

impl CliffWatch {
    /// A cliff has begun to hold the robot.
    pub(crate) fn note_cliff(&mut self, now_us: u64) {
        self.cliffs_us = [self.cliffs_us[1], Some(now_us)];
    }

    /// Whether another cliff now would be one too many, so that a free robot must stand still.
    pub(crate) fn must_wait(&mut self, is_at_cliff: bool, now_us: u64, context: &mut TaskContext) -> bool {
        let is_one_too_many =
            self.cliffs_us[0].is_some_and(|cliffs_us| now_us < cliffs_us.saturating_add(WINDOW_US));
        let waits = is_one_too_many && !is_at_cliff;
        if waits && !self.waits {
            context.decide(DecisionKind::Wait, Reason::CliffAgain, 0.0);
        }
        self.waits = waits;
        waits
    }
}

#[cfg(test)]
mod tests {
    use super::{CliffWatch, WINDOW_US};
    use crate::model::observation::{Cliffs, Observation};
    use crate::model::onsets::OnsetDetector;
    use crate::model::random::Random;
    use crate::navigation::TaskContext;

    #[test]
    fn a_free_robot_stands_still_after_two_cliffs_until_the_first_is_long_ago() {
        let mut context = TaskContext {
            random: Random::new(1),
            journal: Vec::new(),
        };
        let mut watch = CliffWatch::default();
        let mut onsets = OnsetDetector::default();
        let mut step = |middle, now_us| {
            let observation = Observation {
                cliffs: Cliffs {
                    middle,
                    ..Cliffs::default()
                },
                ..Observation::default()
            };
            if onsets.take(&observation).is_held_by_cliff {
                watch.note_cliff(now_us);
            }
            watch.must_wait(observation.is_at_cliff(), now_us, &mut context)
        };
        assert!(!step(true, 1_000_000), "it must back off");
        assert!(!step(false, 1_500_000), "one edge is none too many");
        assert!(!step(true, 3_000_000), "it must back off again");
        assert!(!step(true, 3_400_000), "the same edge still");
        assert!(step(false, 3_500_000));
        assert!(step(false, 1_000_000 + WINDOW_US - 1));
        assert!(!step(false, 1_000_000 + WINDOW_US));
        assert!(!step(true, 7_000_000));
        assert!(step(false, 7_500_000), "the second and the third");
        assert!(!step(false, 3_000_000 + WINDOW_US));
        assert_eq!(context.journal.len(), 2, "each wait is recorded once");
    }
}
