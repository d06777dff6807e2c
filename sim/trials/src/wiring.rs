//! Boards with one mistake each: a wire cut, two exchanged, a level inverted, a sensor that is a fifth off. Who notices?
//!
//! The firmware's constants and its calibration record stay those of the right board, so the mistake is the robot's. A mistake
//! counts as noticed when a robot does not get into an operating state, when a trial of a safety rule is not kept, or when the
//! monitor sees a breach.

use pic32::board::pinout::{Miswiring, Pinout};
use pic32::board::{CalibrationValues, Particulars};
use rayon::prelude::*;
use serde::Serialize;

use crate::campaign::Campaign;
use crate::testbed::{Fixture, TestbedError};
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
    /// Its wiring.
    Wiring(Miswiring),
    /// A value, by this factor.
    Value(Deviation, f64),
}

impl Mistake {
    /// All of them.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let cut = |names: &'static [&str], nowhere| {
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
        cut(&DIGITAL, NOWHERE)
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
            Self::Wiring(Miswiring::Swapped(name, NOWHERE | NOWHERE_ANALOG)) => format!("{name} is cut"),
            Self::Wiring(Miswiring::Swapped(one, other)) => format!("{one} and {other} are exchanged"),
            Self::Wiring(Miswiring::Inverted(name)) => format!("{name} is inverted"),
            Self::Value(value, factor) => format!("{value:?} times {factor}"),
        }
    }

    fn made(&self, fixture: &Fixture) -> Result<Fixture, TestbedError> {
        let right = Pinout::sr8730()?;
        let particulars = Particulars::of(&CalibrationValues::sr8730()?)?;
        match self {
            Self::Wiring(mistake) => fixture.clone().in_board(&right.miswired(mistake), particulars),
            Self::Value(value, factor) => fixture
                .clone()
                .in_board(&right, value.times(*factor, particulars)),
        }
    }
}

/// Who noticed a mistake.
#[derive(Clone, Debug, Serialize)]
pub struct Noticed {
    /// The mistake.
    pub mistake: String,
    /// States that the robot did not get into and trials that were not kept, of the first that noticed; empty = nobody.
    pub by: Vec<String>,
}

/// Trials that are tried together: when some of them notice a mistake, the rest is not asked.
const TOGETHER: usize = 8;

/// Tries a mistake at this number of moments of each trial, until somebody notices it.
#[must_use]
pub fn notice(fixture: &Fixture, mistake: &Mistake, trials: &[Trial], phases: usize) -> Noticed {
    let by = match mistake.made(fixture) {
        Ok(wrong) => trials
            .chunks(TOGETHER)
            .map(|some| {
                some.par_iter()
                    .filter_map(|trial| broken(&wrong, trial, phases))
                    .collect()
            })
            .find(|by: &Vec<String>| !by.is_empty())
            .unwrap_or_default(),
        Err(error) => vec![error.to_string()],
    };
    Noticed {
        mistake: mistake.name(),
        by,
    }
}

/// How the trial is not kept on these robots.
fn broken(fixture: &Fixture, trial: &Trial, phases: usize) -> Option<String> {
    match Campaign::open(fixture, std::slice::from_ref(trial), phases) {
        Err(error) => Some(format!("{}: {error}", trial.name)),
        Ok(campaign) => {
            let summary = campaign.judge(trial, phases, 1);
            (!summary.is_kept()).then(|| trial.name.to_owned())
        }
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
    fn no_two_have_the_same_name() {
        let all = Mistake::all();
        let names: BTreeSet<String> = all.iter().map(Mistake::name).collect();
        assert_eq!(names.len(), all.len());
    }
}
