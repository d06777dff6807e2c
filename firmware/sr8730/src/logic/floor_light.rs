//! Cliff sensors whose emitters cannot be switched.
//!
//! No source names a line that switches the three emitters. If calibration finds that LED_UNKNOWNS (RG0) does,
//! cordlib's self-test darkens them (S9). If they are always lit, a receiver that is stuck at a level looks like one
//! over an even floor at first. Two faults can still be detected: a level at the end of the converter's range (broken
//! wire, sunlight), and a level that has not changed by a single count while the robot drove more than a metre.

/// Readings at or above this are saturated and cannot show floor.
const SATURATED: u16 = 1_020;
/// Readings below this mean a wire that is broken or shorted to ground; a drop still reflects a little.
const GROUNDED: u16 = 2;
/// Distance over which a sensor may show the same reading, in encoder counts of both wheels together, if the distance
/// per count is not calibrated.
const STILL_COUNTS_DEFAULT: u32 = 8_000;
/// Distance over which a sensor may show the same reading.
const FROZEN_DISTANCE_NM: u64 = 2_000_000_000;

/// Detects implausible readings of a cliff sensor.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrozenReadingDetector {
    last: u16,
    counts: u32,
}

/// Encoder counts of both wheels together for the longest distance without a change, by the distance per count.
#[must_use]
pub fn frozen_after_counts(distance_per_count_nm: Option<i32>) -> u32 {
    let distance_nm = distance_per_count_nm
        .and_then(|distance| u64::try_from(distance).ok())
        .filter(|distance| *distance > 0);
    match distance_nm.and_then(|distance| (2 * FROZEN_DISTANCE_NM).checked_div(distance)) {
        Some(counts) => u32::try_from(counts).unwrap_or(u32::MAX),
        None => STILL_COUNTS_DEFAULT,
    }
}

impl FrozenReadingDetector {
    /// Takes a reading and the counts that both wheels made since the last one; returns whether the reading is
    /// plausible.
    pub const fn is_plausible(&mut self, reading: u16, counts: u32, frozen_after_counts: u32) -> bool {
        if reading == self.last {
            self.counts = self.counts.saturating_add(counts);
        } else {
            self.counts = 0;
            self.last = reading;
        }
        reading >= GROUNDED && reading < SATURATED && self.counts < frozen_after_counts
    }
}

#[cfg(test)]
mod tests {
    use super::{FrozenReadingDetector, frozen_after_counts};

    #[test]
    fn a_reading_that_never_moves_while_the_robot_drives_is_not_believed() {
        let mut watch = FrozenReadingDetector::default();
        let limit = frozen_after_counts(Some(500_000));
        assert_eq!(limit, 8_000);
        assert!(watch.is_plausible(700, 0, limit));
        for _ in 0..3_999 {
            assert!(watch.is_plausible(700, 2, limit));
        }
        assert!(!watch.is_plausible(700, 2, limit));
        assert!(!watch.is_plausible(700, 0, limit));
        assert!(watch.is_plausible(701, 2, limit));
    }

    #[test]
    fn a_robot_at_rest_may_see_the_same_for_ever() {
        let mut watch = FrozenReadingDetector::default();
        for _ in 0..100_000 {
            assert!(watch.is_plausible(700, 0, 8_000));
        }
    }

    #[test]
    fn the_ends_of_the_range_are_not_believed() {
        let mut watch = FrozenReadingDetector::default();
        for (reading, plausible) in [
            (0, false),
            (1, false),
            (2, true),
            (1_019, true),
            (1_020, false),
            (1_023, false),
        ] {
            assert_eq!(watch.is_plausible(reading, 0, 8_000), plausible, "{reading}");
        }
    }

    #[test]
    fn strange_ways_do_not_divide_by_zero() {
        assert_eq!(frozen_after_counts(None), 8_000);
        assert_eq!(frozen_after_counts(Some(0)), 8_000);
        assert_eq!(frozen_after_counts(Some(-5)), 8_000);
        assert_eq!(frozen_after_counts(Some(1)), 4_000_000_000);
    }
}
