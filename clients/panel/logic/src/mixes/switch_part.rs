//! The parts of switches that a person can set: from and to text.

use mixer::{Condition, Name, Source, Switch};

use super::FieldError;
use super::parts::{milliseconds, name, names, names_text, number};
use crate::words::Words;

/// A setting of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SwitchPart {
    /// Its name.
    Name,
    /// Which condition.
    Kind,
    /// The input.
    Input,
    /// Its level.
    Level,
    /// The switches that it refers to.
    Others,
    /// How long it stays on.
    HoldMs,
}

/// Conditions by their words in profiles, with what people read.
pub(super) const fn conditions(words: &Words) -> [(&'static str, &'static str); 8] {
    let texts = &words.mix;
    [
        ("above", texts.above),
        ("below", texts.below),
        ("all", texts.all_of),
        ("any", texts.any_of),
        ("not", texts.not_of),
        ("toggle", texts.toggle),
        ("sticky", texts.sticky),
        ("edge", texts.edge),
    ]
}

impl SwitchPart {
    /// Those that a switch has.
    #[must_use]
    pub fn of(condition: &Condition) -> &'static [Self] {
        match condition {
            Condition::Above { .. } | Condition::Below { .. } => {
                &[Self::Name, Self::Kind, Self::Input, Self::Level]
            }
            Condition::Edge { .. } => &[Self::Name, Self::Kind, Self::Others, Self::HoldMs],
            _ => &[Self::Name, Self::Kind, Self::Others],
        }
    }

    pub(super) fn text(self, switch: &Switch) -> String {
        match (self, &switch.on) {
            (Self::Name, _) => switch.name.to_string(),
            (Self::Kind, on) => kind(on).to_owned(),
            (Self::Input, on) => on.input().map(ToString::to_string).unwrap_or_default(),
            (Self::Level, Condition::Above { level, .. } | Condition::Below { level, .. }) => {
                level.to_string()
            }
            (Self::Others, on) => names_text(&on.switches()),
            (Self::HoldMs, Condition::Edge { hold_ms, .. }) => hold_ms.to_string(),
            (Self::Level | Self::HoldMs, _) => String::new(),
        }
    }

    pub(super) fn set(self, switch: &mut Switch, text: &str) -> Result<(), FieldError> {
        match (self, &mut switch.on) {
            (Self::Name, _) => switch.name = name(text)?,
            (Self::Kind, on) => *on = of_kind(text, on),
            (Self::Input, Condition::Above { input, .. } | Condition::Below { input, .. }) => {
                *input = text.parse().map_err(FieldError::Source)?;
            }
            (Self::Level, Condition::Above { level, .. } | Condition::Below { level, .. }) => {
                *level = number(text);
            }
            (Self::Others, on) => join(on, text)?,
            (Self::HoldMs, Condition::Edge { hold_ms, .. }) => *hold_ms = milliseconds(text)?,
            (Self::Input | Self::Level | Self::HoldMs, _) => {}
        }
        Ok(())
    }
}

const fn kind(condition: &Condition) -> &'static str {
    match condition {
        Condition::Above { .. } => "above",
        Condition::Below { .. } => "below",
        Condition::All(_) => "all",
        Condition::Any(_) => "any",
        Condition::Not(_) => "not",
        Condition::Toggle(_) => "toggle",
        Condition::Sticky { .. } => "sticky",
        Condition::Edge { .. } => "edge",
    }
}

/// The condition of this kind that keeps what it can of the one before.
fn of_kind(kind: &str, before: &Condition) -> Condition {
    let input = before.input().cloned().unwrap_or(Source::Always);
    let names: Vec<Name> = before.switches().into_iter().cloned().collect();
    let (first, second) = (names.first().cloned(), names.get(1).cloned());
    match (kind, first) {
        ("below", _) => Condition::Below { input, level: -0.5 },
        ("all", _) => Condition::All(names),
        ("any", _) => Condition::Any(names),
        ("not", Some(first)) => Condition::Not(first),
        ("toggle", Some(first)) => Condition::Toggle(first),
        ("sticky", Some(first)) => Condition::Sticky {
            reset: second.unwrap_or_else(|| first.clone()),
            set: first,
        },
        ("edge", Some(of)) => Condition::Edge { of, hold_ms: 500 },
        _ => Condition::Above { input, level: 0.5 },
    }
}

/// Puts the switches of this text into a condition.
fn join(condition: &mut Condition, text: &str) -> Result<(), FieldError> {
    let names = names(text)?;
    match (condition, names.as_slice()) {
        (Condition::All(all) | Condition::Any(all), _) => *all = names,
        (Condition::Not(one) | Condition::Toggle(one) | Condition::Edge { of: one, .. }, [only]) => {
            *one = only.clone();
        }
        (Condition::Sticky { set, reset }, [first, second]) => {
            *set = first.clone();
            *reset = second.clone();
        }
        (Condition::Sticky { .. }, _) => return Err(FieldError::TwoSwitches(text.to_owned())),
        (Condition::Above { .. } | Condition::Below { .. }, _) => {}
        _ => return Err(FieldError::OneSwitch(text.to_owned())),
    }
    Ok(())
}
