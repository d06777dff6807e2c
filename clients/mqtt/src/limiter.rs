//! How many commands a flood of them may be.

use std::time::Duration;

/// Commands in a burst, and the pause that allows one more.
pub(crate) const COMMANDS_MAX: u32 = 10;
const COMMAND_EVERY: Duration = Duration::from_millis(500);

/// Lets through what a person could have said.
#[derive(Debug)]
pub(crate) struct Limiter {
    left: u32,
    filled_at: Duration,
}

impl Default for Limiter {
    fn default() -> Self {
        Self {
            left: COMMANDS_MAX,
            filled_at: Duration::ZERO,
        }
    }
}

impl Limiter {
    pub(crate) fn allows(&mut self, now: Duration) -> bool {
        let since = now.saturating_sub(self.filled_at);
        let more = u32::try_from(since.as_millis() / COMMAND_EVERY.as_millis()).unwrap_or(u32::MAX);
        if more > 0 {
            self.left = self.left.saturating_add(more).min(COMMANDS_MAX);
            self.filled_at = now;
        }
        let allowed = self.left > 0;
        self.left = self.left.saturating_sub(1);
        allowed
    }
}
