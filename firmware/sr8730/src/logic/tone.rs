//! Tones from OC5 and Timer2.

use rvac_units::{Frequency, Ratio};

/// Clock of the timers' prescaler.
const BUS_HZ: u32 = 80_000_000;
/// Lowest tone: below it the speaker only rattles.
const PITCH_MIN_HZ: u32 = 20;
/// Highest tone, at the limit of hearing.
const PITCH_MAX_HZ: u32 = 20_000;

/// Division of the bus clock before the timer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToneClock {
    /// By 8, as the original has it: tones from 153 Hz up.
    By8,
    /// By 64, for lower ones, whose period would not fit into 16 bits.
    By64,
}

/// Values of the timer and the compare register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tone {
    /// Prescaler.
    pub clock: ToneClock,
    /// Period register: counts of a period less one.
    pub period: u16,
    /// Compare register: counts with the line high, half of the period at full volume.
    pub compare: u16,
}

/// The tone for a pitch and a volume, or `None` when it would be silent: no volume, or a pitch that is not above zero.
/// Inaudible pitches are clamped to the range.
#[must_use]
pub fn tone(pitch: Frequency, volume: Ratio) -> Option<Tone> {
    let pitch_hz = u32::try_from(pitch.0).ok().filter(|hz| *hz > 0)?;
    if volume == Ratio::ZERO {
        return None;
    }
    let pitch_hz = pitch_hz.clamp(PITCH_MIN_HZ, PITCH_MAX_HZ);
    let (clock, counts) = match BUS_HZ / 8 / pitch_hz {
        counts @ ..=0x1_0000 => (ToneClock::By8, counts),
        _ => (ToneClock::By64, BUS_HZ / 64 / pitch_hz),
    };
    let high = u64::from(counts / 2) * u64::from(volume.millionths().unsigned_abs()) / 1_000_000;
    Some(Tone {
        clock,
        // 500..=65,536 less one: fits.
        period: (counts - 1) as u16,
        // At least one count: a volume above zero is heard.
        compare: (high as u16).max(1),
    })
}

#[cfg(test)]
mod tests {
    use super::{Tone, ToneClock, tone};
    use rvac_units::{Frequency, Ratio};

    #[test]
    fn tones_of_the_usual_range() {
        let expected = Tone {
            clock: ToneClock::By8,
            period: 9_999,
            compare: 5_000,
        };
        assert_eq!(tone(Frequency(1_000), Ratio::ONE), Some(expected));
        let half = Ratio::from_millionths(500_000).unwrap();
        assert_eq!(tone(Frequency(1_000), half).unwrap().compare, 2_500);
    }

    #[test]
    fn low_tones_take_the_slower_clock_and_keep_their_pitch() {
        for (pitch, clock) in [
            (153, ToneClock::By8),
            (152, ToneClock::By64),
            (20, ToneClock::By64),
        ] {
            let tone = tone(Frequency(pitch), Ratio::ONE).unwrap();
            assert_eq!(tone.clock, clock);
            let counts_hz = if clock == ToneClock::By8 {
                10_000_000.0
            } else {
                1_250_000.0
            };
            let sounding = counts_hz / (f64::from(tone.period) + 1.0);
            assert!((sounding - f64::from(pitch)).abs() < 0.02, "{pitch}: {sounding}");
        }
    }

    #[test]
    fn no_pitch_divides_by_zero() {
        for pitch in [0, -1, i32::MIN] {
            assert_eq!(tone(Frequency(pitch), Ratio::ONE), None);
        }
        assert_eq!(tone(Frequency(1_000), Ratio::ZERO), None);
        for pitch in (1..100_000).chain([i32::MAX]) {
            let tone = tone(Frequency(pitch), Ratio::ONE).unwrap();
            assert!(u32::from(tone.compare) * 2 <= u32::from(tone.period) + 1);
        }
    }
}
