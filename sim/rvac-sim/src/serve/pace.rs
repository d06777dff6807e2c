//! Number of simulated milliseconds that are due.

use std::time::{Duration, Instant};

/// Turns the wall clock into ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pacer {
    started: Instant,
    speed: u32,
    done: u64,
}

/// After a longer pause than this (the machine slept, the process was stopped) time is given up instead of caught up.
const CATCH_UP: Duration = Duration::from_millis(250);
const NS_PER_MS: u128 = 1_000_000;

impl Pacer {
    pub(crate) fn starting(started: Instant, speed: u32) -> Self {
        Self {
            started,
            speed: speed.max(1),
            done: 0,
        }
    }

    /// Time until the next tick; at high speeds at least a millisecond, so that ticks go in groups.
    pub(crate) fn until_next(&self, now: Instant) -> Duration {
        let next_ns = u128::from(self.done + u64::from(self.speed)) * NS_PER_MS / u128::from(self.speed);
        let passed_ns = now.saturating_duration_since(self.started).as_nanos();
        Duration::from_nanos(next_ns.saturating_sub(passed_ns).min(u128::from(u32::MAX)) as u64)
    }

    /// Ticks that are due at `now`, counted as done.
    pub(crate) fn take_due(&mut self, now: Instant) -> u64 {
        let due = self.ticks_at(now).saturating_sub(self.done);
        let most = CATCH_UP.as_millis() as u64 * u64::from(self.speed);
        self.done += due;
        due.min(most)
    }

    fn ticks_at(&self, now: Instant) -> u64 {
        let passed_ns = now.saturating_duration_since(self.started).as_nanos();
        (passed_ns * u128::from(self.speed) / NS_PER_MS) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::Pacer;
    use std::time::{Duration, Instant};

    #[test]
    fn ticks_follow_the_clock_times_speed() {
        let started = Instant::now();
        let mut pace = Pacer::starting(started, 20);
        assert_eq!(pace.until_next(started), Duration::from_millis(1));
        assert_eq!(pace.take_due(started + Duration::from_micros(1_500)), 30);
        assert_eq!(pace.take_due(started + Duration::from_micros(1_540)), 0);
        assert_eq!(pace.take_due(started + Duration::from_micros(1_550)), 1);
    }

    #[test]
    fn a_long_pause_is_given_up() {
        let started = Instant::now();
        let mut pace = Pacer::starting(started, 2);
        assert_eq!(pace.take_due(started + Duration::from_secs(60)), 500);
        assert_eq!(pace.take_due(started + Duration::from_secs(60)), 0);
        assert_eq!(pace.take_due(started + Duration::from_millis(60_001)), 2);
    }
}
