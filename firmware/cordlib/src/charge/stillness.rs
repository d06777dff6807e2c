//! Whether the thermistor's reading still lives, or stands still because it is not measured any more.
//!
//! A quiet sensor on a steady pack shows the same count for many minutes, so silence alone tells little. But a reading that
//! never rested for more than a few seconds while the pack warmed up through several counts has noise enough to move at
//! any temperature: when that one falls silent, it is dead.

/// Without the least change of a single average for so long no sensor is alive.
const SILENT_MS: u32 = 2_700_000;
/// A lively one is not silent for so long.
const LIVELY_SILENT_MS: u32 = 120_000;
/// Pauses of a lively one. The fastest warming that is no end of the charge changes a count of a 10-bit converter less often
/// than that.
const PAUSE_MS: u32 = 5_000;
/// The way through several counts, in hundredths of a degree.
const WAY_CC: i32 = 150;

/// What was seen of the reading at full current.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stillness {
    last_cc: Option<i32>,
    still_ms: u32,
    /// Least and most since the last pause.
    range_cc: Option<(i32, i32)>,
    lively: bool,
}

impl Stillness {
    /// Takes an average over `elapsed_ms`; whether the reading stands still.
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
        self.lively |= self
            .range_cc
            .is_some_and(|(least_cc, most_cc)| most_cc.saturating_sub(least_cc) >= WAY_CC);
        let limit_ms = if self.lively { LIVELY_SILENT_MS } else { SILENT_MS };
        self.still_ms >= limit_ms
    }

    /// No full current for a moment: what was found out stays true.
    pub(super) const fn pause(&mut self) {
        self.last_cc = None;
        self.still_ms = 0;
        self.range_cc = None;
    }
}

#[cfg(test)]
mod tests {
    use super::Stillness;

    const TENTH_MS: u32 = 100;

    /// Seconds until the readings count as frozen.
    fn frozen_s(stillness: &mut Stillness, readings: impl IntoIterator<Item = i32>) -> Option<usize> {
        readings
            .into_iter()
            .position(|cc| stillness.is_frozen(Some(cc), TENTH_MS))
            .map(|tenths| (tenths + 1) / 10)
    }

    /// Averages that tremble, from `from_cc` upwards by 0.2 degrees a minute.
    fn lively(from_cc: i32, tenths: i32) -> impl Iterator<Item = i32> {
        (0..tenths).map(move |tenth| from_cc + tenth / 30 + 7 * (tenth % 3))
    }

    #[test]
    fn a_lively_reading_that_stops_is_frozen_after_two_minutes() {
        let mut stillness = Stillness::default();
        assert_eq!(frozen_s(&mut stillness, lively(3_000, 10_000)), None);
        assert_eq!(frozen_s(&mut stillness, [3_340; 2_000]), Some(120));
    }

    #[test]
    fn a_pause_without_current_forgets_the_silence_and_not_the_liveliness() {
        let mut stillness = Stillness::default();
        frozen_s(&mut stillness, lively(3_000, 10_000));
        frozen_s(&mut stillness, [3_340; 1_000]);
        stillness.pause();
        assert_eq!(frozen_s(&mut stillness, [3_340; 2_000]), Some(120));
    }

    #[test]
    fn a_quiet_reading_gets_three_quarters_of_an_hour() {
        // Counts of a fifth of a degree, one in ten seconds: faster than a charge may warm its pack.
        let mut stillness = Stillness::default();
        assert_eq!(
            frozen_s(&mut stillness, (0..3_000).map(|tenth| 3_000 + tenth / 100 * 20)),
            None
        );
        assert_eq!(frozen_s(&mut stillness, [3_600; 27_100]), Some(2_700));
    }

    #[test]
    fn a_reading_that_trembles_between_two_counts_is_not_yet_lively() {
        let mut stillness = Stillness::default();
        assert_eq!(
            frozen_s(&mut stillness, (0..30_000).map(|tenth| 3_000 + 20 * (tenth % 2))),
            None
        );
        assert_eq!(frozen_s(&mut stillness, [3_000; 20_000]), None);
    }
}
