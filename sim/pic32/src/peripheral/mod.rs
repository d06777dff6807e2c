//! Everything of the chip except core and memories: the special function registers and the peripherals behind them.
//!
//! Nothing is polled. Each part returns the cycle at which it must be called next (`schedule.rs`); what can be worked
//! out when it is asked for (timer counts, PWM) has no events at all.
//!
//! | part | what is modelled | what is doubtful or left out |
//! | --- | --- | --- |
//! | interrupts | priorities, sub-priorities, natural order, level-type sources, one or many vectors, shadow set | the proximity timer only stores |
//! | Sleep and Idle | clocks that stop, what wakes, start-up of crystal and PLL, the watchdog's interrupt | the core timer goes on in Idle; what takes the clock of the analog converter's own oscillator |
//! | clock | all oscillators, PLL, PBDIV, switching, the monitor, SYSKEY | 2 ms until the monitor acts, 10 us for a switch: no source has them; start-up takes no time |
//! | watchdog, resets | WDTPS, feeding, RCON, software reset; out of Idle a non-maskable interrupt | LPRC is 32 kHz exactly |
//! | flash | keys, word, row, page and all, protection, the core's wait | durations are the longest that are told |
//! | ports | bits of the 100-pin part, TRIS, LAT, PORT, ODC, pull-ups, analog pins, JTAG, trace and crystal | inputs are seen at once |
//! | change notice | mismatch against the last reading of the port, as a level | edges of PWM are not seen by it |
//! | timers | prescalers, pairs, gate, external clock, period + 1 | PR = 0 stands still |
//! | output compare | all modes; duty taken over at the match; exact high time | the fault input; the first period after switching on |
//! | input capture | all modes, queue of 4, overflow | interrupts in Sleep |
//! | analog converter | all triggers, scan, alternation, halves, CLRASAM, all forms, TAD | other references, the negative input |
//! | UART | queues of 4, parity, 9 bits, break, framing, overrun, loopback, as levels on pins | flow control, infrared, wake-up, hardware auto-baud |
//! | SPI | master, slave, framed; 8, 16, 32 bits; both buffers, overrun, clock edges, select | unloaded slaves, exact frame pulses |
//! | I2C | master step by step, slave with 7 and 10 bits, masks, general call, stretching, collisions | slew rates; losing the bus |
//! | comparators, reference | all inputs, polarity, events, pins, Sleep | looked at each 300 ns; no offset; the reference on its pin or from pins |
//! | calendar | digits, leap years, alarm, calibration, the lock | its output pin |
//! | parallel port | both master modes, the three slave modes, 8 and 16 bits, waits, strobes, selects, increments, events | addresses on data lines |
//! | DMA | channels with cells, start and abort events, patterns, chains, priorities, CRC; a disturbed SYSKEY | the core does not wait; how long an access takes; Idle |

mod access;
mod analog;
mod buses;
mod calendar;
mod capture;
mod clock;
mod comparators;
mod compare;
mod configuration;
mod counter;
mod dma;
mod events;
mod i2c;
mod inputs;
mod interrupts;
mod matrix;
mod notice;
mod nvm;
mod pads;
mod parallel;
mod ports;
mod power;
mod pulse;
mod rate;
mod record;
mod register;
mod schedule;
mod serial;
mod spi;
mod system;
mod timers;

pub use dma::DmaRequests;
pub use rate::{CYCLES_PER_S, NEVER, Rate};
pub use record::{AccessDirection, Misuse, MisuseRecord, UnknownAccess, Unmodelled};
pub use serial::Sent;
pub use system::ResetSource;

pub(crate) use interrupts::{Irq, VECTORS};
pub(crate) use nvm::{NvmOperation, PAGE_BYTES, ROW_BYTES};

use crate::cpu::InterruptRequest;
use crate::memory::FlashTiming;
use crate::pins::Port;
use analog::AdcModule;
use calendar::Calendar;
use capture::Capture;
use clock::{Change, Clock};
use comparators::Comparators;
use compare::Compare;
use configuration::Configuration;
use dma::Dma;
use i2c::I2c;
use inputs::InputQueue;
use interrupts::Interrupts;
use matrix::Matrix;
use notice::ChangeNotice;
use nvm::Nvm;
use parallel::ParallelPort;
use ports::Ports;
use power::PowerState;
use rate::Now;
use record::{AccessRecord, AccessSite};
use schedule::{Schedule, Slot};
use serial::Serial;
use spi::Spi;
use std::ops::Range;
use system::{SystemRegisters, Watchdog};
use timers::Timers;

