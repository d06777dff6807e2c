//! Where the time goes: handlers of interrupts, sleep, and the rest.

use crate::peripheral::{SOURCES, Source};

/// What the handler of one interrupt took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SourceAccount {
    /// How often it was called.
    pub calls: u64,
    /// Cycles in it, without those of handlers that interrupted it.
    pub cycles: u64,
    /// The longest of its calls, counted alike.
    pub longest_cycles: u64,
}

/// A handler that was called and has not returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct OpenCall {
    source: usize,
    cycles: u64,
}

/// The account since power-on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Account {
    sources: [SourceAccount; SOURCES],
    active: Vec<OpenCall>,
    idle_cycles: u64,
    charged_to: u64,
}

/// Four levels can interrupt one another; a program that returns wrongly may look deeper.
const DEPTH_MAX: usize = 4;

impl Account {
    /// What the handler of this interrupt took.
    #[must_use]
    pub fn of(&self, source: Source) -> SourceAccount {
        self.sources[source.number()]
    }

    /// Cycles in which the core slept.
    #[must_use]
    pub fn idle_cycles(&self) -> u64 {
        self.idle_cycles
    }

    pub(super) fn enter(&mut self, source: Source, cycle: u64) {
        self.charge(cycle);
        self.sources[source.number()].calls += 1;
        if self.active.len() < DEPTH_MAX {
            self.active.push(OpenCall {
                source: source.number(),
                cycles: 0,
            });
        }
    }

    pub(super) fn leave(&mut self, cycle: u64) {
        self.charge(cycle);
        if let Some(OpenCall { source, cycles }) = self.active.pop() {
            let account = &mut self.sources[source];
            account.longest_cycles = account.longest_cycles.max(cycles);
        }
    }

    /// Charges the time up to `cycle` to the handler that is active.
    pub(super) fn charge(&mut self, cycle: u64) {
        let passed = cycle.saturating_sub(self.charged_to);
        self.charged_to = self.charged_to.max(cycle);
        if let Some(active) = self.active.last_mut() {
            active.cycles += passed;
            self.sources[active.source].cycles += passed;
        }
    }

    pub(super) fn add_idle(&mut self, cycles: u64) {
        self.idle_cycles += cycles;
    }

    /// A reset: no handler is active any more.
    pub(super) fn forget_active(&mut self, cycle: u64) {
        self.charge(cycle);
        self.active.clear();
    }
}
