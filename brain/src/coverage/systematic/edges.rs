//! When edges of the floor were met: the firmware latches at the third one within five seconds (S8).

use crate::behavior::Reason;
use crate::task::Mind;

/// Two edges within this time are enough, microseconds: a little more than the firmware's five seconds.
const WINDOW_US: u64 = 5_500_000;

/// Times of the last two edges.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges {
    met_us: [Option<u64>; 2],
    waits: bool,
}

impl Edges {
    /// An edge was met.
    pub(super) fn note(&mut self, now_us: u64) {
        self.met_us = [self.met_us[1], Some(now_us)];
    }

    /// Whether another edge now would be one too many, so that the robot must not drive on yet.
    pub(super) fn must_wait(&mut self, now_us: u64, mind: &mut Mind) -> bool {
        let waits = self.met_us[0].is_some_and(|met_us| now_us < met_us.saturating_add(WINDOW_US));
        if waits && !self.waits {
            mind.decide("wait", Reason::CliffAgain, 0.0);
        }
        self.waits = waits;
        waits
    }
}
