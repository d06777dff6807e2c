//! From a radio's bytes to signals for the brain: pure, so that any bytes can be tried.

use std::time::Duration;

use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength};

use super::lines::Lines;
use super::reading::{LineError, Measured, Reading};
use super::roster::{BeaconNumber, Roster};
use super::{RadioForm, RadioSettings, dwm1001, json};

/// Refused lines are reported at the first, and then at most this often.
const REPORT_EVERY: Duration = Duration::from_secs(60);
/// Letters of a refused line that are reported.
const EXCERPT: usize = 60;

/// What bytes said.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Heard {
    /// What was measured of beacons that count.
    pub(super) signals: Vec<BeaconSignal>,
    /// Beacons that were received for the first time, and their numbers.
    pub(super) new: Vec<(String, u16)>,
    /// Lines named a beacon, whether or not it counts.
    pub(super) is_speaking: bool,
    /// Refused lines that are to be reported.
    pub(super) refused: Option<Refused>,
}

/// Lines that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refused {
    /// So many since the last report.
    pub(crate) count: u64,
    /// The beginning of the last of them.
    pub(crate) line: String,
    /// What is wrong with it.
    pub(crate) reason: String,
}

/// Listens to a radio.
#[derive(Debug)]
pub(super) struct RadioDecoder {
    form: RadioForm,
    sigma_m: f64,
    height_m: f64,
    lines: Lines,
    roster: Roster,
    untold: u64,
    reported_at: Option<Duration>,
}

impl RadioDecoder {
    pub(super) fn new(settings: &RadioSettings) -> Self {
        Self {
            form: settings.form,
            sigma_m: settings.sigma_m,
            height_m: settings.height_m,
            lines: Lines::default(),
            roster: Roster::new(&settings.beacons),
            untold: 0,
            reported_at: None,
        }
    }

    /// The device was opened again.
    pub(super) fn begin(&mut self) {
        self.lines = Lines::default();
    }

    /// Takes in bytes that came at `now` of the radio's own clock.
    pub(super) fn take(&mut self, now: Duration, bytes: &[u8]) -> Heard {
        let mut heard = Heard::default();
        let mut lines = std::mem::take(&mut self.lines);
        lines.split(bytes, |line| {
            let text = line.and_then(|line| {
                let text = std::str::from_utf8(line).map_err(|_| LineError::NotText)?;
                Ok((text, self.read(text)))
            });
            match text {
                Ok((_, Ok(readings))) => {
                    for reading in readings {
                        self.hear(&reading, &mut heard);
                    }
                }
                Ok((text, Err(error))) => {
                    heard.refused = self.refuse(now, text, &error).or(heard.refused.take())
                }
                Err(error) => heard.refused = self.refuse(now, "", &error).or(heard.refused.take()),
            }
        });
        self.lines = lines;
        heard
    }

    fn read(&self, text: &str) -> Result<Vec<Reading>, LineError> {
        match self.form {
            RadioForm::Lines => json::read(text),
            RadioForm::Dwm1001 => dwm1001::read(text),
        }
    }

    fn hear(&mut self, reading: &Reading, heard: &mut Heard) {
        heard.is_speaking = true;
        let beacon = match self.roster.place(&reading.beacon) {
            BeaconNumber::Known(number) => number,
            BeaconNumber::New(number) => {
                heard.new.push((reading.beacon.to_string(), number));
                number
            }
            BeaconNumber::Stranger => return,
        };
        heard.signals.push(match reading.measured {
            Measured::Range(range_m, sigma_m) => {
                let sigma_m = sigma_m.unwrap_or(self.sigma_m);
                BeaconSignal::Range(level(
                    BeaconRange {
                        beacon,
                        range_m,
                        sigma_m,
                    },
                    self.height_m,
                ))
            }
            Measured::Strength(dbm) => BeaconSignal::Strength(BeaconStrength { beacon, dbm }),
        });
    }

    /// Counts a line; the message about it when one is due.
    fn refuse(&mut self, now: Duration, line: &str, error: &LineError) -> Option<Refused> {
        self.untold += 1;
        let is_due = self
            .reported_at
            .is_none_or(|reported| now >= reported + REPORT_EVERY);
        is_due.then(|| {
            self.reported_at = Some(now);
            Refused {
                count: std::mem::take(&mut self.untold),
                line: line.chars().take(EXCERPT).collect(),
                reason: error.to_string(),
            }
        })
    }
}

