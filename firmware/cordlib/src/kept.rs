//! What outlives a reset: latches, faults and clocks of the charger, the cause of the last stop (S4, S18).
//!
//! The record goes into the board's [`KeptMemory`] in the pass in which a latch changes, and every ten seconds for the sake
//! of the clocks. A clock that ran counts the seconds that were not stored as well, so that resets make no charge longer.

use rvac_protocol::message::{ChargeFault, Inhibit, Inhibits, LogLevel, ResetCause};
use rvac_units::{Throttle, Tick};

use crate::board::{KEPT_WORDS, KeptMemory, KeptWords, Parts};
use crate::charge::ChargeMemory;
use crate::cord::Cord;
use crate::journal::Journal;
use crate::timing::Periodic;

/// Layout of the record, also the numbers of charger faults in it. Another layout counts as no record.
const LAYOUT: u8 = 1;
/// The clocks are stored at this period.
pub(crate) const CLOCKS_MS: u32 = 10_000;
/// Words of [`KeptRecord::events`]; the others are clocks.
const EVENT_WORDS: usize = 3;
/// Words of the log.
const KEPT: &str = "kept over the reset:";
const FLOWS: u8 = 1;
const FORBIDDEN: u8 = 2;

/// The record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct KeptRecord {
    pub(crate) latched: Inhibits,
    /// Levels of the battery that are active, as its rule packs them.
    pub(crate) battery: u8,
    /// What inhibited when motion ended last; none if a command ended it.
    pub(crate) last_stop: Inhibits,
    pub(crate) charge: ChargeMemory,
}

impl KeptRecord {
    /// What changes with a latch or a stop, not with time.
    fn events(&self) -> [u32; EVENT_WORDS] {
        let fault = self.charge.fault.map_or(0, |fault| fault as u8 + 1);
        let flows = if self.charge.flows { FLOWS } else { 0 };
        let forbidden = if self.charge.forbidden { FORBIDDEN } else { 0 };
        [
            u32::from_le_bytes([LAYOUT, fault, self.battery, flows | forbidden]),
            self.latched.bits(),
            self.last_stop.bits(),
        ]
    }

    fn words(&self) -> KeptWords {
        let mut words = [0; KEPT_WORDS];
        let all = self.events().into_iter().chain(self.charge.words());
        for (place, word) in words.iter_mut().zip(all) {
            *place = word;
        }
        words
    }

    /// The record of these words; `None` if they have another layout.
    fn from_words(words: &KeptWords) -> Option<Self> {
        let ([head, latched, last_stop], clocks) = words.split_first_chunk::<EVENT_WORDS>()?;
        let [layout, fault, battery, flags] = head.to_le_bytes();
        if layout != LAYOUT {
            return None;
        }
        let fault = match fault {
            0 => None,
            number => Some(ChargeFault::ALL.get(usize::from(number) - 1).copied()?),
        };
        let mut charge = ChargeMemory::from_words(*clocks.first_chunk()?);
        charge.fault = fault;
        charge.flows = flags & FLOWS != 0;
        charge.forbidden = flags & FORBIDDEN != 0;
        Some(Self {
            latched: Inhibits::from_bits(latched & LATCHED.bits()),
            battery,
            last_stop: Inhibits::from_bits(*last_stop),
            charge,
        })
    }

    /// What the memory holds from before the reset.
    pub(crate) fn load<M: KeptMemory>(memory: &mut M) -> Option<Self> {
        memory.load().as_ref().and_then(Self::from_words)
    }
}

/// Every latched inhibit but the charger's, which follow from its fault.
const LATCHED: Inhibits = {
    let mut latched = Inhibits::NONE;
    let mut place = 0;
    while place < Inhibit::ALL.len() {
        let inhibit = Inhibit::ALL[place];
        if inhibit.is_latched() {
            latched.insert(inhibit);
        }
        place += 1;
    }
    latched.remove(Inhibit::ChargerFault);
    latched.remove(Inhibit::ChargerShorted);
    latched
};

/// What is stored and when it is stored again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keeper {
    stored: Option<[u32; EVENT_WORDS]>,
    clocks: Periodic,
    last_stop: Inhibits,
    moved: bool,
}

impl Keeper {
    /// Goes on from what was taken up.
    pub(crate) fn starting_at(now: Tick, taken_up: Option<&KeptRecord>) -> Self {
        Self {
            stored: None,
            clocks: Periodic::starting_at(now.after(CLOCKS_MS)),
            last_stop: taken_up.map_or(Inhibits::NONE, |record| record.last_stop),
            moved: false,
        }
    }
}

