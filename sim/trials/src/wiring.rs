//! Boards with one mistake each: a wire cut, two exchanged, a level inverted, a sensor that is a fifth off. Who notices?
//!
//! The firmware's constants and its calibration record stay those of the right board, so the mistake is the robot's. A mistake
//! counts as noticed when a robot does not get into an operating state, when a trial of a safety rule is not kept, or when the
//! monitor sees a breach. What robots that nobody has calibrated differ by is no mistake: those deviations must be stood.

use std::collections::BTreeSet;

use pic32::board::pinout::{Miswiring, Pinout};
use pic32::board::{CYCLES_PER_MS, CalibrationValues, Particulars};
use serde::Serialize;

use crate::scene::OperatingState;
use crate::testbed::{Fixture, Testbed, TestbedError};
use crate::trial::Trial;

/// A pin of the chip that ends nowhere, and one more for inputs of the converter.
const NOWHERE: &str = "spare-ra0";
const NOWHERE_ANALOG: &str = "linux-board-11";

/// Digital lines that a safety rule or the motion rests on.
const DIGITAL: [&str; 22] = [
    "bumper-left",
    "bumper-right",
    "wheel-drop-left",
    "wheel-drop-right",
    "button-any",
    "wheel-left-enable",
    "wheel-left-mode",
    "wheel-left-phase",
    "wheel-right-enable",
    "wheel-right-mode",
    "wheel-right-phase",
    "brush-main-enable",
    "brush-main-phase",
    "brush-main-encoder",
    "brush-sides",
    "vacuum",
    "proximity-emit",
    "light-supply-unknown",
    "adapter",
    "charge-enable",
    "proximity-select-a",
    "proximity-select-b",
];

/// Lines without a level of their own: they can only be cut.
const ENCODERS: [&str; 4] = [
    "wheel-left-encoder-1",
    "wheel-left-encoder-2",
    "wheel-right-encoder-1",
    "wheel-right-encoder-2",
];

/// Inputs of the converter.
const ANALOG: [&str; 9] = [
    "button-ladder",
    "wheel-left-current",
    "wheel-right-current",
    "cliff-left",
    "cliff-middle",
    "cliff-right",
    "battery-voltage",
    "charger-voltage",
    "battery-thermistor",
];

/// Wires that a person exchanges: they are neighbours, or look alike.
const EXCHANGED: [[&str; 2]; 14] = [
    ["bumper-left", "bumper-right"],
    ["wheel-drop-left", "wheel-drop-right"],
    ["wheel-left-encoder-1", "wheel-left-encoder-2"],
    ["wheel-right-encoder-1", "wheel-right-encoder-2"],
    ["wheel-left-encoder-1", "wheel-right-encoder-1"],
    ["wheel-left-enable", "wheel-right-enable"],
    ["wheel-left-phase", "wheel-right-phase"],
    ["wheel-left-phase", "wheel-left-mode"],
    ["wheel-left-current", "wheel-right-current"],
    ["brush-main-enable", "brush-main-phase"],
    ["brush-sides", "vacuum"],
    ["cliff-left", "cliff-right"],
    ["battery-voltage", "charger-voltage"],
    ["battery-voltage", "battery-thermistor"],
];

/// A value of the board that is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// Microamperes a count of the wheels' current.
    CurrentScale,
    /// Reading of the wheels' current lines without current.
    CurrentZero,
    /// Microvolts a count of the battery's divider.
    BatteryScale,
    /// The thermistor's resistance.
    Thermistor,
    /// Light at one of the cliff receivers.
    CliffLight(usize),
    /// Pulses a second of the main brush.
    BrushPulses,
    /// Readings of the buttons' ladder.
    Ladder,
    /// Light at the proximity sensors.
    Proximity,
}

