//! The daemon's only clock.

use std::time::Duration;

use tokio::time::Instant;

/// Monotonic time since the daemon's start, in microseconds, optionally running faster than real time (for simulated
/// robots that do the same).
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    origin: Instant,
    speed: f64,
}

impl Clock {
    /// Starts at 0 now. `speed` is the number of clock seconds per real second, above 0.
    #[must_use]
    pub fn start(speed: f64) -> Self {
        Self {
            origin: Instant::now(),
            speed,
        }
    }

    /// Microseconds since the start.
    #[must_use]
    pub fn now_us(&self) -> u64 {
        // Saturating float conversion: 584,000 years fit.
        (self.origin.elapsed().as_secs_f64() * self.speed * 1e6) as u64
    }

    /// The real moment at which this clock shows `time_us`, at most an hour ahead.
    #[must_use]
    pub fn moment(&self, time_us: u64) -> Instant {
        let ahead_s = time_us.saturating_sub(self.now_us()) as f64 / 1e6 / self.speed;
        Instant::now() + Duration::from_secs_f64(ahead_s.min(3600.0))
    }
}
