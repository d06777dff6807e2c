//! Self-checks of the running firmware (S20, S21): clock, image, memory, stack, registers of the motors.

use cordlib::board::{HardwareChecks, HardwareFault};
use pic32mx3_hal::clock::{self, Running};
use pic32mx3_hal::interrupt::{Context, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::pwm::{PwmTimer, TimeBase};
use pic32mx3_hal::{cpu, interrupt, memory, stack};

use super::bus_clock::BusClock;
use super::{off, tick};
use crate::generated::pins::{self, Signal};
use crate::logic::clock_check::{ClockAgreement, ClockCheck, ClockSample};
use crate::logic::image_check::{ImageCheck, ImageState};
use crate::logic::image_sums::{ImageSums, sum};
use crate::logic::reset_log::FatalCause;

/// Words of memory tested in one millisecond: 32 KiB in four seconds.
const RAM_WORDS: u32 = 2;

/// Signals that output compares drive with pulses of the motors' time base, and the number of each one's output
/// compare. All are on one port. The latches beneath stay low, so that a pin is low when its output compare is off.
const PULSED: [(u8, Signal); 4] = [
    (1, pins::WHEEL_LEFT_ENABLE),
    (2, pins::BRUSH_MAIN_ENABLE),
    (3, pins::CHARGE_ENABLE),
    (4, pins::WHEEL_RIGHT_ENABLE),
];

/// The crystal has failed and the chip runs on its internal oscillator at a tenth of its speed: switches everything
/// off.
fn on_clock_failure(_: &mut Context<vector::CLOCK_MONITOR>) {
    off::everything();
    off::note_clock_failure();
    Source::ClockMonitor.clear();
    // The cause remains, so the interrupt would repeat.
    Source::ClockMonitor.disable();
}
interrupt!(CLOCK_MONITOR, on_clock_failure);

/// The checks, and the faults that stand.
#[derive(Debug)]
pub struct SelfChecks {
    image: ImageCheck<'static>,
    sums: ImageSums,
    ram_place: u32,
    ram_size: u32,
    bus: BusClock,
    pulses: TimeBase<3>,
    pace: ClockCheck,
    started: bool,
    /// The whole image and memory at the start; any fault stands until the next start.
    at_start: StartVerdict,
    clock_fails: bool,
}

/// Result of the checks before anything moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartVerdict {
    /// No fault.
    Sound,
    /// The image in flash differs from its checksum.
    DamagedImage,
    /// The image carries no checksum.
    UncheckedImage,
    /// A cell of memory is faulty.
    FaultyMemory,
}

impl SelfChecks {
    /// With the second clock, and the time base of motors and charger.
    #[must_use]
    pub fn take(bus: BusClock, pulses: &PwmTimer<3>) -> Self {
        interrupt::set_priority(Vector::ClockMonitor, Priority::Level6, SubPriority::Sub3).ok();
        Source::ClockMonitor.enable();
        let program = memory::image::program();
        Self {
            image: ImageCheck::new([program, memory::image::boot()], memory::image::check_words()),
            // Taken before the whole image is checked, so that changes in between are found as well.
            sums: ImageSums::new(program.len() as u32 / 4, block_sum),
            ram_place: 0,
            ram_size: memory::ram_size(),
            bus,
            pulses: TimeBase::of(pulses),
            pace: ClockCheck::new(ClockSample::default(), BusClock::HALVES_PER_COUNT),
            started: false,
            at_start: StartVerdict::Sound,
            clock_fails: false,
        }
    }

    /// The whole image and all of memory, before anything moves: some 25 ms. The march test of the start-up code leaves out
    /// the memory that survives a reset.
    pub fn check_at_start(&mut self) -> StartVerdict {
        self.at_start = match self.image.all() {
            ImageState::Damaged => StartVerdict::DamagedImage,
            ImageState::Unchecked => StartVerdict::UncheckedImage,
            ImageState::Whole if !self.all_ram_holds() => StartVerdict::FaultyMemory,
            ImageState::Whole => StartVerdict::Sound,
        };
        if self.at_start != StartVerdict::Sound {
            // Damaged code has assembled the board and may have switched anything on.
            off::everything();
        }
        self.at_start
    }

    /// Called once a millisecond. Gives damage of code, memory or registers, after which only a reset helps: the start
    /// checks all of it. What was damaged at the start already is kept off here, and the checks, which may be damaged
    /// themselves, rest.
    pub fn service(&mut self) -> Option<FatalCause> {
        if self.at_start != StartVerdict::Sound {
            off::everything();
            return None;
        }
        if !self.sums.is_next_whole(block_sum) || self.image.slice() == ImageState::Damaged {
            return Some(FatalCause::Flash);
        }
        if !self.ram_holds() {
            return Some(FatalCause::Memory);
        }
        if !stack::canary_is_alive() {
            return Some(FatalCause::Stack);
        }
        if !self.pulses_hold() {
            return Some(FatalCause::Register);
        }
        let has_failed = off::clock_has_failed() || clock::has_failed();
        self.clock_fails = has_failed || clock::running() != Running::PrimaryPll || !self.clocks_agree();
        None
    }

    /// Whether a width of 0 still switches motors and charger off.
    fn pulses_hold(&self) -> bool {
        let obeys = |(compare, signal): (u8, Signal)| {
            let latched_high = off::port(signal).latch() & off::mask(signal) != 0;
            self.pulses.governs(compare) && !latched_high
        };
        self.pulses.holds() && PULSED.into_iter().all(obeys)
    }

    fn clocks_agree(&mut self) -> bool {
        let look = ClockSample {
            tick: tick::ticks(),
            core: cpu::count(),
            bus: self.bus.count(),
        };
        if !self.started {
            self.started = true;
            self.pace = ClockCheck::new(look, BusClock::HALVES_PER_COUNT);
        }
        self.pace.update(look) == ClockAgreement::Even
    }

    /// Tests the next words of memory, variables and stack alike. Interrupts are off for some microseconds, so that no
    /// code sees the words change.
    fn ram_holds(&mut self) -> bool {
        self.words_hold(RAM_WORDS)
    }

    fn all_ram_holds(&mut self) -> bool {
        self.words_hold(self.ram_size / 4)
    }

    fn words_hold(&mut self, words: u32) -> bool {
        let mut holds = true;
        for _ in 0..words {
            holds &= memory::test_ram_word(self.ram_place).unwrap_or(false);
            self.ram_place += 4;
            if self.ram_place >= self.ram_size {
                self.ram_place = 0;
            }
        }
        holds
    }
}

impl HardwareChecks for SelfChecks {
    fn stands(&mut self, fault: HardwareFault) -> bool {
        match fault {
            HardwareFault::Clock => self.clock_fails,
            HardwareFault::Memory => {
                matches!(
                    self.at_start,
                    StartVerdict::DamagedImage | StartVerdict::FaultyMemory
                )
            }
            HardwareFault::Internal => self.at_start == StartVerdict::UncheckedImage,
        }
    }
}

fn block_sum(first_word: u32, words: u32) -> u32 {
    sum(memory::flash_words(first_word * 4, words))
}