/// Requests of the peripherals to core and memories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// The chip is to be reset.
    Reset(ResetSource),
    /// The watchdog barks: a reset, or a non-maskable interrupt if the core is in WAIT.
    Bark,
    /// The system clock is another one.
    Clock,
    /// Wait states or the executable part of RAM are other ones.
    Matrix,
    /// A flash operation begins.
    Flash(NvmOperation),
    /// DMA moves something that was due at this cycle.
    Dma { cycle: u64 },
}

/// The peripherals, and what the outside does to the pins.
#[derive(Clone, Debug)]
pub(crate) struct Chip {
    pub(crate) record: AccessRecord,
    schedule: Schedule,
    /// The core must stop before its next instruction: there are orders, or the request is another one.
    attention: bool,
    orders: Vec<Order>,
    offered: Option<InterruptRequest>,
    interrupts: Interrupts,
    clock: Clock,
    power: PowerState,
    system: SystemRegisters,
    watchdog: Watchdog,
    nvm: Nvm,
    matrix: Matrix,
    ports: Ports,
    notice: ChangeNotice,
    timers: Timers,
    compares: [Compare; 5],
    captures: [Capture; 5],
    analog: AdcModule,
    comparators: Comparators,
    calendar: Calendar,
    serials: [Serial; 2],
    spis: [Spi; 2],
    i2cs: [I2c; 2],
    parallel: ParallelPort,
    dma: Dma,
    inputs: InputQueue,
}

impl Chip {
    /// A chip with these configuration words (DEVCFG3 to DEVCFG0), right after power-on.
    pub(crate) fn new(configuration: [u8; 16]) -> Chip {
        let clock = Clock::new(Configuration::of(configuration));
        let watchdog = Watchdog::new(clock.configuration(), 0);
        let mut chip = Chip {
            record: AccessRecord::default(),
            schedule: Schedule::new(),
            attention: false,
            orders: Vec::new(),
            offered: None,
            interrupts: Interrupts::new(),
            clock,
            power: PowerState::default(),
            system: SystemRegisters::new(),
            watchdog,
            nvm: Nvm::new(),
            matrix: Matrix::new(),
            ports: Ports::new(),
            notice: ChangeNotice::new(),
            timers: Timers::new(),
            compares: [const { Compare::OFF }; 5],
            captures: std::array::from_fn(|_| Capture::default()),
            analog: AdcModule::new(),
            comparators: Comparators::new(),
            calendar: Calendar::new(),
            serials: [Serial::new(), Serial::new()],
            spis: std::array::from_fn(|_| Spi::default()),
            i2cs: [I2c::new(), I2c::new()],
            parallel: ParallelPort::default(),
            dma: Dma::new(DmaRequests::default()),
            inputs: InputQueue::default(),
        };
        chip.begin(0);
        chip
    }

    /// Resets all registers. What the outside does, what was recorded and how long pins were high stay.
    pub(crate) fn reset(&mut self, source: ResetSource, cycle: u64, configuration: [u8; 16]) {
        self.record.place.cycle = cycle;
        self.advance_outputs(cycle);
        self.clock.set_configuration(Configuration::of(configuration));
        self.interrupts = self.interrupts.reset();
        self.offered = None;
        self.power = PowerState::default();
        self.system.reset(source);
        self.watchdog = Watchdog::new(self.clock.configuration(), cycle);
        self.nvm = Nvm::new();
        self.matrix = Matrix::new();
        self.notice.reset();
        self.timers.reset();
        self.release_modulated_pins(cycle);
        self.compares = std::array::from_fn(|number| self.compares[number].reset());
        self.captures = std::array::from_fn(|_| Capture::default());
        self.analog = AdcModule::new();
        self.comparators = Comparators::new();
        self.calendar.reset();
        for serial in &mut self.serials {
            serial.reset();
        }
        self.spis.iter_mut().for_each(Spi::reset);
        self.i2cs.iter_mut().for_each(I2c::reset);
        self.parallel = ParallelPort::default();
        self.dma.reset();
        self.ports.reset(cycle);
        self.schedule = Schedule::new();
        self.schedule.set(Slot::Input, self.inputs.next());
        let change = self.clock.reset();
        self.settle_calendar(cycle);
        self.clock_changed(change, cycle);
        self.begin(cycle);
    }

    /// What follows from the registers after a reset.
    fn begin(&mut self, cycle: u64) {
        for port in Port::ALL {
            self.notice.set_levels(port, self.ports.inputs(port));
        }
        self.settle_analog_pins(cycle);
        self.settle_held_pins(cycle);
        self.schedule.set(Slot::Watchdog, self.watchdog.barks_at());
        self.check_clock();
        self.orders.clear();
        self.order(Order::Matrix);
        self.order(Order::Clock);
    }

