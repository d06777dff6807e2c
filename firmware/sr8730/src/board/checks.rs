//! What the firmware checks of itself while it runs (S20, S21): clock, image, memory, stack.

use cordlib::board::HardwareFault;
use pic32mx3_hal::clock::{self, Running};
use pic32mx3_hal::interrupt::{Context, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{cpu, interrupt, memory, stack};

use super::bus_clock::BusClock;
use super::{off, tick};
use crate::logic::image_check::{ImageCheck, Verdict};
use crate::logic::pace::{Look, Pace, PaceCheck};

/// Words of memory tested in one millisecond: 32 KiB in four seconds.
const RAM_WORDS: u32 = 2;

/// The crystal has failed and the chip runs on its internal oscillator, at a tenth of its speed: everything off at once.
fn on_clock_failure(_: &mut Context<vector::CLOCK_MONITOR>) {
    off::everything();
    off::note_clock_failure();
    Source::ClockMonitor.clear();
    // The cause stays, so it would come again and again.
    Source::ClockMonitor.disable();
}
interrupt!(CLOCK_MONITOR, on_clock_failure);

/// The checks.
#[derive(Debug)]
pub struct SelfChecks {
    image: ImageCheck<'static>,
    ram_place: u32,
    ram_size: u32,
    bus: BusClock,
    pace: PaceCheck,
    started: bool,
}

impl SelfChecks {
    /// With the second clock.
    #[must_use]
    pub fn take(bus: BusClock) -> Self {
        interrupt::set_priority(Vector::ClockMonitor, Priority::Level6, SubPriority::Sub3).ok();
        Source::ClockMonitor.enable();
        Self {
            image: ImageCheck::new(
                [memory::image::program(), memory::image::boot()],
                memory::image::seal(),
            ),
            ram_place: 0,
            ram_size: memory::ram_size(),
            bus,
            pace: PaceCheck::new(Look::default(), BusClock::HALVES_PER_COUNT),
            started: false,
        }
    }

    /// The whole image, before anything moves: some 20 ms.
    #[must_use]
    pub fn image_at_start(&self) -> Verdict {
        self.image.all()
    }

    /// To be called once in a millisecond. What it finds is latched by cordlib and never forgiven by itself.
    pub fn service(&mut self) -> Option<HardwareFault> {
        let clock_is_well = !off::clock_has_failed() && !clock::has_failed() && self.pace_is_even();
        if !clock_is_well || clock::running() != Running::PrimaryPll {
            return Some(HardwareFault::Clock);
        }
        if self.image.slice() == Verdict::Damaged || !self.ram_holds() {
            return Some(HardwareFault::Memory);
        }
        (!stack::canary_is_alive()).then_some(HardwareFault::Memory)
    }

    fn pace_is_even(&mut self) -> bool {
        let look = Look {
            tick: tick::ticks(),
            core: cpu::count(),
            bus: self.bus.count(),
        };
        if !self.started {
            self.started = true;
            self.pace = PaceCheck::new(look, BusClock::HALVES_PER_COUNT);
        }
        self.pace.update(look) == Pace::Even
    }

    /// The next words of memory, variables and stack alike: each is held back for some microseconds with interrupts off, so
    /// that nobody sees it change.
    fn ram_holds(&mut self) -> bool {
        let mut holds = true;
        for _ in 0..RAM_WORDS {
            holds &= memory::test_ram_word(self.ram_place).unwrap_or(false);
            self.ram_place += 4;
            if self.ram_place >= self.ram_size {
                self.ram_place = 0;
            }
        }
        holds
    }
}
