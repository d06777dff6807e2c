//! Interrupts that come too often.
//!
//! A wire that is loose or oscillates can raise an interrupt as soon as the last one has ended, and nothing else would run. Each
//! source that hangs on a wire therefore has a budget for a millisecond; when it is spent the source is switched off until
//! the main loop gives it a new one.

use core::sync::atomic::{AtomicU32, Ordering};

/// Budget of one source.
#[derive(Debug)]
pub struct Budget {
    left: AtomicU32,
    per_ms: u32,
}

impl Budget {
    /// So many interrupts in a millisecond.
    #[must_use]
    pub const fn new(per_ms: u32) -> Self {
        Self {
            left: AtomicU32::new(per_ms),
            per_ms,
        }
    }

    /// In the interrupt: takes one from the budget. False when it was the last one: switch the source off now.
    #[inline(always)]
    pub fn spend(&self) -> bool {
        let left = self.left.load(Ordering::Relaxed).saturating_sub(1);
        self.left.store(left, Ordering::Relaxed);
        left != 0
    }

    /// In the main loop, once in a millisecond: a new budget. True when the old one was spent: switch the source on again.
    pub fn renew(&self) -> bool {
        let spent = self.left.load(Ordering::Relaxed) == 0;
        self.left.store(self.per_ms, Ordering::Relaxed);
        spent
    }
}

#[cfg(test)]
mod tests {
    use super::Budget;

    #[test]
    fn a_spent_budget_switches_off_until_it_is_renewed() {
        let budget = Budget::new(3);
        assert!(budget.spend() && budget.spend());
        assert!(!budget.renew());
        assert!(budget.spend() && budget.spend() && !budget.spend());
        assert!(!budget.spend(), "a source that is already off stays off");
        assert!(budget.renew());
        assert!(budget.spend());
    }
}