impl Deviation {
    const ALL: [Self; 10] = [
        Self::CurrentScale,
        Self::CurrentZero,
        Self::BatteryScale,
        Self::Thermistor,
        Self::CliffLight(0),
        Self::CliffLight(1),
        Self::CliffLight(2),
        Self::BrushPulses,
        Self::Ladder,
        Self::Proximity,
    ];

    /// Trials that would notice it.
    const fn noticers(self) -> &'static [&'static str] {
        match self {
            Self::CurrentScale | Self::CurrentZero => {
                &["wheel-over-current", "wheel-standstill", "nothing-happens"]
            }
            Self::BatteryScale => &["nothing-happens", "pack-empty", "pack-weak"],
            Self::Thermistor => &["nothing-happens", "pack-hot"],
            Self::CliffLight(_) => &[
                "cliff-left",
                "cliff-middle",
                "cliff-right-turning",
                "cliff-receiver-sticks-middle",
            ],
            Self::BrushPulses => &["cable-cut-cleaners", "nothing-happens"],
            Self::Ladder => &["button-named", "button"],
            Self::Proximity => &["something-near", "nothing-happens"],
        }
    }

    /// The board with this value times `factor`.
    fn times(self, factor: f64, mut board: Particulars) -> Particulars {
        let scaled = |value: i32| (f64::from(value) * factor).round() as i32;
        match self {
            Self::CurrentScale => board.current_scale = scaled(board.current_scale),
            Self::CurrentZero => board.current_zero = board.current_zero.map(scaled),
            Self::BatteryScale => board.battery_scale = scaled(board.battery_scale),
            Self::Thermistor => board.thermistor.room_kohm *= factor,
            Self::CliffLight(number) => {
                if let Some(gain) = board.cliff_gain.get_mut(number) {
                    *gain *= factor;
                }
            }
            Self::BrushPulses => board.brush_pulses_per_s *= factor,
            Self::Ladder => board.ladder = board.ladder.map(|level| scaled(i32::from(level)) as u16),
            Self::Proximity => board.proximity = board.proximity.map(scaled),
        }
        board
    }
}

/// What is wrong with a board.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// Nothing: what the trials say of the right board.
    Nothing,
    /// Its wiring.
    Wiring(Miswiring),
    /// A value, by this factor.
    Value(Deviation, f64),
}

/// What must come of a mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Demand {
    /// Somebody must notice it.
    Noticed,
    /// The rules are built to stand it, because robots that nobody has calibrated differ by as much: each trial must be kept.
    Stood,
}

/// Signals and the trials that can notice that something is wrong with them: their operating state alone may be enough.
const NOTICERS: [(&str, &[&str]); 22] = [
    ("bumper", &["bumper-left", "bumper-right"]),
    ("wheel-drop", &["wheel-drop-left", "wheel-drop-right"]),
    ("button-any", &["button"]),
    ("button-ladder", &["button-named"]),
    ("wheel-left-current", &["wheel-over-current", "nothing-happens"]),
    (
        "wheel-right-current",
        &["wheel-over-current-right", "nothing-happens"],
    ),
    (
        "encoder-",
        &["silence-wheels", "cliff-right-turning", "nothing-happens"],
    ),
    (
        "-enable",
        &["cable-cut-cleaners", "one-wheel", "cliff-right-turning"],
    ),
    (
        "-phase",
        &["cable-cut-cleaners", "cliff-right-turning", "bumper-held-backing"],
    ),
    (
        "-mode",
        &[
            "cable-cut-cleaners",
            "stop",
            "bumper-held-backing",
            "nothing-happens",
        ],
    ),
    ("brush-main-encoder", &["nothing-happens"]),
    ("brush-sides", &["cable-cut-cleaners", "suction-alone"]),
    ("vacuum", &["cable-cut-cleaners", "suction-alone"]),
    ("cliff-left", &["cliff-left"]),
    ("cliff-middle", &["cliff-middle"]),
    ("cliff-right", &["cliff-left", "cliff-right-turning"]),
    ("proximity", &["something-near"]),
    ("light-supply-unknown", &["cliff-left"]),
    (
        "battery-voltage",
        &["pack-low", "nothing-happens", "leaving-runs-out"],
    ),
    ("battery-thermistor", &["nothing-happens", "pack-hot"]),
    ("charge", &["leaving-runs-out", "switch-shorted"]),
    ("adapter", &["contacts-close", "leaving-runs-out"]),
];

