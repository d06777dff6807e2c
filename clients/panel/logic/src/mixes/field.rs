//! One field of the form: its name, its input control, its place in the profile.

use mixer::{OutputName, Profile};

use super::FieldError;
use super::flight_part::{ModePart, TrimPart, trimmable};
use super::parts::{InputPart, LinePart, OutputPart, name};
use super::switch_part::{SwitchPart, conditions};
use crate::words::Words;

/// A field; outputs, lines, switches and inputs are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Field {
    /// Name of the mix.
    MixName,
    /// Of an output.
    Output(usize, OutputPart),
    /// Of a line of an output.
    Line(usize, usize, LinePart),
    /// Of a switch.
    Switch(usize, SwitchPart),
    /// Of a trim.
    Trim(usize, TrimPart),
    /// Of a flight mode.
    Mode(usize, ModePart),
    /// Of a calibration.
    Input(usize, InputPart),
}

/// What a message can be about as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// An output.
    Output(usize),
    /// A line of an output.
    Line(usize, usize),
    /// A switch.
    Switch(usize),
    /// A trim.
    Trim(usize),
    /// A flight mode.
    Mode(usize),
    /// A calibration.
    Input(usize),
}

/// How a field is entered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// Any text.
    Text,
    /// A number.
    Number,
    /// An input, which can be learnt.
    Source,
    /// Yes or no.
    Check,
    /// One of these: the value, and what people read.
    Choice(Vec<(String, String)>),
}

