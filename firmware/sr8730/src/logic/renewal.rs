//! Outputs that must be asked for again and again.
//!
//! cordlib tells each output every 10 ms what it shall do. If that stops for an output, whatever the reason, a flipped bit in
//! the firmware's memory included, the output is switched off.

/// Milliseconds without a call after which an output is switched off.
const OVERDUE_MS: u8 = 50;

/// Time since an output was asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Renewal {
    passed_ms: u8,
}

impl Renewal {
    /// It was asked for now.
    pub const fn renew(&mut self) {
        self.passed_ms = 0;
    }

    /// To be called once in a millisecond; true from 50 ms without [`Self::renew`] on.
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
