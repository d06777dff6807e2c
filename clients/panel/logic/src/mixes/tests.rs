//! The form as a person uses it.

use super::{
    CalibrationRun, Field, Group, InputPart, Learning, LinePart, MixDraft, ModePart, OutputPart, SwitchPart,
    TrimPart, robot_has,
};
use crate::words::{Language, Words};
use mixer::{Name, OutputName, PadReading, ProfileError, Readings, Source, standard_profile};
use rvac_api::RobotDescription;

const ENGLISH: &Words = Language::English.words();

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
    for number in 0..profile.trims.len() {
        all.extend(TrimPart::ALL.map(|part| Field::Trim(number, part)));
    }
    for number in 0..profile.modes.len() {
        all.extend(ModePart::ALL.map(|part| Field::Mode(number, part)));
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

/// The standard mix with a trim of the turn, and a flight mode on the switch that it has.
fn with_flight() -> MixDraft {
    let mut draft = draft();
    draft.add_trim();
    draft.add_mode(ENGLISH).expect("a name");
    draft.set(Field::Mode(0, ModePart::Trims), "turn 0.05");
    draft.set(Field::Line(0, 0, LinePart::Modes), "mode");
    assert_eq!(draft.problem(), None);
    draft
}

#[test]
fn trims_and_modes_are_added_and_give_back_what_they_show() {
    let mut draft = with_flight();
    let before = draft.profile().clone();
    for field in fields(&draft) {
        draft.set(field, &field.text(draft.profile()));
    }
    assert_eq!(*draft.profile(), before);
    assert_eq!(before.trims[0].output, OutputName::Turn);
    assert_eq!(before.modes[0].when, before.switches[0].name);
    draft.add_trim();
    assert_eq!(
        draft.profile().trims[1].output,
        OutputName::Forward,
        "the first that has none"
    );
}

#[test]
fn what_is_wrong_with_a_trim_or_a_mode_is_shown_beside_its_field() {
    for (field, text, words) in [
        (Field::Trim(0, TrimPart::Step), "1", "from 0.001 to 0.1"),
        (Field::Trim(0, TrimPart::Value), "-1", "from -0.25 to 0.25"),
        (Field::Trim(0, TrimPart::Up), "cross", "is no input"),
        (Field::Mode(0, ModePart::FadeMs), "9000", "from 0 to 5000"),
        (Field::Mode(0, ModePart::Trims), "suction 0.1", "is no trim"),
    ] {
        let mut draft = with_flight();
        draft.set(field, text);
        let told = draft.problem_of(field).expect("it is wrong");
        let sentence = told.text(ENGLISH);
        assert!(
            sentence.replace('\u{a0}', " ").contains(words),
            "{field:?} = {text}: {sentence}"
        );
        assert_ne!(told.text(Language::Estonian.words()), sentence, "{field:?}");
    }
}

#[test]
fn trims_that_were_set_while_driving_are_taken_over_and_kept_by_saving() {
    let mut draft = MixDraft::of_kept(with_flight().profile().clone());
    let mut flown = draft.profile().clone();
    flown.trims[0].value = 0.03;
    flown.modes[0].trims[0].value = -0.02;
    draft.take_trims(&flown);
    assert_eq!(*draft.profile(), flown);
    assert!(draft.is_changed(), "it can be saved");
    draft.take_trims(&standard_profile());
    assert_eq!(*draft.profile(), flown, "another mix has none of them");
}

#[test]
fn what_is_wrong_is_shown_beside_its_field_and_reverted() {
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
        let sentence = told.text(ENGLISH);
        let plain = sentence.replace('\u{a0}', " ");
        assert!(plain.contains(words), "{field:?} = {text}: {sentence}");
        let other = told.text(Language::Estonian.words());
        assert_ne!(other, sentence, "{field:?} = {text}");
        assert_eq!(draft.problem().map(|first| first.text(ENGLISH)), Some(sentence));
        let beside = fields(&draft);
        let told = beside.iter().filter(|other| draft.problem_of(**other).is_some());
        assert_eq!(told.count(), 1, "{field:?}: only there");
        draft.revert();
        assert_eq!(draft.problem(), None);
        assert!(!draft.is_unsaved());
    }
}