impl Field {
    /// What people read.
    #[must_use]
    pub const fn label(self, words: &Words) -> &'static str {
        let texts = &words.mix;
        match self {
            Self::MixName
            | Self::Line(_, _, LinePart::Name)
            | Self::Switch(_, SwitchPart::Name)
            | Self::Mode(_, ModePart::Name) => texts.name,
            Self::Line(_, _, LinePart::Input)
            | Self::Switch(_, SwitchPart::Input)
            | Self::Input(_, InputPart::Input) => texts.input,
            Self::Line(_, _, LinePart::Invert) => texts.inverted,
            Self::Line(_, _, LinePart::Weight) => texts.weight,
            Self::Line(_, _, LinePart::Offset) => texts.offset,
            Self::Line(_, _, LinePart::Expo) => texts.expo,
            Self::Line(_, _, LinePart::Curve) => texts.curve,
            Self::Line(_, _, LinePart::Mix) => texts.joins_by,
            Self::Line(_, _, LinePart::When) | Self::Mode(_, ModePart::When) => texts.only_while,
            Self::Line(_, _, LinePart::Modes) => texts.in_modes,
            Self::Line(_, _, LinePart::DelayMs) => texts.delay,
            Self::Line(_, _, LinePart::SlowUp) => texts.slow_up,
            Self::Line(_, _, LinePart::SlowDown) => texts.slow_down,
            Self::Output(_, OutputPart::Low) | Self::Input(_, InputPart::Low) => texts.low,
            Self::Output(_, OutputPart::Centre) | Self::Input(_, InputPart::Centre) => texts.centre,
            Self::Output(_, OutputPart::High) | Self::Input(_, InputPart::High) => texts.high,
            Self::Output(_, OutputPart::Failsafe) => texts.failsafe,
            Self::Output(_, OutputPart::Reverse) => texts.reversed,
            Self::Switch(_, SwitchPart::Kind) => texts.on_when,
            Self::Switch(_, SwitchPart::Level) => texts.level,
            Self::Switch(_, SwitchPart::Others) => texts.others,
            Self::Switch(_, SwitchPart::HoldMs) => texts.how_long,
            Self::Input(_, InputPart::DeadBand) => texts.dead_band,
            Self::Trim(_, TrimPart::Output) => texts.output,
            Self::Trim(_, TrimPart::Up) => texts.trim_up,
            Self::Trim(_, TrimPart::Down) => texts.trim_down,
            Self::Trim(_, TrimPart::Step) => texts.trim_step,
            Self::Trim(_, TrimPart::Value) => texts.trim_value,
            Self::Mode(_, ModePart::FadeMs) => texts.fade,
            Self::Mode(_, ModePart::Trims) => texts.own_trims,
        }
    }

    /// Name for the page, of letters, digits and `-`.
    #[must_use]
    pub fn id(self) -> String {
        let part = |part: &dyn std::fmt::Debug| format!("{part:?}").to_lowercase();
        match self {
            Self::MixName => "mix-name".to_owned(),
            Self::Output(output, which) => format!("output-{output}-{}", part(&which)),
            Self::Line(output, line, which) => format!("line-{output}-{line}-{}", part(&which)),
            Self::Switch(switch, which) => format!("switch-{switch}-{}", part(&which)),
            Self::Trim(trim, which) => format!("trim-{trim}-{}", part(&which)),
            Self::Mode(mode, which) => format!("mode-{mode}-{}", part(&which)),
            Self::Input(input, which) => format!("input-{input}-{}", part(&which)),
        }
    }

    /// How it is entered.
    #[must_use]
    pub fn kind(self, words: &Words, profile: &Profile) -> FieldKind {
        let texts = &words.mix;
        let choice = |value: &str, words: &str| (value.to_owned(), words.to_owned());
        match self {
            Self::Line(_, _, LinePart::Input)
            | Self::Switch(_, SwitchPart::Input)
            | Self::Trim(_, TrimPart::Up | TrimPart::Down)
            | Self::Input(_, InputPart::Input) => FieldKind::Source,
            Self::Trim(_, TrimPart::Output) => {
                let names = trimmable().map(|output| choice(output.name(), output_title(words, output)));
                FieldKind::Choice(names.collect())
            }
            Self::Mode(_, ModePart::When) => FieldKind::Choice(switch_choices(words, profile)),
            Self::Line(_, _, LinePart::Invert) | Self::Output(_, OutputPart::Reverse) => FieldKind::Check,
            Self::Line(_, _, LinePart::Mix) => FieldKind::Choice(vec![
                choice("add", texts.adding),
                choice("multiply", texts.multiplying),
                choice("replace", texts.replacing),
            ]),
            Self::Line(_, _, LinePart::When) => {
                let names = switch_choices(words, profile).into_iter();
                FieldKind::Choice([choice("", texts.always)].into_iter().chain(names).collect())
            }
            Self::Switch(place, SwitchPart::Kind) => {
                let needs_others = |kind: &str| !matches!(kind, "above" | "below");
                let offered = conditions(words)
                    .into_iter()
                    .filter(|(kind, _)| place > 0 || !needs_others(kind));
                FieldKind::Choice(offered.map(|(value, words)| choice(value, words)).collect())
            }
            Self::MixName
            | Self::Line(_, _, LinePart::Name | LinePart::Curve | LinePart::Modes)
            | Self::Mode(_, ModePart::Name | ModePart::Trims)
            | Self::Switch(_, SwitchPart::Name | SwitchPart::Others) => FieldKind::Text,
            _ => FieldKind::Number,
        }
    }

    /// Its place in the terms of the mixer's messages; empty when none names it alone.
    #[must_use]
    pub fn place(self, profile: &Profile) -> String {
        let (group, word) = match self {
            Self::Output(output, part) => (Group::Output(output), output_word(part)),
            Self::Line(output, line, part) => (Group::Line(output, line), line_word(part)),
            Self::Switch(switch, part) => (Group::Switch(switch), switch_word(part)),
            Self::Input(input, part) => (Group::Input(input), input_word(part)),
            Self::Trim(trim, part) => (Group::Trim(trim), trim_word(part)),
            Self::Mode(mode, part) => (Group::Mode(mode), mode_word(part)),
            Self::MixName => return String::new(),
        };
        word.map(|word| format!("{}, {word}", group.place(profile)))
            .unwrap_or_default()
    }

    /// What it holds, as text.
    #[must_use]
    pub fn text(self, profile: &Profile) -> String {
        match self {
            Self::MixName => Some(profile.name.to_string()),
            Self::Output(output, part) => profile.outputs.get(output).map(|output| part.text(output)),
            Self::Line(output, line, part) => profile
                .outputs
                .get(output)
                .and_then(|output| output.lines.get(line))
                .map(|line| part.text(line)),
            Self::Switch(switch, part) => profile.switches.get(switch).map(|switch| part.text(switch)),
            Self::Input(input, part) => profile.inputs.get(input).map(|input| part.text(input)),
            Self::Trim(trim, part) => profile.trims.get(trim).map(|trim| part.text(trim)),
            Self::Mode(mode, part) => profile.modes.get(mode).map(|mode| part.text(mode)),
        }
        .unwrap_or_default()
    }

    /// Puts a text into it.
    ///
    /// # Errors
    /// What is wrong with the text; then nothing is changed. A number out of its range is taken, and the mixer's check reports it.
    pub fn set(self, profile: &mut Profile, text: &str) -> Result<(), FieldError> {
        match self {
            Self::MixName => profile.name = name(text)?,
            Self::Output(output, part) => {
                if let Some(output) = profile.outputs.get_mut(output) {
                    part.set(output, text);
                }
            }
            Self::Line(output, line, part) => {
                let output = profile.outputs.get_mut(output);
                if let Some(line) = output.and_then(|output| output.lines.get_mut(line)) {
                    part.set(line, text)?;
                }
            }
            Self::Switch(switch, part) => set_switch(profile, switch, part, text)?,
            Self::Input(input, part) => {
                if let Some(input) = profile.inputs.get_mut(input) {
                    part.set(input, text)?;
                }
            }
            Self::Trim(trim, part) => {
                if let Some(trim) = profile.trims.get_mut(trim) {
                    part.set(trim, text)?;
                }
            }
            Self::Mode(mode, part) => {
                if let Some(mode) = profile.modes.get_mut(mode) {
                    part.set(mode, text)?;
                }
            }
        }
        Ok(())
    }
}

