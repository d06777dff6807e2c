//! When to try again after the connection was lost.

/// First and longest pause in ms.
const FIRST_MS: u32 = 250;
const LONGEST_MS: u32 = 5000;

/// Pauses that double up to a limit and start again after a success.
#[derive(Clone, Copy, Debug)]
pub struct Backoff {
    next_ms: u32,
}

impl Default for Backoff {
    fn default() -> Self {
        Self { next_ms: FIRST_MS }
    }
}

impl Backoff {
    /// The pause before the next attempt.
    pub fn pause_ms(&mut self) -> u32 {
        let pause = self.next_ms;
        self.next_ms = (pause * 2).min(LONGEST_MS);
        pause
    }

    /// The connection is open.
    pub fn succeeded(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::{Backoff, LONGEST_MS};

    #[test]
    fn grows_to_a_limit_and_starts_anew() {
        let mut backoff = Backoff::default();
        let pauses: Vec<u32> = (0..8).map(|_| backoff.pause_ms()).collect();
        assert_eq!(pauses[..3], [250, 500, 1000]);
        assert_eq!(pauses[7], LONGEST_MS);
        backoff.succeeded();
        assert_eq!(backoff.pause_ms(), 250);
    }
}