impl Mistake {
    /// All of them.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let cut = |names: &'static [&'static str], nowhere| {
            names
                .iter()
                .map(move |name| Self::Wiring(Miswiring::Swapped(name, nowhere)))
        };
        let inverted = DIGITAL.iter().map(|name| Self::Wiring(Miswiring::Inverted(name)));
        let exchanged = EXCHANGED
            .iter()
            .map(|[one, other]| Self::Wiring(Miswiring::Swapped(one, other)));
        let values = Deviation::ALL
            .iter()
            .flat_map(|value| [0.8, 1.2].map(|factor| Self::Value(*value, factor)));
        std::iter::once(Self::Nothing)
            .chain(cut(&DIGITAL, NOWHERE))
            .chain(cut(&ENCODERS, NOWHERE))
            .chain(cut(&ANALOG, NOWHERE_ANALOG))
            .chain(inverted)
            .chain(exchanged)
            .chain(values)
            .collect()
    }

    /// In words.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Nothing => "the right board".to_owned(),
            Self::Wiring(Miswiring::Swapped(name, NOWHERE | NOWHERE_ANALOG)) => format!("{name} is cut"),
            Self::Wiring(Miswiring::Swapped(one, other)) => format!("{one} and {other} are exchanged"),
            Self::Wiring(Miswiring::Inverted(name)) => format!("{name} is inverted"),
            Self::Value(value, factor) => format!("{value:?} times {factor}"),
        }
    }

    /// What must come of it.
    #[must_use]
    pub const fn demand(&self) -> Demand {
        match self {
            Self::Nothing
            | Self::Value(
                Deviation::CurrentScale
                | Deviation::CurrentZero
                | Deviation::CliffLight(_)
                | Deviation::BrushPulses
                | Deviation::Proximity,
                _,
            ) => Demand::Stood,
            Self::Wiring(_)
            | Self::Value(Deviation::BatteryScale | Deviation::Thermistor | Deviation::Ladder, _) => {
                Demand::Noticed
            }
        }
    }

    /// Trials that can notice it, the likeliest first.
    #[must_use]
    pub fn noticers(&self) -> Vec<&'static str> {
        let of_signal = |name: &str| {
            let fitting = NOTICERS.iter().filter(move |(part, _)| name.contains(part));
            fitting
                .flat_map(|(_, trials)| *trials)
                .copied()
                .collect::<Vec<_>>()
        };
        match self {
            Self::Nothing => {
                let all = NOTICERS.iter().flat_map(|(_, trials)| *trials).copied();
                BTreeSet::from_iter(all).into_iter().collect()
            }
            Self::Wiring(Miswiring::Swapped(one, NOWHERE | NOWHERE_ANALOG) | Miswiring::Inverted(one)) => {
                of_signal(one)
            }
            Self::Wiring(Miswiring::Swapped(one, other)) => [of_signal(one), of_signal(other)].concat(),
            Self::Value(value, _) => value.noticers().to_vec(),
        }
    }

    fn made(&self, fixture: &Fixture) -> Result<Fixture, TestbedError> {
        let right = Pinout::sr8730()?;
        let particulars = Particulars::of(&CalibrationValues::sr8730()?)?;
        match self {
            Self::Nothing => fixture.clone().in_board(&right, particulars),
            Self::Wiring(mistake) => fixture.clone().in_board(&right.miswired(mistake), particulars),
            Self::Value(value, factor) => fixture
                .clone()
                .in_board(&right, value.times(*factor, particulars)),
        }
    }
}