/// A switch that becomes one that refers to another refers to the one before it.
fn set_switch(profile: &mut Profile, place: usize, part: SwitchPart, text: &str) -> Result<(), FieldError> {
    let place = place.min(profile.switches.len());
    let (earlier, rest) = profile.switches.split_at_mut(place);
    let Some(switch) = rest.first_mut() else {
        return Ok(());
    };
    let looks_at_none = switch.on.switches().is_empty();
    if part == SwitchPart::Kind
        && looks_at_none
        && let Some(before) = earlier.last()
    {
        switch.on = match text {
            "above" | "below" => switch.on.clone(),
            _ => mixer::Condition::All(vec![before.name.clone()]),
        };
    }
    part.set(switch, text)
}

impl Group {
    /// Its place in the terms of the mixer's messages.
    #[must_use]
    pub fn place(self, profile: &Profile) -> String {
        match self {
            Self::Output(output) => profile.outputs.get(output).map(mixer::Output::place),
            Self::Line(output, line) => Some(profile.line_place(output, line)),
            Self::Switch(switch) => profile.switches.get(switch).map(mixer::Switch::place),
            Self::Input(input) => profile.inputs.get(input).map(mixer::Calibration::place),
            Self::Trim(trim) => profile.trims.get(trim).map(mixer::Trim::place),
            Self::Mode(mode) => profile.modes.get(mode).map(mixer::FlightMode::place),
        }
        .unwrap_or_default()
    }
}

const fn output_word(part: OutputPart) -> Option<&'static str> {
    match part {
        OutputPart::Low => Some("low"),
        OutputPart::Centre => Some("centre"),
        OutputPart::High => Some("high"),
        OutputPart::Failsafe => Some("failsafe"),
        OutputPart::Reverse => None,
    }
}

const fn line_word(part: LinePart) -> Option<&'static str> {
    match part {
        LinePart::Weight => Some("weight"),
        LinePart::Offset => Some("offset"),
        LinePart::Expo => Some("expo"),
        LinePart::Curve => Some("curve"),
        LinePart::DelayMs => Some("delay-ms"),
        LinePart::SlowUp => Some("slow-up-per-s"),
        LinePart::SlowDown => Some("slow-down-per-s"),
        LinePart::Name
        | LinePart::Input
        | LinePart::Invert
        | LinePart::Mix
        | LinePart::When
        | LinePart::Modes => None,
    }
}

const fn switch_word(part: SwitchPart) -> Option<&'static str> {
    match part {
        SwitchPart::Level => Some("level"),
        SwitchPart::HoldMs => Some("hold-ms"),
        SwitchPart::Name | SwitchPart::Kind | SwitchPart::Input | SwitchPart::Others => None,
    }
}

const fn trim_word(part: TrimPart) -> Option<&'static str> {
    match part {
        TrimPart::Step => Some("step"),
        TrimPart::Value => Some("value"),
        TrimPart::Output | TrimPart::Up | TrimPart::Down => None,
    }
}

const fn mode_word(part: ModePart) -> Option<&'static str> {
    match part {
        ModePart::FadeMs => Some("fade-ms"),
        ModePart::Name | ModePart::When | ModePart::Trims => None,
    }
}

/// The switches of the mix: the name, and what people read.
fn switch_choices(words: &Words, profile: &Profile) -> Vec<(String, String)> {
    let names = profile.switches.iter().map(|switch| switch.name.to_string());
    names
        .map(|name| (name.clone(), words.mix.switch.fill([&name])))
        .collect()
}

/// The name of an output as people write it.
#[must_use]
pub const fn output_title(words: &Words, name: OutputName) -> &'static str {
    let texts = &words.mix;
    match name {
        OutputName::Forward => texts.forward,
        OutputName::Turn => texts.turn,
        OutputName::LeftWheel => texts.left_wheel,
        OutputName::RightWheel => texts.right_wheel,
        OutputName::Suction => texts.suction,
        OutputName::MainBrush => texts.main_brush,
        OutputName::SideBrushes => texts.side_brushes,
        OutputName::Start => texts.start,
        OutputName::Stop => texts.stop,
        OutputName::Spot => texts.spot,
        OutputName::Dock => texts.dock,
    }
}

const fn input_word(part: InputPart) -> Option<&'static str> {
    match part {
        InputPart::Low => Some("low"),
        InputPart::Centre => Some("centre"),
        InputPart::High => Some("high"),
        InputPart::DeadBand => Some("dead-band"),
        InputPart::Input => None,
    }
}
