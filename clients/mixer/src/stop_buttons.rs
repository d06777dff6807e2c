//! Stop on any pad: whoever holds a second pad stops the robot with the same button, though the mix drives by the first.

use std::collections::BTreeSet;

use crate::readings::PRESSED;
use crate::{OutputName, Profile, Readings, Source};

/// The buttons that stop, by their numbers, and which of them were seen free.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopButtons {
    buttons: BTreeSet<u8>,
    /// Pads and buttons to which the profile gives a meaning itself.
    named: BTreeSet<(u8, u8)>,
    /// Pad and button.
    freed: BTreeSet<(u8, u8)>,
}

impl StopButtons {
    /// Those of a profile, on whatever pad it names them.
    pub(crate) fn of(profile: &Profile) -> Self {
        let stop = profile
            .outputs
            .iter()
            .filter(|output| output.output == OutputName::Stop);
        let always = stop
            .flat_map(|output| &output.lines)
            .filter(|line| line.when.is_none());
        let pair = |source: &Source| match source {
            Source::PadButton { pad, button } => Some((*pad, *button)),
            _ => None,
        };
        Self {
            buttons: always
                .filter_map(|line| pair(&line.input))
                .map(|(_, button)| button)
                .collect(),
            named: profile.sources().filter_map(pair).collect(),
            freed: BTreeSet::new(),
        }
    }

    /// Whether one of them has just gone down on any pad. One that was down when its pad appeared counts from its next press on.
    pub(crate) fn rise(&mut self, readings: &Readings) -> bool {
        self.freed.retain(|(pad, _)| readings.pads.contains_key(pad));
        let mut rises = false;
        for (pad, reading) in &readings.pads {
            let own = |button: &&u8| !self.named.contains(&(*pad, **button));
            for button in self.buttons.iter().filter(own) {
                let value = reading.buttons.get(usize::from(*button)).copied();
                if value.is_some_and(|value| value > PRESSED) {
                    rises |= self.freed.remove(&(*pad, *button));
                } else {
                    self.freed.insert((*pad, *button));
                }
            }
        }
        rises
    }
}
