//! Averages of the pack's readings. One count of the converter is 32.5 mV or 108 mA, so no decision rests on a single
//! reading: with dither, averaging many readings resolves less than a count.
//!
//! Windows of 20 ms (one envelope of the switch), 100 ms, 1 s and 10 s follow each other without gaps; each sums up the
//! samples of the next smaller one.

use rvac_units::Tick;

use crate::board::{ChargerReadings, ThermistorFault};

/// Lengths of the windows in ms.
const LENGTHS_MS: [u32; WINDOWS] = [20, 100, 1_000, 10_000];
const WINDOWS: usize = 4;
/// Age while there was no reading yet.
const NEVER_MS: u32 = u32::MAX;

/// One of the windows, by its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AveragingWindow {
    Envelope = 0,
    Tenth = 1,
    Second = 2,
    TenSeconds = 3,
}

/// The least and the most that the pack's temperature can be, in hundredths of a degree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PackTemperature {
    pub(crate) coldest_cc: i32,
    pub(crate) warmest_cc: i32,
}

/// Averages of one window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Averages {
    /// Length of the window: at least its nominal one.
    pub(super) elapsed_ms: u32,
    pub(super) pack_mv: i32,
    pub(super) input_mv: i32,
    /// As the board measures it, offset not subtracted.
    pub(super) current_ma: i32,
    /// Of the samples whose thermistor was sound.
    pub(super) temperature: Option<PackTemperature>,
    /// The last fault of the thermistor that a sample showed.
    pub(super) fault: Option<ThermistorFault>,
}

/// Sums of one window. At a thousand samples a second the longest holds ten thousand of at most 33 V.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    elapsed_ms: u32,
    count: i32,
    pack_mv: i32,
    input_mv: i32,
    current_ma: i32,
    warm_count: i32,
    coldest_dc: i32,
    warmest_dc: i32,
    fault: Option<ThermistorFault>,
}

/// Which windows were completed in a pass, with their averages.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CompletedWindows {
    averages: [Option<Averages>; WINDOWS],
}

/// The averages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meter {
    taken: Option<Tick>,
    age_ms: u32,
    adapter: bool,
    measured: bool,
    sums: [Sums; WINDOWS],
}

impl Averages {
    /// The most that the pack's temperature can be, in hundredths of a degree.
    pub(super) fn warmest_cc(&self) -> Option<i32> {
        self.temperature.map(|temperature| temperature.warmest_cc)
    }
}

impl CompletedWindows {
    /// The averages of this window, if it was completed just now and had a sample.
    pub(super) fn of(&self, window: AveragingWindow) -> Option<Averages> {
        self.averages.get(window as usize).copied().flatten()
    }
}

impl Meter {
    pub(super) const fn new() -> Self {
        Self {
            taken: None,
            age_ms: NEVER_MS,
            adapter: false,
            measured: false,
            sums: [Sums {
                elapsed_ms: 0,
                count: 0,
                pack_mv: 0,
                input_mv: 0,
                current_ma: 0,
                warm_count: 0,
                coldest_dc: 0,
                warmest_dc: 0,
                fault: None,
            }; WINDOWS],
        }
    }

    /// Takes the newest readings, `elapsed_ms` after the last ones.
    pub(super) fn take(
        &mut self,
        readings: Option<ChargerReadings>,
        elapsed_ms: u32,
        now: Tick,
    ) -> CompletedWindows {
        self.adapter = readings.is_some_and(|readings| readings.adapter);
        self.measured |= readings.is_some();
        self.age_ms = match readings {
            Some(readings) => readings.age_ms,
            None => self.age_ms.saturating_add(elapsed_ms),
        };
        if let Some(readings) = readings
            && self.is_new(readings.age_ms, now)
            && let Some(first) = self.sums.first_mut()
        {
            first.add_sample(&readings);
        }
        self.close(elapsed_ms)
    }

    /// Age of the newest reading, in ms.
    pub(super) const fn age_ms(&self) -> u32 {
        self.age_ms
    }

    /// Whether there was ever a reading. A board without any, for example because its pack is not calibrated, cannot have
    /// a measurement fault.
    pub(super) const fn has_measured(&self) -> bool {
        self.measured
    }

    /// The supply is on the contacts.
    pub(super) const fn adapter(&self) -> bool {
        self.adapter
    }

    /// A reading counts once, however often the board returns it.
    fn is_new(&mut self, age_ms: u32, now: Tick) -> bool {
        let taken = Tick(now.0.wrapping_sub(age_ms));
        let new = self.taken.is_none_or(|last| taken != last && taken.reached(last));
        if new {
            self.taken = Some(taken);
        }
        new
    }

    fn close(&mut self, elapsed_ms: u32) -> CompletedWindows {
        let mut windows = CompletedWindows::default();
        let mut closed = Sums {
            elapsed_ms,
            ..Sums::default()
        };
        // The samples of this pass are in the smallest window already; only its time is still to be added.
        for ((sums, length_ms), averages) in self.sums.iter_mut().zip(LENGTHS_MS).zip(&mut windows.averages) {
            sums.add(&closed);
            if sums.elapsed_ms < length_ms {
                break;
            }
            closed = *sums;
            *sums = Sums::default();
            *averages = closed.averages();
        }
        windows
    }
}