/// What came of a mistake.
#[derive(Clone, Debug, Serialize)]
pub struct Noticed {
    /// The mistake.
    pub mistake: String,
    /// What had to come of it.
    pub demand: Demand,
    /// The first that noticed: a trial that was not kept, or the operating state that was not reached; `None` = nobody.
    pub by: Option<String>,
    /// Trials that were run.
    pub tried: usize,
}

impl Noticed {
    /// Whether it is as it must be.
    #[must_use]
    pub const fn is_good(&self) -> bool {
        match self.demand {
            Demand::Noticed => self.by.is_some(),
            Demand::Stood => self.by.is_none(),
        }
    }
}

/// Runs these trials on robots with the mistake, one moment each, until somebody notices it.
#[must_use]
pub fn notice(fixture: &Fixture, mistake: &Mistake, trials: &[Trial], seed: u64) -> Noticed {
    let mut tried = 0;
    let by = match mistake.made(fixture) {
        Err(error) => Some(error.to_string()),
        Ok(wrong) => {
            let mut robots = Vec::new();
            trials.iter().find_map(|trial| {
                tried += 1;
                broken(&wrong, &mut robots, trial, seed)
            })
        }
    };
    Noticed {
        mistake: mistake.name(),
        demand: mistake.demand(),
        by,
        tried,
    }
}

/// Robots in operating states that one trial has asked for already.
type Robots = Vec<(OperatingState, Testbed)>;

/// How the trial is not kept on such a robot, if it is not.
fn broken(fixture: &Fixture, robots: &mut Robots, trial: &Trial, seed: u64) -> Option<String> {
    let known = robots.iter().position(|(scene, _)| *scene == trial.scene);
    let place = match known {
        Some(place) => place,
        // An even number: a robot whose thermistor was measured reaches every state.
        None => match trial.scene.set(fixture, 2, seed % CYCLES_PER_MS) {
            Err(error) => return Some(format!("{}: {error}", trial.name)),
            Ok(testbed) => {
                robots.push((trial.scene, testbed));
                robots.len() - 1
            }
        },
    };
    let testbed = robots.get(place)?.1.clone();
    let before = testbed.robot().monitor().count() as usize;
    let (outcome, after) = trial.watch(testbed, seed.wrapping_mul(7_919) % CYCLES_PER_MS);
    let breach = after.robot().monitor().violations().get(before);
    match (breach, trial.is_kept(&outcome)) {
        (Some(breach), _) => Some(format!("{}: {breach}", trial.name)),
        (None, false) => Some(trial.name.to_owned()),
        (None, true) => None,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use pic32::board::pinout::Pinout;
    use pic32::board::{CalibrationValues, Particulars};

    use super::Mistake;

    #[test]
    fn each_mistake_makes_another_board() {
        let right = Pinout::sr8730().unwrap();
        let particulars = Particulars::of(&CalibrationValues::sr8730().unwrap()).unwrap();
        for mistake in Mistake::all() {
            match &mistake {
                Mistake::Nothing => {}
                Mistake::Wiring(wrong) => assert_ne!(right.miswired(wrong), right, "{}", mistake.name()),
                Mistake::Value(value, factor) => {
                    assert_ne!(
                        value.times(*factor, particulars),
                        particulars,
                        "{}",
                        mistake.name()
                    );
                }
            }
        }
    }

    #[test]
    fn for_each_there_are_trials_that_can_notice_it() {
        let known: BTreeSet<&str> = crate::trials().iter().map(|trial| trial.name).collect();
        for mistake in Mistake::all() {
            let noticers = mistake.noticers();
            assert!(!noticers.is_empty(), "{}", mistake.name());
            assert!(noticers.iter().all(|name| known.contains(name)), "{noticers:?}");
        }
    }

    #[test]
    fn no_two_have_the_same_name() {
        let all = Mistake::all();
        let names: BTreeSet<String> = all.iter().map(Mistake::name).collect();
        assert_eq!(names.len(), all.len());
    }
}