#[test]
fn what_is_wrong_as_a_whole_is_shown_at_its_group() {
    let mut draft = draft();
    draft.set(Field::Output(2, OutputPart::Low), "1");
    assert!(
        draft
            .problem_with(Group::Output(2))
            .is_some_and(|told| told.text(ENGLISH).contains("must rise"))
    );
    draft.revert();
    draft.remove(Group::Switch(0));
    let line = draft.profile().outputs[0].lines.len() - 1;
    assert!(
        draft
            .problem_with(Group::Line(0, line))
            .is_some_and(|told| told.text(ENGLISH).contains("slow"))
    );
}

#[test]
fn switches_change_their_kind() {
    let mut draft = draft();
    draft.add_switch(ENGLISH).expect("a name");
    for kind in ["all", "any", "not", "toggle", "sticky", "edge", "below", "above"] {
        draft.set(Field::Switch(1, SwitchPart::Kind), kind);
        assert_eq!(Field::Switch(1, SwitchPart::Kind).text(draft.profile()), kind);
        assert_eq!(draft.problem(), None, "{kind}");
    }
    draft.set(Field::Switch(1, SwitchPart::Kind), "sticky");
    draft.set(Field::Switch(1, SwitchPart::Others), "slow");
    assert!(
        draft
            .problem()
            .is_some_and(|told| told.text(ENGLISH).contains("two switches"))
    );
}

#[test]
fn lines_are_added_moved_and_removed() {
    let mut draft = draft();
    let count = draft.profile().outputs[0].lines.len();
    draft.add_line(ENGLISH, 0).expect("a name");
    draft.move_up(Group::Line(0, count));
    assert_eq!(
        draft.profile().outputs[0].lines[count - 1].name.as_str(),
        "New line"
    );
    draft.remove(Group::Line(0, count - 1));
    assert!(!draft.is_changed());
    draft.remove(Group::Output(0));
    draft.add_output(draft.free_outputs(None)[0]);
    assert_eq!(draft.problem(), None);
    assert_eq!(
        draft.free_outputs(None).len(),
        2,
        "one wheel each is not in the standard mix"
    );
}

fn robot(parts: &[&str]) -> RobotDescription {
    RobotDescription {
        device: "x".to_owned(),
        radius_m: 0.17,
        swath_m: 0.3,
        speed_max_m_per_s: 0.3,
        turn_max_rad_per_s: 1.5,
        proximity: 0,
        parts: parts.iter().map(|&part| part.to_owned()).collect(),
        unguarded: Vec::new(),
        unmeasured: Vec::new(),
        lacking: Vec::new(),
    }
}

#[test]
fn only_outputs_of_parts_that_the_robot_has_are_offered() {
    let draft = MixDraft::empty(ENGLISH, &[]).expect("names");
    let bare = draft.free_outputs(Some(&robot(&["gyro"])));
    for absent in [
        OutputName::Suction,
        OutputName::MainBrush,
        OutputName::SideBrushes,
        OutputName::Dock,
    ] {
        assert!(!bare.contains(&absent), "{absent}");
    }
    assert!(bare.contains(&OutputName::LeftWheel) && bare.contains(&OutputName::Start));
    let fitted = robot(&["brush-main", "brush-sides", "vacuum", "dock"]);
    assert_eq!(draft.free_outputs(Some(&fitted)), draft.free_outputs(None));
}

#[test]
fn a_mix_keeps_outputs_that_the_robot_lacks() {
    let draft = draft();
    let bare = robot(&[]);
    let absent: Vec<_> = draft
        .profile()
        .outputs
        .iter()
        .map(|output| output.output)
        .filter(|name| !robot_has(*name, Some(&bare)))
        .collect();
    assert!(absent.contains(&OutputName::Suction));
    assert_eq!(draft.problem(), None, "it can be saved all the same");
    assert!(
        absent.iter().all(|name| robot_has(*name, None)),
        "as long as no robot is known"
    );
}

