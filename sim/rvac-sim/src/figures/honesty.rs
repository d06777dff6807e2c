//! Consistency of the pose estimate: whether the reported uncertainty covers the true error.

/// Wrong by more than this, metres.
pub(super) const WRONG_M: f64 = 0.5;

/// Time in which the reported uncertainty does not cover the error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HonestyWatch {
    before_ms: u64,
    unnoticed_ms: u64,
    false_alarm_ms: u64,
}

impl HonestyWatch {
    pub(super) fn sample(&mut self, now_ms: u64, error_m: f64, says_lost: bool) {
        let elapsed_ms = now_ms.saturating_sub(self.before_ms);
        self.before_ms = now_ms;
        match (error_m > WRONG_M, says_lost) {
            (true, false) => self.unnoticed_ms += elapsed_ms,
            (false, true) => self.false_alarm_ms += elapsed_ms,
            (true, true) | (false, false) => {}
        }
    }

    /// Seconds with a wrong pose that the robot reported as known.
    pub(super) fn unnoticed_s(&self) -> f64 {
        self.unnoticed_ms as f64 / 1000.0
    }

    /// Seconds with a right place of which the robot said that it does not know it.
    pub(super) fn false_alarm_s(&self) -> f64 {
        self.false_alarm_ms as f64 / 1000.0
    }
}

#[cfg(test)]
mod tests {
    use super::HonestyWatch;

    #[test]
    fn only_what_is_not_so_counts() {
        let mut watch = HonestyWatch::default();
        for second in 1..=100_u64 {
            let (error_m, says_lost) = match second {
                ..=10 => (0.1, false),
                11..=30 => (0.8, false),
                31..=95 => (0.8, true),
                _ => (0.2, true),
            };
            watch.sample(second * 1000, error_m, says_lost);
        }
        assert_eq!((watch.unnoticed_s(), watch.false_alarm_s()), (20.0, 5.0));
    }
}
