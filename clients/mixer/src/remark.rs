//! What a person reads who drives in a terminal: when the inputs begin or cease to count, and which of them stand in the way.

use std::collections::BTreeSet;
use std::fmt;

use rvac_api::{Explanation, explain};

use crate::{AwayFromRest, MixState, Source, Steered, TrimValue};

/// Name of the reason why a pushed pad that says nothing stops the wheels.
const PAD_SILENT: &str = "pad-silent";
/// Inputs that are not at rest are named this often at most.
const NAMED_EVERY_US: u64 = 1_000_000;

/// A line for the person.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// The inputs count.
    Ready,
    /// They do not count until all are at rest.
    WaitsForRest,
    /// This pad is pushed and says nothing more.
    PadSilent(u8),
    /// These inputs are not at rest.
    NotAtRest(Vec<AwayFromRest>),
    /// A trim was set.
    Trimmed(TrimValue),
}

impl fmt::Display for Remark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ready => formatter.write_str("ready"),
            Self::WaitsForRest => formatter.write_str("waits until every input is at rest"),
            Self::PadSilent(pad) => {
                let why = explain(PAD_SILENT).map(Explanation::text).unwrap_or_default();
                write!(formatter, "pad-{pad} is silent ({PAD_SILENT}): {why}")
            }
            Self::Trimmed(trim) => write!(formatter, "trim of {}: {:+.1} %", trim.output, 100.0 * trim.value),
            Self::NotAtRest(inputs) => {
                let readings: Vec<String> = inputs
                    .iter()
                    .map(|away| format!("{} reads {:.2}", away.input, away.reading))
                    .collect();
                write!(
                    formatter,
                    "not at rest: {} (if nobody touches it, calibrate it in the mix)",
                    readings.join(", ")
                )
            }
        }
    }
}

/// Remarks on what is steered; nothing is said twice while it stays as it is.
#[derive(Clone, Debug, Default)]
pub struct Remarks {
    /// Pads of which the person knows that they are silent.
    silent_pads: BTreeSet<u8>,
    state: Option<MixState>,
    named_us: u64,
    named: Vec<Source>,
    trims: Vec<TrimValue>,
}

impl Remarks {
    /// What is new to the person at this moment.
    pub fn on(&mut self, now_us: u64, steered: &Steered) -> Vec<Remark> {
        let silent = steered.silent_pads.difference(&self.silent_pads);
        let mut remarks: Vec<Remark> = silent.map(|pad| Remark::PadSilent(*pad)).collect();
        self.silent_pads.clone_from(&steered.silent_pads);
        let mixed = &steered.mixed;
        if self.state.replace(mixed.state) != Some(mixed.state) {
            self.named.clear();
            remarks.push(match mixed.state {
                MixState::Live => Remark::Ready,
                MixState::Failsafe => Remark::WaitsForRest,
            });
        }
        let set = mixed.trims.iter().filter(|trim| {
            let before = self.trims.iter().find(|before| before.output == trim.output);
            before.is_some_and(|before| before.value != trim.value)
        });
        remarks.extend(set.copied().map(Remark::Trimmed));
        self.trims.clone_from(&mixed.trims);
        let named: Vec<Source> = mixed.away.iter().map(|away| away.input.clone()).collect();
        let is_soon = now_us.saturating_sub(self.named_us) < NAMED_EVERY_US;
        if !named.is_empty() && named != self.named && !is_soon {
            (self.named_us, self.named) = (now_us, named);
            remarks.push(Remark::NotAtRest(mixed.away.clone()));
        }
        remarks
    }
}

#[cfg(test)]
mod tests {
    use super::Remarks;
    use crate::{Mixer, PAD_SILENT_US, Pilot, Readings, STEP_EVERY_US, TopSpeeds};

    struct Person {
        pilot: Pilot,
        remarks: Remarks,
        readings: Readings,
        now_us: u64,
    }

    impl Person {
        /// Turns a stick, and keeps it there for so many steps; gives the lines that are read meanwhile.
        fn turn(&mut self, across: f64, steps: u64) -> Vec<String> {
            let mut lines = Vec::new();
            self.readings
                .set(&"pad-0-axis-0".parse().expect("an input"), across);
            let top = TopSpeeds {
                forward_m_per_s: 0.3,
                turn_rad_per_s: 1.0,
            };
            for _ in 0..steps {
                self.now_us += STEP_EVERY_US;
                let steered = self.pilot.step(self.now_us, &self.readings, top);
                lines.extend(
                    self.remarks
                        .on(self.now_us, &steered)
                        .iter()
                        .map(ToString::to_string),
                );
            }
            lines
        }
    }

    #[test]
    fn each_thing_is_said_once_while_it_stays() {
        let mut person = Person {
            pilot: Pilot::new(Mixer::standard()),
            remarks: Remarks::default(),
            readings: Readings::default(),
            now_us: 1_000_000,
        };
        let steps = PAD_SILENT_US / STEP_EVERY_US;
        assert_eq!(
            person.turn(0.6, steps / 2),
            [
                "waits until every input is at rest",
                "not at rest: pad-0-axis-0 reads 0.60 (if nobody touches it, calibrate it in the mix)",
            ]
        );
        assert_eq!(person.turn(0.0, 10), ["ready"]);
        assert_eq!(person.turn(0.6, 10), [] as [&str; 0], "it is heard");
        let silent = person.turn(0.6, 2 * steps);
        assert!(
            silent[0].starts_with("pad-0 is silent (pad-silent): The gamepad is pushed"),
            "{silent:?}"
        );
        let is_silence = |line: &&String| line.contains("pad-silent");
        assert_eq!(silent.iter().filter(is_silence).count(), 1, "{silent:?}");
    }
}