fn readings(axis: f64) -> Readings {
    let pad = PadReading {
        words: 0,
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
fn what_a_client_moves_is_learnt() {
    let field = Field::Line(0, 0, LinePart::Input);
    let steer: Source = "client-steer".parse().expect("an input");
    let told = |value| {
        let mut readings = readings(0.0);
        readings.set(&steer, value);
        readings
    };
    let mut learning = Learning::begin(field, &readings(0.0));
    assert_eq!(learning.look(&told(1.0)), None, "it has just appeared");
    assert_eq!(learning.look(&told(1.0)), None);
    assert_eq!(learning.look(&told(-0.2)), Some(steer.clone()));
}

#[test]
fn an_axis_is_calibrated_by_its_ends() {
    let mut draft = draft();
    let axis = draft.profile().inputs[0].input.clone();
    assert!(CalibrationRun::begin(0, &axis, &Readings::default()).is_none());
    let mut run = CalibrationRun::begin(0, &axis, &readings(0.05)).expect("it is there");
    assert!(
        draft
            .calibrate(ENGLISH, &run)
            .is_err_and(|told| told.contains("was not moved"))
    );
    for value in [-0.9, 0.8, 0.1] {
        run.look(&readings(value));
    }
    draft.calibrate(ENGLISH, &run).expect("it was moved");
    let found = &draft.profile().inputs[0];
    assert_eq!([found.low, found.centre, found.high], [-0.9, 0.05, 0.8]);
    assert_eq!(draft.problem(), None);
}

/// A trigger that had said nothing reads 0, and rests at its end.
#[test]
fn a_trigger_that_was_not_touched_is_calibrated_at_its_rest() {
    let axis = draft().profile().inputs[0].input.clone();
    let run = |begin: f64, moves: &[f64]| {
        let mut run = CalibrationRun::begin(0, &axis, &readings(begin)).expect("it is there");
        for value in moves {
            run.look(&readings(*value));
        }
        run.finish(ENGLISH)
            .map(|found| [found.low, found.centre, found.high])
    };
    assert_eq!(run(0.0, &[-0.4, 1.0, -1.0]), Ok([-1.0, -1.0, 1.0]));
    assert_eq!(run(-1.0, &[0.5, 1.0, -0.98]), Ok([-1.0, -1.0, 1.0]));
    assert_eq!(run(0.0, &[-1.0, 1.0, 0.02]), Ok([-1.0, 0.0, 1.0]), "a stick");
    assert!(run(0.1, &[-1.0, 1.0]).is_err_and(|told| told.contains("let it go")));
}

#[test]
fn new_and_copied_mixes_have_free_names() {
    let first = MixDraft::copy_of(ENGLISH, &standard_profile(), &[]).expect("a name");
    assert_eq!(first.profile().name.as_str(), "My mix");
    assert!(first.is_unsaved() && !first.is_changed());
    let second = MixDraft::copy_of(ENGLISH, first.profile(), &[first.profile().clone()]).expect("a name");
    assert_eq!(second.profile().name.as_str(), "My mix 2");
    assert_eq!(MixDraft::empty(ENGLISH, &[]).expect("a name").problem(), None);
    let error = MixDraft::import("{").expect_err("broken");
    assert!(error.to_string().contains("line 1"), "{error}");
}

#[test]
fn what_new_things_are_called_is_a_name_in_every_language() {
    for language in Language::ALL {
        let told = &language.words().mix;
        for name in [told.new_mix, told.my_mix, told.new_line, told.new_switch] {
            assert!(Name::new(name).is_ok(), "{name}");
        }
    }
}

#[test]
fn a_file_that_is_no_mix_is_shown_in_both_languages() {
    let error = ProfileError::Version { found: 9 };
    let told = |language: Language| super::profile_problem_text(language.words(), &error);
    assert_eq!(told(Language::English), error.to_string());
    assert!(told(Language::Estonian).contains("versioon on 9"));
}
