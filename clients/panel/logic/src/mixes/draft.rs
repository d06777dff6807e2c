//! A mix that is edited: what it is now, what it was, and what is wrong with it.

use std::collections::BTreeMap;

use mixer::{
    Calibration, Condition, FlightMode, Line, Name, NameError, Output, OutputName, Profile, ProfileError,
    Source, Switch, Trim, VERSION,
};
use rvac_api::RobotDescription;

use super::flight_part::trimmable;
use super::{CalibrationRun, Field, FieldError, Group, MixProblem};
use crate::words::Words;

/// Buttons of the cross of a pad with the standard mapping of the W3C.
const CROSS_LEFT: u8 = 14;
const CROSS_RIGHT: u8 = 15;

/// A mix that is edited.
#[derive(Clone, Debug, PartialEq)]
pub struct MixDraft {
    profile: Profile,
    /// What [`MixDraft::revert`] goes back to.
    base: Profile,
    /// The base is what the robot keeps.
    is_kept: bool,
    /// The person knows that somebody else has saved another one, and saves all the same.
    replaces: bool,
    /// Fields whose text is none, with the reason.
    wrong: BTreeMap<Field, FieldError>,
}

impl MixDraft {
    /// A mix that the robot keeps.
    #[must_use]
    pub fn of_kept(profile: Profile) -> Self {
        Self {
            is_kept: true,
            ..Self::of_new(profile)
        }
    }

    /// A mix that the robot does not keep yet.
    #[must_use]
    pub fn of_new(profile: Profile) -> Self {
        Self {
            base: profile.clone(),
            profile,
            is_kept: false,
            replaces: false,
            wrong: BTreeMap::new(),
        }
    }

