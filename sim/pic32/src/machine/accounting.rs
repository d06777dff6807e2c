//! Accounting of time: cycles by interrupt vector and priority level, interrupt latency, idle time, the stack.

use super::Machine;
use crate::peripheral::VECTORS;

/// One interrupt vector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VectorAccount {
    /// How often its handler was entered.
    pub entries: u64,
    /// Cycles in its handler, those of handlers that interrupted it left out.
    pub cycles: u64,
    /// The longest stay in its handler, those of handlers that interrupted it left out.
    pub longest_cycles: u64,
    /// The longest time from a flag to the first instruction of the handler.
    pub worst_latency_cycles: u64,
}

/// Where the time went, in cycles of the 80 MHz time base.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accounting {
    vectors: [VectorAccount; VECTORS],
    levels: [u64; 8],
    idle_cycles: u64,
    since: u64,
    charged_to: u64,
    active: Vec<ActiveHandler>,
}

/// A handler that was entered and not left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ActiveHandler {
    vector: u8,
    level: u8,
    cycles: u64,
}

impl Accounting {
    pub(super) fn new(cycle: u64) -> Accounting {
        Accounting {
            vectors: [VectorAccount::default(); VECTORS],
            levels: [0; 8],
            idle_cycles: 0,
            since: cycle,
            charged_to: cycle,
            active: Vec::new(),
        }
    }

    /// An account for vector 0..=44; nothing for others.
    pub fn vector(&self, vector: u8) -> Option<VectorAccount> {
        self.vectors.get(usize::from(vector)).copied()
    }

    /// All vectors that were entered, ascending.
    pub fn vectors(&self) -> impl Iterator<Item = (u8, VectorAccount)> + '_ {
        (0..).zip(self.vectors).filter(|(_, account)| account.entries > 0)
    }

    /// How often any handler was entered.
    pub fn entries(&self) -> u64 {
        self.vectors.iter().map(|account| account.entries).sum()
    }

    /// Cycles at a priority level, 1..=7; level 0 is the main program, WAIT included.
    pub fn level_cycles(&self, level: u8) -> u64 {
        self.levels.get(usize::from(level)).copied().unwrap_or(0)
    }

    /// Cycles in WAIT.
    pub fn idle_cycles(&self) -> u64 {
        self.idle_cycles
    }

    /// Cycles from the begin of the account up to `cycle`.
    pub fn total_cycles(&self, cycle: u64) -> u64 {
        cycle.saturating_sub(self.since)
    }

    /// The share of the time that the core spent in WAIT, 0..=1.
    #[expect(clippy::cast_precision_loss, reason = "a share for people")]
    pub fn idle_share(&self, cycle: u64) -> f64 {
        self.idle_cycles as f64 / self.total_cycles(cycle).max(1) as f64
    }

    pub(super) fn enter(&mut self, (vector, level): (u8, u8), cycle: u64, raised_at: Option<u64>) {
        self.charge(cycle);
        self.active.push(ActiveHandler {
            vector,
            level,
            cycles: 0,
        });
        if let Some(account) = self.vectors.get_mut(usize::from(vector)) {
            account.entries += 1;
            let latency = raised_at.map_or(0, |raised| cycle.saturating_sub(raised));
            account.worst_latency_cycles = account.worst_latency_cycles.max(latency);
        }
    }

    /// A handler, or something else that ends with ERET, is left.
    pub(super) fn leave(&mut self, cycle: u64) {
        self.charge(cycle);
        if let Some(ActiveHandler { vector, cycles, .. }) = self.active.pop()
            && let Some(account) = self.vectors.get_mut(usize::from(vector))
        {
            account.longest_cycles = account.longest_cycles.max(cycles);
        }
    }

    /// Charges the time up to `cycle` to its owner.
    pub(super) fn charge(&mut self, cycle: u64) {
        let passed = cycle.saturating_sub(self.charged_to);
        self.charged_to = self.charged_to.max(cycle);
        let Some(active) = self.active.last_mut() else {
            self.levels[0] += passed;
            return;
        };
        active.cycles += passed;
        self.levels[usize::from(active.level & 7)] += passed;
        if let Some(account) = self.vectors.get_mut(usize::from(active.vector)) {
            account.cycles += passed;
        }
    }

    pub(super) fn add_idle(&mut self, cycles: u64) {
        self.idle_cycles += cycles;
    }

    /// Begins again; handlers that are active stay so.
    pub(super) fn restart(&mut self, cycle: u64) {
        let active = std::mem::take(&mut self.active);
        *self = Accounting {
            active,
            ..Accounting::new(cycle)
        };
    }

    /// A reset: no handler is active any more.
    pub(super) fn forget_active(&mut self, cycle: u64) {
        self.charge(cycle);
        self.active.clear();
    }
}

impl Machine {
    /// Where the time went.
    pub fn accounting(&self) -> &Accounting {
        &self.accounting
    }

    /// Begins a new account; handlers that are active go on in it. The deepest stack is forgotten, too.
    pub fn restart_accounting(&mut self) {
        self.accounting.restart(self.cycle);
        self.cpu.clear_deepest_stack();
    }

    /// The lowest value of the stack pointer on entering a function; nothing before the first.
    pub fn deepest_stack(&self) -> Option<u32> {
        self.cpu.deepest_stack()
    }
}
