//! What all inputs read at one moment.

use std::collections::{BTreeMap, BTreeSet};

use crate::input::{AXES, BUTTONS};
use crate::{Device, KeyCode, Name, Source};

/// An input that left its place by so much is the one that a person means. Sticks at rest wander by less.
const MOVED: f64 = 0.5;
/// A button is pressed above this.
pub(crate) const PRESSED: f64 = 0.5;

/// What one pad reads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PadReading {
    /// Axes, -1..=1.
    pub axes: Vec<f64>,
    /// Buttons, 0..=1.
    pub buttons: Vec<f64>,
    /// Another number with each word of the pad, also with one that changes nothing here.
    pub words: u64,
}

impl PadReading {
    /// Whether the pad has said nothing between the two.
    pub(crate) fn says_the_same(&self, other: &Self) -> bool {
        let same = |one: &[f64], other: &[f64]| {
            // Nonsense is the same as itself.
            one.iter()
                .map(|value| value.to_bits())
                .eq(other.iter().map(|value| value.to_bits()))
        };
        self.words == other.words && same(&self.axes, &other.axes) && same(&self.buttons, &other.buttons)
    }
}

/// What all devices read. A device that is not there is absent, which is not the same as one at rest. The empty value says
/// that everything is gone, as behind a hidden tab.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Readings {
    /// Pads by their numbers.
    pub pads: BTreeMap<u8, PadReading>,
    /// Keys that are held.
    pub keys: Option<BTreeSet<KeyCode>>,
    /// The stick on the screen: right and up, -1..=1.
    pub touch: Option<[f64; 2]>,
    /// Tilt of the device: forward and left, a quarter turn is 1.
    pub tilt: Option<[f64; 2]>,
    /// Inputs of other clients, each of them a device of its own: see [`crate::ClientInputs`].
    pub clients: BTreeMap<Name, f64>,
}

impl Readings {
    /// Whether the device is there.
    #[must_use]
    pub fn has(&self, device: &Device) -> bool {
        match device {
            Device::Pad(pad) => self.pads.contains_key(pad),
            Device::Keyboard => self.keys.is_some(),
            Device::Touch => self.touch.is_some(),
            Device::Tilt => self.tilt.is_some(),
            Device::Client(name) => self.clients.contains_key(name),
        }
    }

    /// What an input reads; none when its device is absent, does not have it, or gives nonsense. Switches are not read here.
    #[must_use]
    pub fn value(&self, source: &Source) -> Option<f64> {
        let value = match source {
            Source::Always => Some(1.0),
            Source::PadAxis { pad, axis } => self.pads.get(pad)?.axes.get(usize::from(*axis)).copied(),
            Source::PadButton { pad, button } => {
                self.pads.get(pad)?.buttons.get(usize::from(*button)).copied()
            }
            Source::Key(code) => self
                .keys
                .as_ref()
                .map(|keys| f64::from(u8::from(keys.contains(code)))),
            Source::TouchRight => self.touch.map(|[right, _]| right),
            Source::TouchUp => self.touch.map(|[_, up]| up),
            Source::TiltForward => self.tilt.map(|[forward, _]| forward),
            Source::TiltLeft => self.tilt.map(|[_, left]| left),
            Source::Client(name) => self.clients.get(name).copied(),
            Source::Switch(_) => None,
        };
        value.filter(|value| value.is_finite())
    }

    /// Notes what an input reads; its device is there from then on, the rest of it at rest. Whether it is an input that can
    /// be moved.
    pub fn set(&mut self, source: &Source, value: f64) -> bool {
        match source {
            Source::Always | Source::Switch(_) => return false,
            Source::PadAxis { pad, axis } => {
                self.note_word(*pad);
                put(&mut self.pads.entry(*pad).or_default().axes, *axis, value);
            }
            Source::PadButton { pad, button } => {
                self.note_word(*pad);
                put(&mut self.pads.entry(*pad).or_default().buttons, *button, value);
            }
            Source::Key(code) => {
                let keys = self.keys.get_or_insert_default();
                if value > 0.5 {
                    keys.insert(code.clone());
                } else {
                    keys.remove(code);
                }
            }
            Source::TouchRight => self.touch.get_or_insert_default()[0] = value,
            Source::TouchUp => self.touch.get_or_insert_default()[1] = value,
            Source::TiltForward => self.tilt.get_or_insert_default()[0] = value,
            Source::TiltLeft => self.tilt.get_or_insert_default()[1] = value,
            Source::Client(name) => {
                self.clients.insert(name.clone(), value);
            }
        }
        true
    }

    /// Notes that a pad has said something, whatever it was.
    pub fn note_word(&mut self, pad: u8) {
        if let Some(pad) = self.pads.get_mut(&pad) {
            pad.words = pad.words.wrapping_add(1);
        }
    }