impl Journal {
    /// A log that begins with what was taken up from before the reset, and with what was lost.
    pub(crate) fn of_start(taken_up: Option<&KeptRecord>, cause: ResetCause) -> Self {
        let mut journal = Self::default();
        let Some(record) = taken_up else {
            let (level, what) = match cause {
                ResetCause::PowerOn => (LogLevel::Info, "power was off:"),
                _ => (LogLevel::Warn, "lost in the reset:"),
            };
            journal.note(level, what, "latches, charger faults, charge clocks");
            return journal;
        };
        journal.note_each("last stop before the reset:", record.last_stop);
        if record.charge.has_charge() {
            journal.note(LogLevel::Warn, KEPT, "clocks of the charge");
        }
        if let Some(fault) = record.charge.fault {
            journal.note(LogLevel::Warn, KEPT, fault.name());
        }
        journal.note_each(KEPT, record.latched);
        journal
    }

    fn note_each(&mut self, what: &'static str, inhibits: Inhibits) {
        for inhibit in inhibits.iter() {
            self.note(LogLevel::Warn, what, inhibit.name());
        }
    }
}

impl<P: Parts> Cord<P> {
    /// Stores what a reset must not take away, if it has changed or is due. Called at the end of every pass.
    // Called from two places, and flash is scarce.
    #[inline(never)]
    pub(crate) fn keep(&mut self, now: Tick) {
        self.note_stop();
        let record = KeptRecord {
            latched: self.reflexes.latched(),
            battery: self.reflexes.battery().kept(),
            last_stop: self.keeper.last_stop,
            charge: self.charger.memory(),
        };
        let events = Some(record.events());
        let due = self.keeper.clocks.is_due(now, CLOCKS_MS);
        if due || events != self.keeper.stored {
            self.keeper.stored = events;
            self.board.kept.store(&record.words());
        }
    }

    /// Motion that ends is noted with all that inhibits then.
    fn note_stop(&mut self) {
        let moves = self.wheel_outputs() != (Throttle::ZERO, Throttle::ZERO) || self.cleaning.is_running();
        if self.keeper.moved && !moves {
            self.keeper.last_stop = self.inhibits();
        }
        self.keeper.moved = moves;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{KeptRecord, LATCHED, LAYOUT};
    use crate::board::KEPT_WORDS;
    use rvac_protocol::message::{ChargeFault, Inhibit, Inhibits};
    use std::vec::Vec;

    fn words(fault: u8, flags: u8) -> [u32; KEPT_WORDS] {
        let mut words = core::array::from_fn(|place| 1_000 + place as u32);
        words[0] = u32::from_le_bytes([LAYOUT, fault, 0b1011, flags]);
        words[1] = LATCHED.bits();
        words[2] = 1 << Inhibit::Bumper as u32;
        words
    }

    #[test]
    fn a_record_comes_back_word_for_word() {
        for fault in 0..=ChargeFault::ALL.len() as u8 {
            for flags in 0..4 {
                let record = KeptRecord::from_words(&words(fault, flags)).unwrap();
                assert_eq!(record.words(), words(fault, flags));
            }
        }
        assert!(KeptRecord::from_words(&words(ChargeFault::ALL.len() as u8 + 1, 0)).is_none());
    }

    #[test]
    fn another_layout_and_foreign_bits_are_not_taken_up() {
        let mut other = words(0, 0);
        other[0] = other[0] & !0xFF | u32::from(LAYOUT + 1);
        assert!(KeptRecord::from_words(&other).is_none());
        let mut all = words(0, 0);
        all[1] = u32::MAX;
        let record = KeptRecord::from_words(&all).unwrap();
        assert_eq!(record.latched, LATCHED);
        assert!(
            !record.latched.contains(Inhibit::Docked) && !record.latched.contains(Inhibit::ChargerShorted)
        );
        assert_ne!(record.latched, Inhibits::NONE);
    }

    /// The numbers of faults are part of the layout: when these names change, so must [`LAYOUT`].
    #[test]
    fn the_layout_numbers_the_faults_in_this_order() {
        let names: Vec<&str> = ChargeFault::ALL.into_iter().map(ChargeFault::name).collect();
        let known = "too-hot over-current shorted current-zero no-current stale thermistor-open thermistor-shorted \
                     thermistor-range thermistor-jump thermistor-frozen voltage-jump adapter no-battery \
                     deep-discharge precharge contact repeated";
        assert_eq!(names.join(" "), known);
    }
}
