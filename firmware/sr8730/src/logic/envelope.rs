//! The charger's gate.
//!
//! The maker's firmware lets pulses of 3.33 % through at 20 kHz and varies the mean current by an envelope of 50 Hz
//! (measured). Here an envelope has 400 PWM periods: the first ones carry a pulse, the rest is quiet. At least 20
//! periods are always quiet, so that one scan of the converter in each envelope sees the pack without pulses, whatever
//! the duty.

use rvac_units::Ratio;

use super::bridge::PERIOD_COUNTS;

/// PWM periods in one envelope: 20 ms.
pub const ENVELOPE_PERIODS: u16 = 400;
/// Quiet periods at the end of each envelope: one millisecond.
pub const QUIET_PERIODS: u16 = 20;
/// Counts of a pulse: 3.33 % of the PWM period as measured on the maker's firmware, from the period itself.
pub const PULSE_COUNTS: u16 = PERIOD_COUNTS / 30;

/// Most periods of an envelope that may carry a pulse.
pub const PULSES_MAX: u16 = ENVELOPE_PERIODS - QUIET_PERIODS;

/// Periods with a pulse for a share of the maximum.
#[must_use]
pub const fn pulses_for(share: Ratio) -> u16 {
    // At most 380: fits. Rounded down, so that the charger never gives more than commanded.
    (share.millionths() as u32 * PULSES_MAX as u32 / 1_000_000) as u16
}

/// Position within the envelope.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Envelope {
    period: u16,
}

impl Envelope {
    /// At the start of an envelope.
    #[must_use]
    pub const fn new() -> Self {
        Self { period: 0 }
    }

    /// Advances by one PWM period and returns the counts of its pulse, 0 for none. Limited to [`PULSES_MAX`].
    pub const fn next(&mut self, pulses: u16) -> u16 {
        let place = self.period;
        self.period = if place + 1 < ENVELOPE_PERIODS {
            place + 1
        } else {
            0
        };
        if place < pulses && place < PULSES_MAX {
            PULSE_COUNTS
        } else {
            0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ENVELOPE_PERIODS, Envelope, PULSE_COUNTS, PULSES_MAX, pulses_for};
    use rvac_units::Ratio;

    fn pulses_in_one_envelope(pulses: u16) -> u16 {
        let mut envelope = Envelope::new();
        let given = (0..ENVELOPE_PERIODS).filter(|_| envelope.next(pulses) == PULSE_COUNTS);
        u16::try_from(given.count()).unwrap()
    }

    #[test]
    fn the_pulse_is_what_was_measured_and_not_a_share_of_another_timer() {
        assert_eq!(PULSE_COUNTS, 133);
    }

    #[test]
    fn quiet_periods_remain_whatever_is_asked() {
        for (asked, given) in [
            (0, 0),
            (1, 1),
            (33, 33),
            (380, 380),
            (381, 380),
            (1_001, 380),
            (u16::MAX, 380),
        ] {
            assert_eq!(pulses_in_one_envelope(asked), given);
        }
    }

    #[test]
    fn shares_become_pulses_rounded_down() {
        let pulses = |millionths| pulses_for(Ratio::from_millionths(millionths).unwrap());
        assert_eq!(pulses(0), 0);
        assert_eq!(pulses(2_000), 0);
        assert_eq!(pulses(500_000), 190);
        assert_eq!(pulses(1_000_000), PULSES_MAX);
        let mut last = 0;
        for millionths in 0..=1_000_000 {
            let now = pulses(millionths);
            assert!(now == last || now == last + 1);
            last = now;
        }
    }
}
