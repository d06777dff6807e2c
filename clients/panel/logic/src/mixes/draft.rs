//! A mix that is edited: what it is now, what it was, and what is wrong with it.

use std::collections::BTreeMap;

use mixer::{
    Calibration, Condition, Line, Name, NameError, Output, OutputName, Profile, ProfileError, Source, Switch,
    VERSION,
};

use super::{CalibrationRun, Field, Group};

/// A mix that is edited.
#[derive(Clone, Debug, PartialEq)]
pub struct MixDraft {
    profile: Profile,
    /// What [`MixDraft::revert`] goes back to.
    base: Profile,
    /// The base is what the robot keeps.
    is_kept: bool,
    /// Fields whose text is none, with the reason.
    wrong: BTreeMap<Field, String>,
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
            wrong: BTreeMap::new(),
        }
    }

    /// A mix that does nothing, under a free name.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn empty(kept: &[Profile]) -> Result<Self, NameError> {
        let outputs = [OutputName::Forward, OutputName::Turn, OutputName::Stop];
        Ok(Self::of_new(Profile {
            version: VERSION,
            name: free_name("New mix", kept)?,
            inputs: Vec::new(),
            switches: Vec::new(),
            outputs: outputs.map(Output::new).into(),
        }))
    }

    /// A copy of a mix, under a free name.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn copy_of(profile: &Profile, kept: &[Profile]) -> Result<Self, NameError> {
        Ok(Self::of_new(Profile {
            name: free_name("My mix", kept)?,
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
    }

    /// The robot keeps it no more.
    pub fn on_removed(&mut self) {
        self.is_kept = false;
    }

    /// A person wrote this into a field.
    pub fn set(&mut self, field: Field, text: &str) {
        match field.set(&mut self.profile, text) {
            Ok(()) => self.wrong.remove(&field),
            Err(sentence) => self.wrong.insert(field, sentence),
        };
    }

    /// What is wrong with a field, as a sentence.
    #[must_use]
    pub fn problem_of(&self, field: Field) -> Option<String> {
        if let Some(sentence) = self.wrong.get(&field) {
            return Some(sentence.clone());
        }
        let place = field.place(&self.profile);
        self.problem_at(&place)
    }

    /// What is wrong with a group as a whole.
    #[must_use]
    pub fn problem_with(&self, group: Group) -> Option<String> {
        self.problem_at(&group.place(&self.profile))
    }

    fn problem_at(&self, place: &str) -> Option<String> {
        let error = self.profile.check().err()?;
        (!place.is_empty() && error.place() == Some(place)).then(|| error.to_string())
    }

    /// The first thing that is wrong; with it, nothing can be saved.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let text = self.wrong.values().next().cloned();
        text.or_else(|| self.profile.check().err().map(|error| error.to_string()))
    }

    /// Adds a line to an output.
    ///
    /// # Errors
    /// Never: the name is one.
    pub fn add_line(&mut self, output: usize) -> Result<(), NameError> {
        let name = Name::new("New line")?;
        if let Some(output) = self.profile.outputs.get_mut(output) {
            output
                .lines
                .push(Line::new(name, Source::PadAxis { pad: 0, axis: 0 }));
        }
        Ok(())
    }

    /// Adds an output.
    pub fn add_output(&mut self, name: OutputName) {
        if self.free_outputs().contains(&name) {
            self.profile.outputs.push(Output::new(name));
        }
    }

    /// Outputs that the mix does not have yet.
    #[must_use]
    pub fn free_outputs(&self) -> Vec<OutputName> {
        let has = |name: &OutputName| self.profile.outputs.iter().any(|output| output.output == *name);
        OutputName::ALL.into_iter().filter(|name| !has(name)).collect()
    }

    /// Adds a switch.
    ///
    /// # Errors
    /// Never: the names are names.
    pub fn add_switch(&mut self) -> Result<(), NameError> {
        let taken = |name: &Name| self.profile.switches.iter().any(|switch| switch.name == *name);
        let name = numbered("switch", taken)?;
        let input = Source::PadButton { pad: 0, button: 0 };
        let on = Condition::Above { input, level: 0.5 };
        self.profile.switches.push(Switch { name, on });
        Ok(())
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
    pub fn calibrate(&mut self, run: &CalibrationRun) -> Result<(), String> {
        let mut seen = run.finish()?;
        if let Some(input) = self.profile.inputs.get_mut(run.place) {
            seen.dead_band = input.dead_band;
            *input = seen;
        }
        Ok(())
    }

    /// Removes an output, a line, a switch or a calibration.
    pub fn remove(&mut self, group: Group) {
        // What was wrong has other numbers now, or is gone; texts are read anew from the profile.
        self.wrong.clear();
        match group {
            Group::Output(output) => remove(&mut self.profile.outputs, output),
            Group::Line(output, line) => {
                if let Some(output) = self.profile.outputs.get_mut(output) {
                    remove(&mut output.lines, line);
                }
            }
            Group::Switch(switch) => remove(&mut self.profile.switches, switch),
            Group::Input(input) => remove(&mut self.profile.inputs, input),
        }
    }

    /// Moves a line or a switch before the one before it: both see what stands before them.
    pub fn move_up(&mut self, group: Group) {
        self.wrong.clear();
        match group {
            Group::Line(output, line) => {
                if let Some(output) = self.profile.outputs.get_mut(output) {
                    move_up(&mut output.lines, line);
                }
            }
            Group::Switch(switch) => move_up(&mut self.profile.switches, switch),
            Group::Output(_) | Group::Input(_) => {}
        }
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

#[cfg(test)]
mod tests {
    use super::MixDraft;
    use crate::mixes::{CalibrationRun, Field, Group, InputPart, Learning, LinePart, OutputPart, SwitchPart};
    use mixer::{PadReading, Readings, Source, standard_profile};

    fn draft() -> MixDraft {
        MixDraft::of_kept(standard_profile())
    }

    fn fields(draft: &MixDraft) -> Vec<Field> {
        let profile = draft.profile();
        let mut all = vec![Field::MixName];
        for (number, output) in profile.outputs.iter().enumerate() {
            all.extend(OutputPart::ALL.map(|part| Field::Output(number, part)));
            for line in 0..output.lines.len() {
                all.extend(LinePart::ALL.map(|part| Field::Line(number, line, part)));
            }
        }
        for (number, switch) in profile.switches.iter().enumerate() {
            all.extend(
                SwitchPart::of(&switch.on)
                    .iter()
                    .map(|part| Field::Switch(number, *part)),
            );
        }
        for number in 0..profile.inputs.len() {
            all.extend(InputPart::ALL.map(|part| Field::Input(number, part)));
        }
        all
    }

    #[test]
    fn every_field_gives_back_what_it_shows() {
        let mut draft = draft();
        for field in fields(&draft) {
            draft.set(field, &field.text(draft.profile()));
        }
        assert!(!draft.is_changed(), "{:?}", draft.problem());
        assert!(!draft.is_unsaved());
    }

    #[test]
    fn what_is_wrong_is_told_beside_its_field_and_reverted() {
        for (field, text, words) in [
            (Field::MixName, "a/b", "is no name"),
            (Field::Line(0, 1, LinePart::Weight), "3", "from -2 to 2"),
            (Field::Line(0, 1, LinePart::Weight), "much", "from -2 to 2"),
            (Field::Line(0, 1, LinePart::Input), "stick", "is no input"),
            (
                Field::Line(0, 1, LinePart::Curve),
                "0 0, 1 1",
                "rise from -1 to 1",
            ),
            (Field::Line(0, 1, LinePart::Curve), "0", "is no point"),
            (Field::Line(0, 1, LinePart::DelayMs), "-1", "whole milliseconds"),
            (Field::Line(0, 1, LinePart::DelayMs), "9000", "from 0 to 5000"),
            (Field::Line(0, 1, LinePart::SlowUp), "0.1", "0 for at once"),
            (Field::Output(0, OutputPart::Failsafe), "0.5", "must be 0"),
            (Field::Output(0, OutputPart::High), "7", "from -1 to 1"),
            (Field::Switch(0, SwitchPart::Level), "2", "from -1 to 1"),
            (Field::Input(0, InputPart::DeadBand), "1", "from 0 to 0.9"),
        ] {
            let mut draft = draft();
            draft.set(field, text);
            let told = draft.problem_of(field).expect("it is wrong");
            assert!(told.contains(words), "{field:?} = {text}: {told}");
            assert_eq!(draft.problem(), Some(told));
            let beside = fields(&draft);
            let told = beside.iter().filter(|other| draft.problem_of(**other).is_some());
            assert_eq!(told.count(), 1, "{field:?}: only there");
            draft.revert();
            assert_eq!(draft.problem(), None);
            assert!(!draft.is_unsaved());
        }
    }

    #[test]
    fn what_is_wrong_as_a_whole_is_told_at_its_group() {
        let mut draft = draft();
        draft.set(Field::Output(2, OutputPart::Low), "1");
        assert!(
            draft
                .problem_with(Group::Output(2))
                .is_some_and(|told| told.contains("must rise"))
        );
        draft.revert();
        draft.remove(Group::Switch(0));
        let line = draft.profile().outputs[0].lines.len() - 1;
        assert!(
            draft
                .problem_with(Group::Line(0, line))
                .is_some_and(|told| told.contains("slow"))
        );
    }

    #[test]
    fn switches_change_their_kind() {
        let mut draft = draft();
        draft.add_switch().expect("a name");
        for kind in ["all", "any", "not", "toggle", "sticky", "edge", "below", "above"] {
            draft.set(Field::Switch(1, SwitchPart::Kind), kind);
            assert_eq!(Field::Switch(1, SwitchPart::Kind).text(draft.profile()), kind);
            assert_eq!(draft.problem(), None, "{kind}");
        }
        draft.set(Field::Switch(1, SwitchPart::Kind), "sticky");
        draft.set(Field::Switch(1, SwitchPart::Others), "slow");
        assert!(draft.problem().is_some_and(|told| told.contains("two switches")));
    }

    #[test]
    fn lines_are_added_moved_and_removed() {
        let mut draft = draft();
        let count = draft.profile().outputs[0].lines.len();
        draft.add_line(0).expect("a name");
        draft.move_up(Group::Line(0, count));
        assert_eq!(
            draft.profile().outputs[0].lines[count - 1].name.as_str(),
            "New line"
        );
        draft.remove(Group::Line(0, count - 1));
        assert!(!draft.is_changed());
        draft.remove(Group::Output(0));
        draft.add_output(draft.free_outputs()[0]);
        assert_eq!(draft.problem(), None);
        assert_eq!(
            draft.free_outputs().len(),
            2,
            "one wheel each is not in the standard mix"
        );
    }

    fn readings(axis: f64) -> Readings {
        let pad = PadReading {
            axes: vec![axis],
            buttons: vec![0.0],
        };
        Readings {
            pads: [(0, pad)].into(),
            keys: Some([].into()),
            ..Readings::default()
        }
    }

    #[test]
    fn the_next_input_that_moves_is_learnt() {
        let field = Field::Line(0, 0, LinePart::Input);
        let mut learning = Learning::begin(field, &Readings::default());
        assert_eq!(learning.look(&readings(0.9)), None, "it has just appeared");
        assert_eq!(
            learning.look(&readings(0.0)),
            Some(Source::PadAxis { pad: 0, axis: 0 })
        );
    }

    #[test]
    fn an_axis_is_calibrated_by_its_ends() {
        let mut draft = draft();
        let axis = draft.profile().inputs[0].input.clone();
        assert!(CalibrationRun::begin(0, &axis, &Readings::default()).is_none());
        let mut run = CalibrationRun::begin(0, &axis, &readings(0.05)).expect("it is there");
        assert!(
            draft
                .calibrate(&run)
                .is_err_and(|told| told.contains("was not moved"))
        );
        for value in [-0.9, 0.8, 0.1] {
            run.look(&readings(value));
        }
        draft.calibrate(&run).expect("it was moved");
        let found = &draft.profile().inputs[0];
        assert_eq!([found.low, found.centre, found.high], [-0.9, 0.05, 0.8]);
        assert_eq!(draft.problem(), None);
    }

    #[test]
    fn new_and_copied_mixes_have_free_names() {
        let first = MixDraft::copy_of(&standard_profile(), &[]).expect("a name");
        assert_eq!(first.profile().name.as_str(), "My mix");
        assert!(first.is_unsaved() && !first.is_changed());
        let second = MixDraft::copy_of(first.profile(), &[first.profile().clone()]).expect("a name");
        assert_eq!(second.profile().name.as_str(), "My mix 2");
        assert_eq!(MixDraft::empty(&[]).expect("a name").problem(), None);
        let error = MixDraft::import("{").expect_err("broken");
        assert!(error.to_string().contains("line 1"), "{error}");
    }
}
