//! Gamepads that say nothing more. A pad without power keeps its last position for up to half a minute, until the kernel gives
//! its connection up.

use std::collections::{BTreeMap, BTreeSet};

use crate::PadReading;

/// A pushed pad that says nothing for so long counts as gone. A thumb trembles some ten times a second by about a degree, and
/// even the coarsest pads, with 255 steps over forty degrees, tell most of that; two seconds leave room for a steady hand. A
/// robot at 0.3 m/s drives 0.6 m meanwhile.
pub const PAD_SILENT_US: u64 = 2_000_000;

/// When each pad was last heard, and which of them say nothing more.
#[derive(Clone, Debug, Default)]
pub struct PadWatch {
    heard: BTreeMap<u8, Heard>,
    silent: BTreeSet<u8>,
}

#[derive(Clone, Debug)]
struct Heard {
    reading: PadReading,
    when_us: u64,
}

impl PadWatch {
    /// Gives the pads that are pushed and say nothing. Such a pad stays among them until it says something. A pad at rest may
    /// be silent for ever.
    pub fn look(
        &mut self,
        now_us: u64,
        pads: &BTreeMap<u8, PadReading>,
        is_pushed: impl Fn(u8) -> bool,
    ) -> &BTreeSet<u8> {
        self.heard.retain(|pad, _| pads.contains_key(pad));
        self.silent.retain(|pad| pads.contains_key(pad));
        for (pad, reading) in pads {
            match self.heard.get(pad) {
                Some(heard) if heard.reading.says_the_same(reading) => {
                    let silent_us = now_us.saturating_sub(heard.when_us);
                    if silent_us >= PAD_SILENT_US && is_pushed(*pad) {
                        self.silent.insert(*pad);
                    }
                }
                _ => {
                    let (reading, when_us) = (reading.clone(), now_us);
                    self.heard.insert(*pad, Heard { reading, when_us });
                    self.silent.remove(pad);
                }
            }
        }
        &self.silent
    }
}

#[cfg(test)]
mod tests {
    use super::{PAD_SILENT_US, PadWatch};
    use crate::PadReading;

    fn reading(across: f64, words: u64) -> PadReading {
        PadReading {
            axes: vec![across, f64::NAN],
            words,
            ..PadReading::default()
        }
    }

    #[test]
    fn a_pushed_pad_is_silent_until_it_says_anything() {
        let mut watch = PadWatch::default();
        let mut silent = |now_us, reading: PadReading, pushed| {
            let pads = [(2, reading)].into();
            watch.look(now_us, &pads, |pad| pad == 2 && pushed).contains(&2)
        };
        assert!(!silent(0, reading(1.0, 0), true));
        assert!(!silent(PAD_SILENT_US - 1, reading(1.0, 0), true));
        assert!(silent(PAD_SILENT_US, reading(1.0, 0), true));
        assert!(
            silent(PAD_SILENT_US + 1, reading(1.0, 0), false),
            "who ignores it does not hear it"
        );
        let again_us = PAD_SILENT_US + 2;
        assert!(
            !silent(again_us, reading(1.0, 1), true),
            "the same position said once more is a word"
        );
        assert!(!silent(again_us + PAD_SILENT_US - 1, reading(1.0, 1), true));
        assert!(silent(again_us + PAD_SILENT_US, reading(1.0, 1), true));
        assert!(!silent(again_us + PAD_SILENT_US, reading(0.9, 1), true));
    }

    #[test]
    fn a_pad_at_rest_may_be_silent_and_is_not_when_it_is_pushed_at_last() {
        let mut watch = PadWatch::default();
        let mut silent = |now_us, across, pushed| {
            let pads = [(0, reading(across, 0))].into();
            !watch.look(now_us, &pads, |_| pushed).is_empty()
        };
        assert!(!silent(0, 0.0, false));
        let later_us = 100 * PAD_SILENT_US;
        assert!(!silent(later_us, 0.0, false));
        assert!(!silent(later_us + 1, 1.0, true));
        assert!(!silent(later_us + PAD_SILENT_US, 1.0, true));
        assert!(silent(later_us + 1 + PAD_SILENT_US, 1.0, true));
    }
}
