//! The daemon's only clock.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rustix::time::{ClockId, clock_gettime};
use tokio::time::Instant;

/// Monotonic time since the daemon's start, in microseconds, which counts the time in which the system was suspended: a robot that was not
/// heard for so long may have been carried. It may run faster than real time (for simulated robots that do the same).
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Time since the system's start when the daemon began.
    origin: Duration,
    speed: f64,
    /// What the clock on the wall showed at the start, seconds since 1970.
    origin_utc_s: i64,
}

impl Clock {
    /// Starts at 0 now. `speed` is the number of clock seconds per real second, above 0.
    #[must_use]
    pub fn start(speed: f64) -> Self {
        Self {
            origin: since_boot(),
            speed,
            origin_utc_s: wall_s(),
        }
    }

    /// Microseconds since the start.
    #[must_use]
    pub fn now_us(&self) -> u64 {
        // Saturating float conversion: 584,000 years fit.
        (since_boot().saturating_sub(self.origin).as_secs_f64() * self.speed * 1e6) as u64
    }

    /// The clock on the wall, seconds since 1970 (UTC). One that runs faster than real time was right at the start.
    #[must_use]
    pub fn utc_s(&self) -> i64 {
        if self.speed == 1.0 {
            wall_s()
        } else {
            self.origin_utc_s + (self.now_us() / 1_000_000).cast_signed()
        }
    }

    /// The real moment at which this clock shows `time_us`, at most an hour ahead.
    #[must_use]
    pub fn moment(&self, time_us: u64) -> Instant {
        let ahead_s = time_us.saturating_sub(self.now_us()) as f64 / 1e6 / self.speed;
        Instant::now() + Duration::from_secs_f64(ahead_s.min(3600.0))
    }
}

/// Time since the system's start, in which it was suspended included.
fn since_boot() -> Duration {
    let now = clock_gettime(ClockId::Boottime);
    // Neither is ever negative.
    let seconds = u64::try_from(now.tv_sec).unwrap_or_default();
    Duration::new(seconds, u32::try_from(now.tv_nsec).unwrap_or_default())
}

/// A clock that shows a time before 1970 is not set.
fn wall_s() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs().cast_signed())
}
