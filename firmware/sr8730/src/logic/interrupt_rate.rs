//! Limits the rate of interrupts.
//!
//! A loose or oscillating wire can raise an interrupt as soon as the last one has ended, and nothing else would run.
//! Each source on an external wire therefore has a budget of interrupts per millisecond. When it is spent, the source
//! is disabled until the main loop renews the budget.

use core::sync::atomic::{AtomicU32, Ordering};

/// InterruptRateLimit of one source.
#[derive(Debug)]
pub struct InterruptRateLimit {
    left: AtomicU32,
    per_ms: u32,
}

impl InterruptRateLimit {
    /// Allows this many interrupts per millisecond.
    #[must_use]
    pub const fn new(per_ms: u32) -> Self {
        Self {
            left: AtomicU32::new(per_ms),
            per_ms,
        }
    }

    /// Called in the interrupt: takes one from the budget. False if it was the last one: disable the source now.
    #[inline(always)]
    pub fn spend(&self) -> bool {
        let left = self.left.load(Ordering::Relaxed).saturating_sub(1);
        self.left.store(left, Ordering::Relaxed);
        left != 0
    }

    /// Called in the main loop, once a millisecond: renews the budget. True if it was spent: enable the source again.
    pub fn renew(&self) -> bool {
        let spent = self.left.load(Ordering::Relaxed) == 0;
        self.left.store(self.per_ms, Ordering::Relaxed);
        spent
    }
}

#[cfg(test)]
mod tests {
    use super::InterruptRateLimit;

    #[test]
    fn a_spent_budget_switches_off_until_it_is_renewed() {
        let limit = InterruptRateLimit::new(3);
        assert!(limit.spend() && limit.spend());
        assert!(!limit.renew());
        assert!(limit.spend() && limit.spend() && !limit.spend());
        assert!(!limit.spend(), "a source that is already off stays off");
        assert!(limit.renew());
        assert!(limit.spend());
    }
}
