//! The one entry point.

use rvac_api::{Pose, Status, Topic};

use crate::{ClientId, CoreConfig, Input, Outputs};

/// All state of the daemon that is not a file, a socket or a clock.
#[derive(Debug)]
pub struct Core {
    config: CoreConfig,
}

impl Core {
    /// A core that has no robot yet.
    #[must_use]
    pub fn new(config: CoreConfig) -> Self {
        Self { config }
    }

    /// Takes one input at `now_us` (microseconds of a monotonic clock since the daemon's start; never decreasing) and
    /// appends what must be done to `outputs`.
    pub fn handle(&mut self, now_us: u64, input: Input<'_>, outputs: &mut Outputs) {
        let _ = (now_us, input, outputs, &self.config);
    }

    /// When the core wants [`Input::Wake`], in microseconds; `None` when only other inputs matter.
    #[must_use]
    pub fn next_wake_us(&self) -> Option<u64> {
        None
    }

    /// The clients that follow `topic`, in the order in which they connected.
    pub fn followers(&self, topic: Topic) -> impl Iterator<Item = ClientId> + '_ {
        let _ = topic;
        core::iter::empty()
    }

    /// Where the brain believes the robot to be.
    #[must_use]
    pub fn pose(&self) -> Pose {
        Pose::default()
    }

    /// What the robot is doing.
    #[must_use]
    pub fn status(&self) -> Status {
        Status::default()
    }

    /// Whether nothing moves as far as the newest report tells, or nothing is known because no robot is there.
    #[must_use]
    pub fn stands_still(&self) -> bool {
        true
    }
}
