//! Frequencies and bandwidths: counts over a measured time, so that a late second does not distort the figure.

use rvac_units::Tick;

/// Counts events.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RateCounter {
    count: u32,
    since: Tick,
    per_second: u32,
}

impl RateCounter {
    /// Counts from `now` on.
    pub(crate) const fn starting_at(now: Tick) -> Self {
        Self {
            count: 0,
            since: now,
            per_second: 0,
        }
    }

    /// Something happened `times` times.
    pub(crate) const fn add(&mut self, times: u32) {
        self.count = self.count.saturating_add(times);
    }

    /// Ends the span: the rate is that of the span, and the next one starts.
    pub(crate) fn take(&mut self, now: Tick) {
        let span_ms = u64::from(now.since(self.since)).max(1);
        let per_second = u64::from(self.count).saturating_mul(1_000) / span_ms;
        self.per_second = u32::try_from(per_second).unwrap_or(u32::MAX);
        self.count = 0;
        self.since = now;
    }

    /// Events a second in the last span.
    pub(crate) const fn per_second(&self) -> u32 {
        self.per_second
    }
}
