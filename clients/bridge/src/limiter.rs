//! How many commands a flood of them may be.

use std::time::Duration;

/// Commands in a burst, and the pause that allows one more.
pub const COMMANDS_MAX: u32 = 10;
const COMMAND_EVERY: Duration = Duration::from_millis(500);

/// Lets through what a person could have said.
#[derive(Clone, Debug)]
pub struct Limiter {
    burst: u32,
    every: Duration,
    left: u32,
    filled_at: Duration,
}

impl Default for Limiter {
    fn default() -> Self {
        Self::new(COMMANDS_MAX, COMMAND_EVERY)
    }
}

impl Limiter {
    /// Allows `burst` at once, and one more each time `every` has passed.
    #[must_use]
    pub const fn new(burst: u32, every: Duration) -> Self {
        Self {
            burst,
            every,
            left: burst,
            filled_at: Duration::ZERO,
        }
    }

    /// Whether one more may come now.
    pub fn allows(&mut self, now: Duration) -> bool {
        self.fill(now);
        let allowed = self.left > 0;
        self.left = self.left.saturating_sub(1);
        allowed
    }

    /// Whether one more could come now; takes nothing.
    pub fn has_room(&mut self, now: Duration) -> bool {
        self.fill(now);
        self.left > 0
    }

    fn fill(&mut self, now: Duration) {
        let since = now.saturating_sub(self.filled_at);
        let more = u32::try_from(since.as_nanos() / self.every.as_nanos().max(1)).unwrap_or(u32::MAX);
        if more > 0 {
            self.left = self.left.saturating_add(more).min(self.burst);
            self.filled_at = now;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{COMMANDS_MAX, Limiter};

    #[test]
    fn a_burst_passes_and_then_two_a_second() {
        let mut limiter = Limiter::default();
        let start = Duration::from_secs(100);
        let passed = (0..100).filter(|_| limiter.allows(start)).count();
        assert_eq!(passed, usize::try_from(COMMANDS_MAX).unwrap());
        assert!(!limiter.has_room(start));
        let later = (1..=40).filter(|tick| limiter.allows(start + Duration::from_millis(100 * tick)));
        assert_eq!(later.count(), 8);
    }
}
