//! Where in a profile something is, in the words of the messages, so that a form can show a message beside its field.

use crate::{Calibration, FlightMode, Output, Profile, ProfileError, Switch, Trim};

impl ProfileError {
    /// The place that it names; none when it is about the whole.
    #[must_use]
    pub fn place(&self) -> Option<&str> {
        match self {
            Self::TooLarge { .. } | Self::Syntax { .. } | Self::Version { .. } => None,
            Self::Range { place, .. }
            | Self::Order { place }
            | Self::Failsafe { place, .. }
            | Self::Slow { place, .. }
            | Self::Curve { place }
            | Self::TooMany { place, .. }
            | Self::Twice { place }
            | Self::NoSwitch { place, .. }
            | Self::NoMode { place, .. }
            | Self::NoTrim { place, .. }
            | Self::NotTrimmed { place, .. }
            | Self::JoinsNone { place } => Some(place),
        }
    }
}

impl Calibration {
    /// Its place.
    #[must_use]
    pub fn place(&self) -> String {
        format!("input {}", self.input)
    }
}

impl Switch {
    /// Its place.
    #[must_use]
    pub fn place(&self) -> String {
        format!("switch {}", self.name)
    }
}

impl Trim {
    /// Its place.
    #[must_use]
    pub fn place(&self) -> String {
        format!("trim {}", self.output)
    }
}

impl FlightMode {
    /// Its place.
    #[must_use]
    pub fn place(&self) -> String {
        format!("mode {}", self.name)
    }
}

impl Output {
    /// Its place.
    #[must_use]
    pub fn place(&self) -> String {
        format!("output {}", self.output)
    }
}

impl Profile {
    /// Place of a line of an output, both counted from 0; empty when there is none.
    #[must_use]
    pub fn line_place(&self, output: usize, line: usize) -> String {
        let found = self
            .outputs
            .get(output)
            .and_then(|output| Some((output, output.lines.get(line)?)));
        found.map_or_else(String::new, |(output, found)| {
            format!("{}, line {} ({})", output.place(), line + 1, found.name)
        })
    }
}