    /// A mix that does nothing, under a free name.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn empty(words: &Words, kept: &[Profile]) -> Result<Self, NameError> {
        let outputs = [OutputName::Forward, OutputName::Turn, OutputName::Stop];
        Ok(Self::of_new(Profile {
            version: VERSION,
            name: free_name(words.mix.new_mix, kept)?,
            inputs: Vec::new(),
            switches: Vec::new(),
            trims: Vec::new(),
            modes: Vec::new(),
            outputs: outputs.map(Output::new).into(),
        }))
    }

    /// A copy of a mix, under a free name.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn copy_of(words: &Words, profile: &Profile, kept: &[Profile]) -> Result<Self, NameError> {
        Ok(Self::of_new(Profile {
            name: free_name(words.mix.my_mix, kept)?,
            ..profile.clone()
        }))
    }

    /// A mix from a file.
    ///
    /// # Errors
    /// The mixer's sentence about what is wrong, where, and what to do.
    pub fn import(text: &str) -> Result<Self, ProfileError> {
        Profile::parse(text).map(Self::of_new)
    }

    /// What it is now.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Whether the robot keeps something else.
    #[must_use]
    pub fn is_unsaved(&self) -> bool {
        !self.is_kept || self.is_changed()
    }

    /// Whether there is something to go back from.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.profile != self.base || !self.wrong.is_empty()
    }

    /// Goes back to what it was at first, or when it was kept last.
    pub fn revert(&mut self) {
        self.profile = self.base.clone();
        self.wrong.clear();
    }

    /// The robot keeps it as it was sent.
    pub fn on_kept(&mut self, sent: Profile) {
        self.base = sent;
        self.is_kept = true;
        self.replaces = false;
    }

    /// What the robot kept under the name of the mix when its change began, as JSON text, empty for nothing; none when it shall be replaced
    /// whatever it is.
    #[must_use]
    pub fn was(&self) -> Option<String> {
        if self.replaces {
            return None;
        }
        let is_same = self.is_kept && self.base.name == self.profile.name;
        Some(if is_same {
            self.base.to_json()
        } else {
            String::new()
        })
    }

    /// The next save replaces what the robot keeps under the name, whatever that is.
    pub fn replace_whatever_is_kept(&mut self) {
        self.replaces = true;
    }

    /// The robot keeps it no more.
    pub fn on_removed(&mut self) {
        self.is_kept = false;
    }

    /// A person wrote this into a field.
    pub fn set(&mut self, field: Field, text: &str) {
        match field.set(&mut self.profile, text) {
            Ok(()) => self.wrong.remove(&field),
            Err(error) => self.wrong.insert(field, error),
        };
    }

    /// What is wrong with a field.
    #[must_use]
    pub fn problem_of(&self, field: Field) -> Option<MixProblem> {
        if let Some(error) = self.wrong.get(&field) {
            return Some(MixProblem::Field(error.clone()));
        }
        let place = field.place(&self.profile);
        self.problem_at(&place)
    }

    /// What is wrong with a group as a whole.
    #[must_use]
    pub fn problem_with(&self, group: Group) -> Option<MixProblem> {
        self.problem_at(&group.place(&self.profile))
    }

    fn problem_at(&self, place: &str) -> Option<MixProblem> {
        let error = self.profile.check().err()?;
        (!place.is_empty() && error.place() == Some(place)).then_some(MixProblem::Profile(error))
    }

    /// The first thing that is wrong; with it, nothing can be saved.
    #[must_use]
    pub fn problem(&self) -> Option<MixProblem> {
        let field = self.wrong.values().next().cloned().map(MixProblem::Field);
        field.or_else(|| self.profile.check().err().map(MixProblem::Profile))
    }

    /// Adds a line to an output.
    ///
    /// # Errors
    /// Never: the name is one.
    pub fn add_line(&mut self, words: &Words, output: usize) -> Result<(), NameError> {
        let name = Name::new(words.mix.new_line)?;
        if let Some(output) = self.profile.outputs.get_mut(output) {
            output
                .lines
                .push(Line::new(name, Source::PadAxis { pad: 0, axis: 0 }));
        }
        Ok(())
    }

    /// Adds an output.
    pub fn add_output(&mut self, name: OutputName) {
        if !self.has_output(name) {
            self.profile.outputs.push(Output::new(name));
        }
    }

    /// Outputs that the mix does not have yet and that mean something to the robot.
    #[must_use]
    pub fn free_outputs(&self, robot: Option<&RobotDescription>) -> Vec<OutputName> {
        OutputName::ALL
            .into_iter()
            .filter(|name| !self.has_output(*name) && robot_has(*name, robot))
            .collect()
    }

    fn has_output(&self, name: OutputName) -> bool {
        self.profile.outputs.iter().any(|output| output.output == name)
    }

    /// Adds a switch.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn add_switch(&mut self, words: &Words) -> Result<(), NameError> {
        let taken = |name: &Name| self.profile.switches.iter().any(|switch| switch.name == *name);
        let name = numbered(words.mix.new_switch, taken)?;
        let input = Source::PadButton { pad: 0, button: 0 };
        let on = Condition::Above { input, level: 0.5 };
        self.profile.switches.push(Switch { name, on });
        Ok(())
    }

    /// Adds a trim, of the first output that can have one and has none.
    pub fn add_trim(&mut self) {
        let is_free = |output: &OutputName| self.profile.trims.iter().all(|trim| trim.output != *output);
        let turn_first = [OutputName::Turn].into_iter().chain(trimmable());
        if let Some(output) = turn_first.into_iter().find(is_free) {
            let button = |button| Source::PadButton { pad: 0, button };
            self.profile.trims.push(Trim {
                output,
                up: button(CROSS_LEFT),
                down: button(CROSS_RIGHT),
                step: 0.01,
                value: 0.0,
            });
        }
    }

    /// Adds a flight mode on the first switch.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn add_mode(&mut self, words: &Words) -> Result<(), NameError> {
        if self.profile.switches.is_empty() {
            self.add_switch(words)?;
        }
        let taken = |name: &Name| self.profile.modes.iter().any(|mode| mode.name == *name);
        let name = numbered(words.mix.new_mode, taken)?;
        if let Some(switch) = self.profile.switches.first() {
            self.profile.modes.push(FlightMode {
                name,
                when: switch.name.clone(),
                fade_ms: 0,
                trims: Vec::new(),
            });
        }
        Ok(())
    }

    /// Takes trims as they were set while driving, where the mix still has them.
    pub fn take_trims(&mut self, flown: &Profile) {
        for trim in &mut self.profile.trims {
            let found = flown.trims.iter().find(|other| other.output == trim.output);
            trim.value = found.map_or(trim.value, |other| other.value);
        }
        for mode in &mut self.profile.modes {
            let found = flown.modes.iter().find(|other| other.name == mode.name);
            for own in &mut mode.trims {
                let values = found.into_iter().flat_map(|other| &other.trims);
                let value = values
                    .filter(|other| other.output == own.output)
                    .map(|other| other.value);
                own.value = value.last().unwrap_or(own.value);
            }
        }
    }

    /// Adds a calibration, of the first axis that has none.
    pub fn add_input(&mut self) {
        let axes = (0..16).map(|axis| Source::PadAxis { pad: 0, axis });
        let free = axes
            .into_iter()
            .find(|axis| self.profile.calibration(axis).is_none());
        let input = free.unwrap_or(Source::TouchUp);
        self.profile.inputs.push(Calibration::new(input, 0.1));
    }

    /// Takes over what a calibration has seen.
    ///
    /// # Errors
    /// A sentence when the input was not moved.
    pub fn calibrate(&mut self, words: &Words, run: &CalibrationRun) -> Result<(), String> {
        let mut seen = run.finish(words)?;
        if let Some(input) = self.profile.inputs.get_mut(run.place) {
            seen.dead_band = input.dead_band;
            *input = seen;
        }
        Ok(())
    }

    /// Removes an output, a line, a switch or a calibration.
    pub fn remove(&mut self, group: Group) {
        // What was wrong has other numbers now, or is gone; texts are read again from the profile.
        self.wrong.clear();
        match group {
            Group::Output(output) => remove(&mut self.profile.outputs, output),
            Group::Line(output, line) => {
                if let Some(output) = self.profile.outputs.get_mut(output) {
                    remove(&mut output.lines, line);
                }
            }
            Group::Switch(switch) => remove(&mut self.profile.switches, switch),
            Group::Trim(trim) => remove(&mut self.profile.trims, trim),
            Group::Mode(mode) => remove(&mut self.profile.modes, mode),
            Group::Input(input) => remove(&mut self.profile.inputs, input),
        }
    }

    /// Moves a line, a switch or a flight mode before the one before it, which it may refer to, or yields to.
    pub fn move_up(&mut self, group: Group) {
        self.wrong.clear();
        match group {
            Group::Line(output, line) => {
                if let Some(output) = self.profile.outputs.get_mut(output) {
                    move_up(&mut output.lines, line);
                }
            }
            Group::Switch(switch) => move_up(&mut self.profile.switches, switch),
            Group::Mode(mode) => move_up(&mut self.profile.modes, mode),
            Group::Output(_) | Group::Trim(_) | Group::Input(_) => {}
        }
    }
}

/// Whether the robot has what an output moves; a robot that is not known yet is taken to have all.
#[must_use]
pub fn robot_has(name: OutputName, robot: Option<&RobotDescription>) -> bool {
    match (name.part(), robot) {
        (Some(part), Some(robot)) => robot.parts.iter().any(|has| has == part),
        (None, _) | (_, None) => true,
    }
}

fn remove<T>(all: &mut Vec<T>, place: usize) {
    if place < all.len() {
        all.remove(place);
    }
}

fn move_up<T>(all: &mut [T], place: usize) {
    if (1..all.len()).contains(&place) {
        all.swap(place - 1, place);
    }
}

fn free_name(stem: &str, kept: &[Profile]) -> Result<Name, NameError> {
    numbered(stem, |name| kept.iter().any(|profile| profile.name == *name))
}

/// The stem, or the stem with the first number that is free.
fn numbered(stem: &str, taken: impl Fn(&Name) -> bool) -> Result<Name, NameError> {
    let mut name = Name::new(stem)?;
    let mut number = 2_u32;
    while taken(&name) {
        name = Name::new(&format!("{stem} {number}"))?;
        number += 1;
    }
    Ok(name)
}
