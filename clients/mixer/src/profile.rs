//! A profile: all that a person has set, as one JSON object.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::check::{self, ProfileError};
use crate::{Device, FlightMode, Line, Name, Output, Source, Switch, Trim};

/// Version of the form of profiles. Raised when a key changes its meaning; this program reads only its own.
pub const VERSION: u32 = 1;

/// How an input reads, for one that is not read as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Calibration {
    /// Which.
    pub input: Source,
    /// Reading at its lower end.
    pub low: f64,
    /// Reading at rest.
    pub centre: f64,
    /// Reading at its upper end.
    pub high: f64,
    /// Dead band: the share of the range to an end that counts as rest, 0..=0.9.
    pub dead_band: f64,
}

impl Calibration {
    /// An input that reads -1..=1.
    #[must_use]
    pub const fn new(input: Source, dead_band: f64) -> Self {
        Self {
            input,
            low: -1.0,
            centre: 0.0,
            high: 1.0,
            dead_band,
        }
    }

    /// From what the device reads to -1..=1, 0 at rest and in the dead band around it.
    #[must_use]
    pub fn apply(&self, raw: f64) -> f64 {
        let reach = if raw < self.centre {
            self.centre - self.low
        } else {
            self.high - self.centre
        };
        // A trigger rests at one of its ends, and there is no travel beyond it.
        if reach <= 0.0 {
            return 0.0;
        }
        let share = ((raw - self.centre) / reach).clamp(-1.0, 1.0);
        let live = (share.abs() - self.dead_band) / (1.0 - self.dead_band);
        share.signum() * live.max(0.0)
    }
}

/// A profile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Profile {
    /// [`VERSION`].
    pub version: u32,
    /// Its name.
    pub name: Name,
    /// Inputs that are not read as they are.
    #[serde(default)]
    pub inputs: Vec<Calibration>,
    /// Switches. Each may refer to those before it.
    #[serde(default)]
    pub switches: Vec<Switch>,
    /// Trims, each output at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trims: Vec<Trim>,
    /// Flight modes; the first whose switch is on holds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<FlightMode>,
    /// Outputs, each at most once.
    pub outputs: Vec<Output>,
}

impl Profile {
    /// Reads and checks a profile.
    ///
    /// # Errors
    /// [`ProfileError`]: what is wrong, where, and what to do.
    pub fn parse(text: &str) -> Result<Self, ProfileError> {
        check::parse(text)
    }

    /// Checks a profile that was put together or changed.
    ///
    /// # Errors
    /// [`ProfileError`]: what is wrong, where, and what to do.
    pub fn check(&self) -> Result<(), ProfileError> {
        check::check(self)
    }

    /// The profile as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("plain types without maps can be written")
    }

    /// The profile as JSON for people.
    #[must_use]
    pub fn to_pretty_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain types without maps can be written")
    }

    /// The inputs of all lines, switches and trims, in their order.
    pub fn sources(&self) -> impl Iterator<Item = &Source> {
        let lines = self.outputs.iter().flat_map(|output| &output.lines);
        let conditions = self.switches.iter().filter_map(|switch| switch.on.input());
        let buttons = self.trims.iter().flat_map(|trim| [&trim.up, &trim.down]);
        lines.map(|line| &line.input).chain(conditions).chain(buttons)
    }

    /// The devices by which a person holds a line: that of its input, or those that switch it on.
    #[must_use]
    pub fn devices_of(&self, line: &Line) -> BTreeSet<Device> {
        match (&line.input, &line.when) {
            (Source::Switch(name), _) | (Source::Always, Some(name)) => self.devices_of_switch(name),
            (Source::Always, None) => {
                let modes = self.modes.iter().filter(|mode| line.modes.contains(&mode.name));
                modes
                    .flat_map(|mode| self.devices_of_switch(&mode.when))
                    .collect()
            }
            (input, _) => input.device().into_iter().collect(),
        }
    }

    /// Each switch refers only to those before it, so this ends.
    fn devices_of_switch(&self, name: &Name) -> BTreeSet<Device> {
        let Some(switch) = self.switches.iter().find(|switch| switch.name == *name) else {
            return BTreeSet::new();
        };
        let own = switch.on.input().and_then(Source::device);
        let others = switch.on.switches().into_iter();
        let others = others.flat_map(|name| self.devices_of_switch(name));
        own.into_iter().chain(others).collect()
    }

    /// How an input is read.
    #[must_use]
    pub fn calibration(&self, source: &Source) -> Option<&Calibration> {
        self.inputs
            .iter()
            .find(|calibration| calibration.input == *source)
    }
}
