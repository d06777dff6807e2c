//! Time-out of outputs that must be renewed.
//!
//! cordlib writes each output every 10 ms. If it stops to do so for any reason, for example a flipped bit in memory,
//! the output is switched off.

/// Milliseconds without a call after which an output is switched off.
const OVERDUE_MS: u8 = 50;

/// Time since an output was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Renewal {
    passed_ms: u8,
}

impl Renewal {
    /// The output was written now.
    pub const fn renew(&mut self) {
        self.passed_ms = 0;
    }

    /// Called once a millisecond; true after 50 ms without [`Self::renew`].
    pub const fn is_overdue(&mut self) -> bool {
        self.passed_ms = self.passed_ms.saturating_add(1);
        self.passed_ms >= OVERDUE_MS
    }
}

#[cfg(test)]
mod tests {
    use super::Renewal;

    #[test]
    fn an_output_that_is_asked_for_stays_and_another_goes_off() {
        let mut renewal = Renewal::default();
        for _ in 0..20 {
            for _ in 0..10 {
                assert!(!renewal.is_overdue());
            }
            renewal.renew();
        }
        for _ in 1..50 {
            assert!(!renewal.is_overdue());
        }
        for _ in 0..1_000 {
            assert!(renewal.is_overdue());
        }
        renewal.renew();
        assert!(!renewal.is_overdue());
    }
}
