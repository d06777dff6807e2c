//! Notices a machine that is too slow for the requested speed.

use std::time::{Duration, Instant};

/// How fast simulated time really passes, against how fast it should.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Speedometer {
    wanted: u32,
    since: Instant,
    ticks: u64,
    slow: bool,
}

/// What has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Notice {
    /// Simulated time passes at this many times the wall clock only.
    Slow(f64),
    /// The speed is as requested again.
    AsWanted,
}

impl std::fmt::Display for Notice {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Slow(factor) => write!(
                formatter,
                "this machine simulates {factor:.2} times real time, less than was asked for; time passes more slowly in the home"
            ),
            Self::AsWanted => write!(formatter, "time passes as fast as was asked for again"),
        }
    }
}

/// Speed is measured over spans of this length: shorter ones see single pauses of the system.
const SPAN: Duration = Duration::from_secs(5);
/// Below this share of the requested speed the machine is too slow.
const SLOW: f64 = 0.95;

impl Speedometer {
    pub(crate) const fn starting(started: Instant, wanted: u32) -> Self {
        Self {
            wanted,
            since: started,
            ticks: 0,
            slow: false,
        }
    }

    /// Takes ticks that were done; at the end of a span in which things changed says so.
    pub(crate) fn pass(&mut self, now: Instant, ticks: u64) -> Option<Notice> {
        self.ticks += ticks;
        let passed = now.saturating_duration_since(self.since);
        if passed < SPAN {
            return None;
        }
        let factor = self.ticks as f64 / 1000.0 / passed.as_secs_f64();
        let slow = factor < SLOW * f64::from(self.wanted);
        let changed = slow != self.slow;
        *self = Self {
            since: now,
            ticks: 0,
            slow,
            ..*self
        };
        changed.then_some(if slow {
            Notice::Slow(factor)
        } else {
            Notice::AsWanted
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Notice, Speedometer};
    use std::time::{Duration, Instant};

    #[test]
    fn a_slow_machine_is_noticed_once_and_so_is_its_recovery() {
        let started = Instant::now();
        let mut speedometer = Speedometer::starting(started, 2);
        let mut notices = Vec::new();
        // 6 s at the requested speed, 12 s at half of it, 12 s at the requested one.
        for second in 1..=30_u64 {
            let ticks = if (7..=18).contains(&second) { 1_000 } else { 2_000 };
            let now = started + Duration::from_secs(second);
            notices.extend(speedometer.pass(now, ticks).map(|notice| (second, notice)));
        }
        assert!(matches!(notices[..], [(10, Notice::Slow(factor)), (25, Notice::AsWanted)] if factor < 1.5));
    }
}