    /// Notes that a device is gone.
    pub fn remove(&mut self, device: &Device) {
        match device {
            Device::Pad(pad) => {
                self.pads.remove(pad);
            }
            Device::Keyboard => self.keys = None,
            Device::Touch => self.touch = None,
            Device::Tilt => self.tilt = None,
            Device::Client(name) => {
                self.clients.remove(name);
            }
        }
    }

    /// All inputs of the devices that are there; of the keyboard those that are held.
    fn sources(&self) -> Vec<Source> {
        let mut all = Vec::new();
        for (pad, reading) in &self.pads {
            let pad = *pad;
            all.extend(
                (0..AXES)
                    .take(reading.axes.len())
                    .map(|axis| Source::PadAxis { pad, axis }),
            );
            all.extend(
                (0..BUTTONS)
                    .take(reading.buttons.len())
                    .map(|button| Source::PadButton { pad, button }),
            );
        }
        all.extend(self.keys.iter().flatten().cloned().map(Source::Key));
        all.extend(
            self.touch
                .iter()
                .flat_map(|_| [Source::TouchRight, Source::TouchUp]),
        );
        all.extend(
            self.tilt
                .iter()
                .flat_map(|_| [Source::TiltForward, Source::TiltLeft]),
        );
        all.extend(self.clients.keys().cloned().map(Source::Client));
        all
    }
}

fn put(all: &mut Vec<f64>, place: u8, value: f64) {
    let place = usize::from(place);
    if all.len() <= place {
        all.resize(place + 1, 0.0);
    }
    all[place] = value;
}

/// The input that moved most between two moments, if any moved as far as a person moves one on purpose.
#[must_use]
pub fn first_moved(before: &Readings, now: &Readings) -> Option<Source> {
    let way = |source: &Source| {
        let from = before.value(source).unwrap_or(0.0);
        now.value(source).map_or(0.0, |to| (to - from).abs())
    };
    now.sources()
        .into_iter()
        .filter(|source| source.device().is_some_and(|device| before.has(&device)))
        .map(|source| (way(&source), source))
        .filter(|(way, _)| *way >= MOVED)
        .max_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, source)| source)
}

#[cfg(test)]
mod tests {
    use super::{PadReading, Readings, first_moved};
    use crate::{KeyCode, Source};

    fn pad(axes: &[f64]) -> Readings {
        let reading = PadReading {
            axes: axes.to_vec(),
            buttons: vec![0.0],
            words: 0,
        };
        Readings {
            pads: [(0, reading)].into(),
            keys: Some([].into()),
            ..Readings::default()
        }
    }

    #[test]
    fn the_input_that_moved_most_is_learnt() {
        let rest = pad(&[0.1, 0.0]);
        assert_eq!(
            first_moved(&rest, &pad(&[0.4, 0.3])),
            None,
            "that is a stick that wanders"
        );
        assert_eq!(
            first_moved(&rest, &pad(&[0.7, -0.9])),
            Some(Source::PadAxis { pad: 0, axis: 1 })
        );
        let mut pressed = rest.clone();
        pressed.keys = Some(KeyCode::new("KeyQ").into_iter().collect());
        assert_eq!(
            first_moved(&rest, &pressed)
                .map(|source| source.to_string())
                .as_deref(),
            Some("key-KeyQ")
        );
        assert_eq!(
            first_moved(&Readings::default(), &pressed),
            None,
            "a device that appears was not moved"
        );
    }

    #[test]
    fn an_input_of_a_client_is_learnt_like_a_stick() {
        let steer: Source = "client-steer".parse().expect("an input");
        let mut rest = pad(&[0.0]);
        let mut moved = rest.clone();
        moved.set(&steer, -0.6);
        assert_eq!(first_moved(&rest, &moved), None, "it has just appeared");
        rest.set(&steer, 0.0);
        assert_eq!(first_moved(&rest, &moved), Some(steer));
    }

    #[test]
    fn what_is_set_is_read_until_its_device_is_gone() {
        for text in [
            "pad-1-axis-3",
            "pad-1-button-9",
            "key-KeyW",
            "touch-up",
            "touch-right",
            "tilt-left",
            "tilt-forward",
            "client-steer",
        ] {
            let source: Source = text.parse().expect("an input");
            let mut readings = Readings::default();
            assert!(readings.set(&source, 1.0));
            assert_eq!(readings.value(&source), Some(1.0), "{text}");
            assert!(readings.set(&source, 0.0));
            assert_eq!(readings.value(&source), Some(0.0), "{text}");
            readings.remove(&source.device().expect("a device"));
            assert_eq!(readings, Readings::default(), "{text}");
        }
        assert!(!Readings::default().set(&Source::Always, 1.0));
    }

    #[test]
    fn nonsense_is_absent() {
        let readings = pad(&[f64::NAN, f64::INFINITY]);
        for axis in 0..3 {
            assert_eq!(readings.value(&Source::PadAxis { pad: 0, axis }), None);
        }
    }
}