/// The distance on the floor to below a beacon, of the distance to it; it hangs `height_m` above the robot's antenna. Near below it the error of
/// the slanting way counts for more.
fn level(slant: BeaconRange, height_m: f64) -> BeaconRange {
    let (slant_m, sigma_m) = (slant.range_m, slant.sigma_m);
    let range_m = (slant_m * slant_m - height_m * height_m).max(0.0).sqrt();
    let steepness = if height_m > 0.0 {
        slant_m.max(height_m) / range_m.max(sigma_m)
    } else {
        1.0
    };
    BeaconRange {
        beacon: slant.beacon,
        range_m,
        sigma_m: sigma_m * steepness.max(1.0),
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength};
    use proptest::prelude::*;

    use super::super::{BeaconName, RadioForm, RadioSettings};
    use super::{RadioDecoder, level};

    const LINES: &str = "\n{\"beacon\":\"hall\",\"range_m\":3.21}\n{\"beacon\":\"kitchen\",\"range_m\":0.5,\"sigma_m\":0.1}\n{\"beacon\":\"hall\",\"rssi_dbm\":-63}\n";
    const SHELL: &str = "\r\nDIST,2,AN0,1151,5.00,8.00,2.25,6.48,AN1,0CA8,0.00,8.00,2.25,6.51,POS,2.57,1.98,1.68,100\r\n\
         1151[5.00,8.00,2.25]=6.48 0CA8[0.00,8.00,2.25]=6.51 le_us=2576 est[2.57,1.98,1.68,100]\r\n";

    fn settings(form: RadioForm) -> RadioSettings {
        RadioSettings {
            form,
            ..RadioSettings::new("/dev/null".into())
        }
    }

    /// Numbers that the names of two beacons give.
    const HALL: u16 = 28_556;
    const KITCHEN: u16 = 25_801;

    #[test]
    fn distances_get_numbers_and_deviations() {
        let mut decoder = RadioDecoder::new(&settings(RadioForm::Lines));
        let heard = decoder.take(Duration::ZERO, LINES.as_bytes());
        let range = |beacon, range_m, sigma_m| {
            BeaconSignal::Range(BeaconRange {
                beacon,
                range_m,
                sigma_m,
            })
        };
        assert_eq!(
            heard.signals,
            [
                range(HALL, 3.21, 0.2),
                range(KITCHEN, 0.5, 0.1),
                BeaconSignal::Strength(BeaconStrength {
                    beacon: HALL,
                    dbm: -63.0
                }),
            ]
        );
        assert_eq!(
            heard.new,
            [("hall".to_owned(), HALL), ("kitchen".to_owned(), KITCHEN)]
        );
        assert!(heard.is_speaking);
        assert_eq!(heard.refused, None);
        assert_eq!(decoder.take(Duration::ZERO, LINES.as_bytes()).new, []);
    }

    #[test]
    fn strangers_speak_and_do_not_count() {
        let hall = BeaconName::new("hall").unwrap();
        let mut decoder = RadioDecoder::new(&RadioSettings {
            beacons: vec![hall],
            ..settings(RadioForm::Lines)
        });
        let heard = decoder.take(Duration::ZERO, LINES.as_bytes());
        assert_eq!((heard.signals.len(), heard.is_speaking), (2, true));
    }

    #[test]
    fn broken_lines_are_counted_and_reported_once_a_minute() {
        let mut decoder = RadioDecoder::new(&settings(RadioForm::Lines));
        let mut refusals = Vec::new();
        for second in 0..=120 {
            let heard = decoder.take(Duration::from_secs(second), b"\nnonsense\n");
            assert_eq!((heard.signals.len(), heard.is_speaking), (0, false));
            refusals.extend(heard.refused.map(|refused| (second, refused.count, refused.line)));
        }
        let line = || "nonsense".to_owned();
        assert_eq!(refusals, [(0, 1, line()), (60, 60, line()), (120, 60, line())]);
    }

    fn slant(range_m: f64, sigma_m: f64) -> BeaconRange {
        BeaconRange {
            beacon: 0,
            range_m,
            sigma_m,
        }
    }

    #[test]
    fn what_hangs_high_is_nearer_on_the_floor() {
        let near = |range: BeaconRange, range_m: f64| (range.range_m - range_m).abs() < 1e-9;
        assert!(near(level(slant(2.5, 0.2), 1.5), 2.0));
        assert!(near(level(slant(1.4, 0.2), 1.5), 0.0), "shorter than it can be");
        assert!((level(slant(2.5, 0.2), 1.5).sigma_m - 0.25).abs() < 1e-9);
        assert!((level(slant(1.5, 0.2), 1.5).sigma_m - 1.5).abs() < 1e-9);
        assert_eq!(level(slant(0.1, 0.2), 0.0).sigma_m, 0.2);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        #[test]
        fn no_bytes_upset_it(
            dwm1001 in any::<bool>(),
            edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 0..12),
            cut in 1..64_usize,
        ) {
            let (form, text) = if dwm1001 {
                (RadioForm::Dwm1001, SHELL)
            } else {
                (RadioForm::Lines, LINES)
            };
            let mut bytes = text.as_bytes().to_vec();
            for (place, byte, manner) in edits {
                let place = place.index(bytes.len());
                match manner {
                    0 => bytes[place] = byte,
                    1 => bytes.insert(place, byte),
                    2 if bytes.len() > 1 => drop(bytes.remove(place)),
                    _ => bytes[place] ^= 1 << (byte % 8),
                }
            }
            bytes.extend_from_slice(text.as_bytes());
            let mut decoder = RadioDecoder::new(&RadioSettings { height_m: 1.0, ..settings(form) });
            let mut signals = Vec::new();
            for piece in bytes.chunks(cut) {
                signals.extend(decoder.take(Duration::ZERO, piece).signals);
            }
            for signal in &signals {
                match signal {
                    BeaconSignal::Range(range) => {
                        prop_assert!((0.0..=200.0).contains(&range.range_m));
                        prop_assert!(range.sigma_m > 0.0 && range.sigma_m.is_finite());
                    }
                    BeaconSignal::Strength(strength) => prop_assert!((-130.0..=0.0).contains(&strength.dbm)),
                }
            }
            // The last lines are complete, whatever precedes them.
            let whole = if dwm1001 { 4 } else { 3 };
            prop_assert!(signals.len() >= whole, "{signals:?}");
        }
    }
}
