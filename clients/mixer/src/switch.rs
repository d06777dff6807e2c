//! Logical switches: conditions on inputs that lines may depend on.

use serde::{Deserialize, Serialize};

use crate::{Name, Source};

/// A condition with a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Switch {
    /// Its name.
    pub name: Name,
    /// When it is on.
    pub on: Condition,
}

/// When a switch is on. Other switches that it names must be defined before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    rename_all = "kebab-case",
    rename_all_fields = "kebab-case",
    deny_unknown_fields
)]
pub enum Condition {
    /// An input is above a level.
    Above {
        /// Which.
        input: Source,
        /// The level.
        level: f64,
    },
    /// An input is below a level.
    Below {
        /// Which.
        input: Source,
        /// The level.
        level: f64,
    },
    /// All of them are on.
    All(Vec<Name>),
    /// Any of them is on.
    Any(Vec<Name>),
    /// It is off.
    Not(Name),
    /// Changes over each time that it goes on.
    Toggle(Name),
    /// Goes on with one and off with another; off wins.
    Sticky {
        /// Switches it on.
        set: Name,
        /// Switches it off.
        reset: Name,
    },
    /// On for a while each time that it goes on.
    Edge {
        /// Which.
        of: Name,
        /// How long.
        hold_ms: u16,
    },
}

impl Condition {
    /// The input that it reads.
    #[must_use]
    pub const fn input(&self) -> Option<&Source> {
        match self {
            Self::Above { input, .. } | Self::Below { input, .. } => Some(input),
            _ => None,
        }
    }

    /// The switches that it refers to.
    #[must_use]
    pub fn switches(&self) -> Vec<&Name> {
        match self {
            Self::Above { .. } | Self::Below { .. } => Vec::new(),
            Self::All(names) | Self::Any(names) => names.iter().collect(),
            Self::Not(name) | Self::Toggle(name) | Self::Edge { of: name, .. } => vec![name],
            Self::Sticky { set, reset } => vec![set, reset],
        }
    }
}

/// What a switch remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SwitchMemory {
    pub(crate) on: bool,
    /// Its input was on in the previous step. True at the start, so that an input that is on already does not count as switched on.
    seen: bool,
    since_us: Option<u64>,
}

impl Default for SwitchMemory {
    fn default() -> Self {
        Self {
            on: false,
            seen: true,
            since_us: None,
        }
    }
}

impl SwitchMemory {
    /// Evaluates the condition. `value` reads an input, `is_on` a switch that is defined before this one.
    pub(crate) fn step(
        &mut self,
        now_us: u64,
        condition: &Condition,
        (value, is_on): (impl Fn(&Source) -> Option<f64>, impl Fn(&Name) -> bool),
    ) {
        self.on = match condition {
            Condition::Above { input, level } => value(input).is_some_and(|value| value > *level),
            Condition::Below { input, level } => value(input).is_some_and(|value| value < *level),
            Condition::All(names) => names.iter().all(is_on),
            Condition::Any(names) => names.iter().any(is_on),
            Condition::Not(name) => !is_on(name),
            Condition::Toggle(name) => self.on ^ self.rises(is_on(name)),
            Condition::Sticky { set, reset } => {
                let rises = self.rises(is_on(set));
                (self.on || rises) && !is_on(reset)
            }
            Condition::Edge { of, hold_ms } => {
                if self.rises(is_on(of)) {
                    self.since_us = Some(now_us);
                }
                let hold_us = u64::from(*hold_ms) * 1000;
                self.since_us
                    .is_some_and(|since_us| now_us.saturating_sub(since_us) < hold_us)
            }
        };
    }

    fn rises(&mut self, now: bool) -> bool {
        let before = core::mem::replace(&mut self.seen, now);
        now && !before
    }
}