    /// The cycle of the next event; 0 when the core must stop at once.
    pub(crate) fn next_event(&self) -> u64 {
        if self.attention { 0 } else { self.schedule.next() }
    }

    /// The next thing that core and memories are to do.
    pub(crate) fn take_order(&mut self) -> Option<Order> {
        if self.orders.is_empty() {
            None
        } else {
            Some(self.orders.remove(0))
        }
    }

    fn order(&mut self, order: Order) {
        self.attention = true;
        self.orders.push(order);
    }

    /// What the core is to be shown, if that is news.
    pub(crate) fn take_request(&mut self) -> Option<Option<InterruptRequest>> {
        self.attention = false;
        let request = self.interrupts.request();
        (request != self.offered).then(|| {
            self.offered = request;
            request
        })
    }

    /// To be called after everything that may have changed the interrupt request.
    fn settle_request(&mut self) {
        if self.interrupts.has_listener() {
            self.settle_dma();
        }
        self.attention |= self.interrupts.request() != self.offered;
    }

    /// Raises an interrupt from outside of the peripherals.
    pub(crate) fn raise(&mut self, irq: Irq, cycle: u64) {
        self.interrupts.raise(irq, cycle);
        self.settle_request();
    }

    /// When the oldest pending source of a vector raised its flag.
    pub(crate) fn raised_at(&self, vector: u8) -> Option<u64> {
        self.interrupts.raised_at(vector)
    }

    /// The vector of what is requested, also while all sources share one.
    pub(crate) fn requested_vector(&self) -> Option<u8> {
        self.interrupts.requested_vector()
    }

    /// How fast the core runs.
    pub(crate) fn system_clock(&self) -> Rate {
        self.clock.system
    }

    /// What CHECON says.
    pub(crate) fn flash_timing(&self) -> FlashTiming {
        self.matrix.flash_timing()
    }

    /// BMXCON.BMXWSDRM.
    pub(crate) fn ram_wait_states(&self) -> u8 {
        self.matrix.ram_wait_states()
    }

    /// Offsets in RAM that may be executed.
    pub(crate) fn ram_code(&self) -> Range<u32> {
        self.matrix.ram_code()
    }

    /// RCON.
    pub(crate) fn reset_causes(&self) -> u32 {
        self.system.causes()
    }

    /// The watchdog begins its period anew.
    pub(crate) fn restart_watchdog(&mut self, cycle: u64) {
        self.watchdog.restart(cycle);
        self.schedule.set(Slot::Watchdog, self.watchdog.barks_at());
    }

    /// A flash operation is over.
    pub(crate) fn flash_failed(&mut self) {
        self.nvm.fail();
    }

    /// The crystal stops.
    pub(crate) fn fail_crystal(&mut self, cycle: u64) {
        self.record.place.cycle = cycle;
        self.advance_outputs(cycle);
        let change = self.clock.fail_crystal();
        self.clock_changed(change, cycle);
    }

    fn now(&self, cycle: u64) -> Now {
        Now {
            cycle,
            peripheral: self.clock.peripheral,
        }
    }

    /// Sets where the program is, for what is recorded.
    pub(crate) fn set_place(&mut self, pc: u32, cycle: u64) {
        self.record.place = AccessSite { pc, cycle };
    }

    fn clock_changed(&mut self, change: Change, cycle: u64) {
        match change {
            Change::None => return,
            Change::Forbidden => return self.record.misuse(Misuse::ClockSwitchForbidden),
            Change::After(cycles) => self.schedule.set(Slot::Clock, cycle + cycles),
            Change::Rates => {}
        }
        self.advance_timers(cycle);
        let now = self.now(cycle);
        self.timers.change_clock(now);
        self.settle_timers(cycle);
        self.analog.change_clock(now);
        self.schedule.set(Slot::Analog, self.analog.next_event());
        for number in 0..2 {
            self.serials[usize::from(number)].change_clock(now);
            self.settle_serial(number);
            self.change_bus_clock(number, now);
        }
        self.change_parallel_clock(cycle);
        self.check_clock();
        self.order(Order::Clock);
    }

    fn check_clock(&mut self) {
        let hz = self.clock.system.hz();
        if hz > clock::FASTEST_HZ {
            self.record.misuse(Misuse::ClockTooFast(hz));
        }
        if let Some(hz) = self.clock.wrong_pll_input() {
            self.record.misuse(Misuse::PllInput(hz));
        }
        if self.matrix.is_too_fast(hz) {
            let wait_states = self.matrix.flash_timing().wait_states;
            self.record.misuse(Misuse::FlashTooFast { wait_states });
        }
    }
}