impl Sums {
    const fn add_sample(&mut self, readings: &ChargerReadings) {
        self.count = self.count.saturating_add(1);
        self.pack_mv = self.pack_mv.saturating_add(readings.pack_mv);
        self.input_mv = self.input_mv.saturating_add(readings.input_mv);
        self.current_ma = self.current_ma.saturating_add(readings.current_ma);
        match readings.temperature {
            Ok(temperature) => {
                self.warm_count = self.warm_count.saturating_add(1);
                self.coldest_dc = self.coldest_dc.saturating_add(temperature.coldest.0 as i32);
                self.warmest_dc = self.warmest_dc.saturating_add(temperature.warmest.0 as i32);
            }
            Err(fault) => self.fault = Some(fault),
        }
    }

    fn add(&mut self, smaller: &Self) {
        self.elapsed_ms = self.elapsed_ms.saturating_add(smaller.elapsed_ms);
        self.count = self.count.saturating_add(smaller.count);
        self.pack_mv = self.pack_mv.saturating_add(smaller.pack_mv);
        self.input_mv = self.input_mv.saturating_add(smaller.input_mv);
        self.current_ma = self.current_ma.saturating_add(smaller.current_ma);
        self.warm_count = self.warm_count.saturating_add(smaller.warm_count);
        self.coldest_dc = self.coldest_dc.saturating_add(smaller.coldest_dc);
        self.warmest_dc = self.warmest_dc.saturating_add(smaller.warmest_dc);
        self.fault = smaller.fault.or(self.fault);
    }

    #[inline(never)]
    fn averages(&self) -> Option<Averages> {
        if self.count == 0 {
            return None;
        }
        let count = self.count.max(1);
        let mean_cc = |sum_dc: i32| sum_dc.saturating_mul(10) / self.warm_count.max(1);
        let temperature = (self.warm_count > 0).then(|| PackTemperature {
            coldest_cc: mean_cc(self.coldest_dc),
            warmest_cc: mean_cc(self.warmest_dc),
        });
        Some(Averages {
            elapsed_ms: self.elapsed_ms,
            pack_mv: self.pack_mv / count,
            input_mv: self.input_mv / count,
            current_ma: self.current_ma / count,
            temperature,
            fault: self.fault,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{AveragingWindow, Meter};
    use crate::board::{ChargerReadings, TemperatureRange, ThermistorFault};
    use rvac_units::{Temperature, Tick};

    fn readings(pack_mv: i32, age_ms: u32) -> ChargerReadings {
        ChargerReadings {
            pack_mv,
            input_mv: pack_mv,
            current_ma: 0,
            temperature: Ok(TemperatureRange::exact(Temperature(250))),
            age_ms,
            adapter: true,
        }
    }

    #[test]
    fn dither_makes_a_mean_finer_than_a_count() {
        let mut meter = Meter::new();
        let start = u32::MAX - 400;
        let mut averages = None;
        for ms in 1..=1_000_u32 {
            let counts = if ms % 4 == 0 { 500 } else { 501 };
            let windows = meter.take(Some(readings(counts * 32, 0)), 1, Tick(start.wrapping_add(ms)));
            averages = windows.of(AveragingWindow::Second).or(averages);
        }
        let averages = averages.unwrap();
        assert_eq!((averages.pack_mv, averages.warmest_cc()), (16_024, Some(2_500)));
    }

    #[test]
    fn a_reading_that_is_shown_twice_counts_once() {
        let mut meter = Meter::new();
        for ms in 1..=20_u32 {
            // The converter stands still from the fifth millisecond on.
            let windows = meter.take(
                Some(readings(
                    if ms < 5 { 10_000 } else { 20_000 },
                    ms.saturating_sub(4),
                )),
                1,
                Tick(ms),
            );
            if let Some(averages) = windows.of(AveragingWindow::Envelope) {
                assert_eq!(averages.pack_mv, 10_000);
            }
        }
        assert_eq!(meter.age_ms(), 16);
    }

    #[test]
    fn windows_without_samples_have_no_mean() {
        let mut meter = Meter::new();
        for ms in 1..=300_u32 {
            let windows = meter.take(None, 1, Tick(ms));
            assert_eq!(windows.of(AveragingWindow::Tenth), None);
        }
        assert!(meter.age_ms() > 200);
    }

    #[test]
    fn a_faulty_thermistor_is_no_temperature() {
        let mut meter = Meter::new();
        let broken = ChargerReadings {
            temperature: Err(ThermistorFault::Open),
            ..readings(15_000, 0)
        };
        let mut averages = None;
        for ms in 1..=20_u32 {
            averages = meter
                .take(Some(broken), 1, Tick(ms))
                .of(AveragingWindow::Envelope)
                .or(averages);
        }
        let averages = averages.unwrap();
        assert_eq!(
            (averages.temperature, averages.fault),
            (None, Some(ThermistorFault::Open))
        );
    }
}
