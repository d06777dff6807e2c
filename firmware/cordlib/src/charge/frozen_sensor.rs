//! Detects a thermistor reading that is frozen because it is no longer measured.
//!
//! A sensor without noise on a pack of constant temperature shows the same count for many minutes, so a constant reading
//! alone proves little. But a reading that never paused for more than a few seconds while the pack warmed up through
//! several counts has enough noise to change at any temperature: if such a *noisy* reading stops changing, it is frozen.

use crate::rules::charge_frozen::{CONSTANT_MS, NOISY_CONSTANT_MS, PAUSE_MS, SPAN_CC};

/// History of the reading at full current.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrozenSensorDetector {
    last_cc: Option<i32>,
    still_ms: u32,
    /// Least and most since the last pause.
    range_cc: Option<(i32, i32)>,
    noisy: bool,
}

impl FrozenSensorDetector {
    /// Takes an average over `elapsed_ms`; returns whether the reading is frozen.
    pub(super) fn is_frozen(&mut self, cc: Option<i32>, elapsed_ms: u32) -> bool {
        let still = cc == self.last_cc;
        self.last_cc = cc;
        self.still_ms = if still {
            self.still_ms.saturating_add(elapsed_ms)
        } else {
            0
        };
        self.range_cc = match (cc, self.range_cc) {
            (Some(cc), Some((least_cc, most_cc))) if self.still_ms <= PAUSE_MS => {
                Some((least_cc.min(cc), most_cc.max(cc)))
            }
            (cc, _) => cc.map(|cc| (cc, cc)),
        };
        self.noisy |= self
            .range_cc
            .is_some_and(|(least_cc, most_cc)| most_cc.saturating_sub(least_cc) >= SPAN_CC);
        let limit_ms = if self.noisy {
            NOISY_CONSTANT_MS
        } else {
            CONSTANT_MS
        };
        self.still_ms >= limit_ms
    }

    /// No full current for a moment: the pause restarts, and a noisy reading stays noisy.
    pub(super) const fn pause(&mut self) {
        self.last_cc = None;
        self.still_ms = 0;
        self.range_cc = None;
    }
}

#[cfg(test)]
mod tests {
    use super::FrozenSensorDetector;

    const TENTH_MS: u32 = 100;

    /// Seconds until the readings count as frozen.
    fn frozen_s(
        detector: &mut FrozenSensorDetector,
        readings: impl IntoIterator<Item = i32>,
    ) -> Option<usize> {
        readings
            .into_iter()
            .position(|cc| detector.is_frozen(Some(cc), TENTH_MS))
            .map(|tenths| (tenths + 1) / 10)
    }

    /// Averages with noise, from `from_cc` upwards by 0.2 degrees a minute.
    fn noisy(from_cc: i32, tenths: i32) -> impl Iterator<Item = i32> {
        (0..tenths).map(move |tenth| from_cc + tenth / 30 + 7 * (tenth % 3))
    }

    #[test]
    fn a_noisy_reading_that_stops_is_frozen_after_two_minutes() {
        let mut detector = FrozenSensorDetector::default();
        assert_eq!(frozen_s(&mut detector, noisy(3_000, 10_000)), None);
        assert_eq!(frozen_s(&mut detector, [3_340; 2_000]), Some(120));
    }

    #[test]
    fn a_pause_without_current_restarts_the_pause_and_keeps_the_noise() {
        let mut detector = FrozenSensorDetector::default();
        frozen_s(&mut detector, noisy(3_000, 10_000));
        frozen_s(&mut detector, [3_340; 1_000]);
        detector.pause();
        assert_eq!(frozen_s(&mut detector, [3_340; 2_000]), Some(120));
    }

    #[test]
    fn a_quiet_reading_gets_three_quarters_of_an_hour() {
        // Counts of a fifth of a degree, one in ten seconds: faster than a charge may warm its pack.
        let mut detector = FrozenSensorDetector::default();
        assert_eq!(
            frozen_s(&mut detector, (0..3_000).map(|tenth| 3_000 + tenth / 100 * 20)),
            None
        );
        assert_eq!(frozen_s(&mut detector, [3_600; 27_100]), Some(2_700));
    }

    #[test]
    fn a_reading_that_toggles_between_two_counts_is_not_yet_noisy() {
        let mut detector = FrozenSensorDetector::default();
        assert_eq!(
            frozen_s(&mut detector, (0..30_000).map(|tenth| 3_000 + 20 * (tenth % 2))),
            None
        );
        assert_eq!(frozen_s(&mut detector, [3_000; 20_000]), None);
    }
}
