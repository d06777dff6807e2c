//! The Relax's trials, by what goes wrong. A name is that of the SR8730's trial where there is one.

mod link;
mod machine;
mod senses;

use super::scene::RelaxScene;
use super::testbed::RelaxTestbed;
use super::trial::{RelaxEvent, RelaxTrial};
use crate::limits::Limit;
use crate::trial::Expectation;
use stc90::board::HeldLine;

/// All of them.
#[must_use]
pub fn trials() -> Vec<RelaxTrial> {
    [link::trials(), machine::trials(), senses::trials()].concat()
}

/// A fault and its name, where and how it happens, what must follow, and how soon.
const fn trial(
    (name, what): (&'static str, &'static str),
    (scene, event): (RelaxScene, RelaxEvent),
    expected: Expectation,
    limit: Limit,
) -> RelaxTrial {
    RelaxTrial {
        name,
        what,
        scene,
        event,
        expected,
        limit,
        watch_ms: 0,
        share: 1,
    }
}

impl RelaxTrial {
    const fn watched_for(self, watch_ms: u64) -> Self {
        Self { watch_ms, ..self }
    }

    /// Only one in so many moments, because it takes long.
    const fn shared_by(self, share: usize) -> Self {
        Self { share, ..self }
    }
}

fn hold(testbed: &mut RelaxTestbed, (signal, is_on): (HeldLine, bool), cycle: u64) -> u64 {
    testbed.pair.robot_mut().hold(signal, is_on, cycle);
    cycle
}
