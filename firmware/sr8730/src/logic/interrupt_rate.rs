//! Interrupts that come too often.
//!
//! A wire that is loose or oscillates can raise an interrupt as soon as the last one has ended, and nothing else would run. Each
//! source that hangs on a wire therefore has a budget for a millisecond; when it is spent the source is switched off until
//! the main loop gives it a new one.

use core::sync::atomic::{AtomicU32, Ordering};

/// InterruptRateLimit of one source.
#[derive(Debug)]
pub struct InterruptRateLimit {
    left: AtomicU32,
    per_ms: u32,
}

impl InterruptRateLimit {
    /// So many interrupts in a millisecond.
    #[must_use]
    pub const fn new(per_ms: u32) -> Self {
        Self {
            left: AtomicU32::new(per_ms),
            per_ms,
        }
    }

    /// In the interrupt: takes one from the limit. False when it was the last one: switch the source off now.
    #[inline(always)]
    pub fn spend(&self) -> bool {
        let left = self.left.load(Ordering::Relaxed).saturating_sub(1);
        self.left.store(left, Ordering::Relaxed);
        left != 0
    }

    /// In the main loop, once in a millisecond: a new limit. True when the old one was spent: switch the source on again.
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
