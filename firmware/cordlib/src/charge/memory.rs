//! What a charger keeps over a reset: its fault, the faults of the day, and how long and how much it has charged.

use rvac_protocol::message::{ChargeFault, ChargePhase};

use super::controller::ChargeController;
use super::guard::Guard;
use super::history::History;
use super::phases::{ChargeRecord, Rest};
use super::stops::Stops;

/// Clocks of a charger that must not begin anew with a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChargeMemory {
    /// The fault that no person has cleared yet.
    pub(crate) fault: Option<ChargeFault>,
    /// Current flowed when this was noted.
    pub(crate) flows: bool,
    /// The host wanted no charge.
    pub(crate) forbidden: bool,
    history: History,
    guard: Guard,
    charge: ChargeRecord,
    rest: Rest,
}

impl ChargeMemory {
    /// Words in the kept record, besides fault and flags.
    pub(crate) const WORDS: usize = History::WORDS + Guard::WORDS + ChargeRecord::WORDS + Rest::WORDS;

    /// The clocks, for the kept record.
    pub(crate) fn words(&self) -> [u32; Self::WORDS] {
        let [first, second, third, maintained, week] = self.history.words();
        let [flow, off] = self.guard.words();
        let [flowed, charged, start, paused, precharge] = self.charge.words();
        let [left, recharge] = self.rest.words();
        [
            first, second, third, maintained, week, flow, off, flowed, charged, start, paused, precharge,
            left, recharge,
        ]
    }

    /// From the kept record, without fault and flags.
    pub(crate) fn from_words(words: [u32; Self::WORDS]) -> Self {
        let [
            first,
            second,
            third,
            maintained,
            week,
            flow,
            off,
            flowed,
            charged,
            start,
            paused,
            precharge,
            left,
            recharge,
        ] = words;
        Self {
            fault: None,
            flows: false,
            forbidden: false,
            history: History::from_words([first, second, third, maintained, week]),
            guard: Guard::from_words([flow, off]),
            charge: ChargeRecord::from_words([flowed, charged, start, paused, precharge]),
            rest: Rest::from_words([left, recharge]),
        }
    }

    /// Whether a charge was under way or had ended a short time ago.
    pub(crate) fn has_charge(&self) -> bool {
        self.charge.has_begun()
    }
}

impl<S: Stops> ChargeController<S> {
    /// What is to be kept over a reset.
    #[must_use]
    pub fn memory(&self) -> ChargeMemory {
        ChargeMemory {
            fault: self.fault,
            flows: self.charge.flows(),
            forbidden: self.rest.is_forbidden(),
            history: self.history,
            guard: self.guard,
            charge: self.charge,
            rest: self.rest,
        }
    }

    /// Goes on where the charger stood before a reset. The memory may be `unseen_ms` old: if current flowed when it was
    /// noted, it counts as having flowed all that time, so that no number of resets makes a charge longer.
    #[must_use]
    pub fn taking_up(mut self, memory: &ChargeMemory, unseen_ms: u32) -> Self {
        self.history = memory.history;
        self.guard = memory.guard;
        self.charge = memory.charge.interrupted();
        self.rest = memory.rest;
        if memory.forbidden {
            self.rest.forbid();
        }
        if memory.flows {
            let full_ma = u32::try_from(self.scale.full_ma()).unwrap_or(0);
            self.charge.note_flow(unseen_ms, full_ma);
            self.guard.note_flow(unseen_ms);
        }
        self.fault = memory.fault;
        if self.fault.is_some() {
            self.phase = ChargePhase::Fault;
        }
        self
    }
}
