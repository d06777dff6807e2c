//! Idle and Sleep: what WAIT stops, and what makes it run again.

use super::schedule::Slot;
use super::{Chip, system};

/// What the chip does while the core is in WAIT.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum PowerState {
    /// All clocks run, whether or not the core waits.
    #[default]
    Running,
    /// Sleep: no clock runs.
    Asleep,
    /// The clock is starting.
    Waking,
    /// All clocks run again, but the core is still in the WAIT with which Sleep began.
    Woken,
}

impl Chip {
    /// Whether the core is in WAIT now.
    pub(crate) fn note_wait(&mut self, is_waiting: bool, cycle: u64) {
        match (self.power, is_waiting) {
            (PowerState::Running, true) if self.clock.sleeps() && self.interrupts.request().is_none() => {
                self.fall_asleep(cycle);
            }
            (PowerState::Running, true) => self.system.note_cause(system::IDLE_BIT),
            (PowerState::Woken, false) => self.power = PowerState::Running,
            _ => {}
        }
    }

    fn fall_asleep(&mut self, cycle: u64) {
        self.system.note_cause(system::SLEEP_BIT);
        self.power = PowerState::Asleep;
        self.advance_timers(cycle);
        let change = self.clock.fall_asleep();
        self.clock_changed(change, cycle);
    }

    /// Whether Sleep stops the core.
    pub(crate) fn is_asleep(&self) -> bool {
        matches!(self.power, PowerState::Asleep | PowerState::Waking)
    }

    /// A request of any level starts the clocks; whether the core leaves WAIT for it, is the core's business: below its own level
    /// it does not, and the chip is idle.
    pub(crate) fn wake_if_requested(&mut self, cycle: u64) {
        if self.power == PowerState::Asleep && self.interrupts.request().is_some() {
            self.power = PowerState::Waking;
            self.schedule.set(Slot::Wake, cycle + self.clock.wake_cycles());
        }
    }

    pub(super) fn serve_wake(&mut self, cycle: u64) {
        self.power = PowerState::Woken;
        self.start_clock(cycle);
        self.settle_dma();
    }

    fn start_clock(&mut self, cycle: u64) {
        let change = self.clock.wake();
        self.clock_changed(change, cycle);
    }

    /// The watchdog ended WAIT instead of resetting: a non-maskable interrupt by general knowledge of the family. The clock's own
    /// start is left out here.
    pub(crate) fn bark_at_idle(&mut self, cycle: u64) {
        let state = if self.is_asleep() {
            system::SLEEP_BIT
        } else {
            system::IDLE_BIT
        };
        self.system.note_cause(system::WATCHDOG_BIT | state);
        if self.is_asleep() {
            self.start_clock(cycle);
        }
        self.power = PowerState::Running;
        self.restart_watchdog(cycle);
    }
}
