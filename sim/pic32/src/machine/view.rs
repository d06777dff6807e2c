//! The core's view of the peripherals: the chip, in the core's own cycles.

use super::accounting::Accounting;
use super::core_clock::CoreClock;
use crate::cpu::{Access, Bus, BusFault, Taken};
use crate::peripheral::Chip;

pub(super) struct View<'a> {
    pub(super) chip: &'a mut Chip,
    pub(super) clock: CoreClock,
    pub(super) accounting: &'a mut Accounting,
}

impl View<'_> {
    fn in_base(&self, access: Access) -> Access {
        Access {
            cycle: self.clock.base_of(access.cycle),
            ..access
        }
    }
}

impl Bus for View<'_> {
    fn load(&mut self, access: Access) -> Result<u32, BusFault> {
        Ok(self.chip.load(self.in_base(access)))
    }

    fn store(&mut self, access: Access, value: u32) -> Result<(), BusFault> {
        self.chip.store(self.in_base(access), value);
        Ok(())
    }

    fn horizon(&self) -> u64 {
        match self.chip.next_event() {
            u64::MAX => u64::MAX,
            cycle => self.clock.core_of(cycle),
        }
    }

    fn waits(&mut self, cycle: u64) {
        self.chip.note_wait(true, self.clock.base_of(cycle));
    }

    fn interrupt_taken(&mut self, taken: Taken) {
        let cycle = self.clock.base_of(taken.cycle);
        let vector = self.chip.requested_vector().unwrap_or(taken.request.vector);
        let raised_at = self.chip.raised_at(vector);
        self.accounting
            .enter((vector, taken.request.level), cycle, raised_at);
    }

    fn exception_returned(&mut self, cycle: u64) {
        self.accounting.leave(self.clock.base_of(cycle));
    }
}
