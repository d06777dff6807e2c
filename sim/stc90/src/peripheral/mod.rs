//! Everything of the chip around its core, and its share of time.
//!
//! | part | modelled | not |
//! | --- | --- | --- |
//! | ports | P0 to P4 as latches and levels | the two clocks in which a pin is driven high strongly |
//! | timers 0, 1, 2 | all modes, gates, counting pins, capture, up and down | the clock output of timer 2 |
//! | UART | all modes, framing error, own address, lost bytes, rates of both timers | edges on the line; a rate from a timer that counts a pin |
//! | interrupts | eight sources, four levels, their delay | |
//! | watchdog, idle, power-down | all | the crystal's start after power-down |
//! | external memory | 1,024 bytes on the chip | the bus on P0 and P2, which is reported as misuse |
//! | data flash | reading, writing, erasing with their times | wear |
//!
//! Nothing is counted cycle by cycle. Each part says when something comes up that the program or the circuit could notice;
//! the earliest of these is the horizon up to which the core runs undisturbed. Timers are brought up to date when somebody
//! looks at them.

mod access;
mod external;
mod flash;
mod interrupts;
mod ports;
mod power;
mod record;
mod register;
mod serial;
mod timer;
mod timer2;
mod timers;
mod watchdog;

pub use flash::{DATA_BYTES, DATA_START};
pub use interrupts::Source;
pub use record::{Misuse, MisuseRecord};
pub use serial::{LineFrame, SentFrame};
pub use timer2::TICKS_PER_CYCLE;

pub(crate) use interrupts::SOURCES;

use crate::pins::{Edge, Level, Levels, Pin, SwitchedInputs};
use external::ExternalInput;
use flash::{Flash, FlashOrder};
use interrupts::Interrupts;
use ports::Ports;
use power::Power;
use record::Record;
use serial::{Clocks, Serial};
use std::collections::VecDeque;
use timer2::Timer2;
use timers::Timers;
use watchdog::Watchdog;

/// Bytes of external memory on the chip.
pub const XRAM_BYTES: usize = 1024;

/// What resets the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetSource {
    /// The supply came.
    PowerOn,
    /// The pin RST.
    Pin,
    /// The watchdog was not fed.
    Watchdog,
    /// The program asked for it, to begin again.
    Program,
    /// The program asked for the boot loader.
    BootLoader,
}

/// Inputs of the external interrupts.
const EXTERNAL_PINS: [Pin; 4] = [
    Pin::known(3, 2),
    Pin::known(3, 3),
    Pin::known(4, 3),
    Pin::known(4, 2),
];
/// Counting inputs of timers 0 and 1.
const COUNTING_PINS: [Pin; 2] = [Pin::known(3, 4), Pin::known(3, 5)];
const RECEIVE_PIN: Pin = Pin::known(3, 0);
const TRANSMIT_PIN: Pin = Pin::known(3, 1);
const T2: Pin = Pin::known(1, 0);
const T2EX: Pin = Pin::known(1, 1);

/// All peripherals.
#[derive(Clone, Debug)]
pub(crate) struct Chip {
    ports: Ports,
    externals: [ExternalInput; 4],
    timers: Timers,
    timer2: Timer2,
    serial: Serial,
    interrupts: Interrupts,
    watchdog: Watchdog,
    watchdog_at_power_up: bool,
    flash: Flash,
    power: Power,
    auxr: u8,
    xram: Vec<u8>,
    scheduled: VecDeque<Edge>,
    record: Record,
    /// The next cycle in which something happens by itself.
    next: u64,
    /// The core stops here.
    horizon: u64,
    stall: u64,
    returned: bool,
    reset: Option<ResetSource>,
}

impl Chip {
    pub(crate) fn new(watchdog_at_power_up: bool) -> Self {
        let mut chip = Self {
            ports: Ports::new(),
            externals: [ExternalInput::new(true); 4],
            timers: Timers::new(0),
            timer2: Timer2::new(0),
            serial: Serial::default(),
            interrupts: Interrupts::new(),
            watchdog: Watchdog::default(),
            watchdog_at_power_up,
            flash: Flash::new(),
            power: Power::default(),
            auxr: 0,
            xram: vec![0; XRAM_BYTES],
            scheduled: VecDeque::new(),
            record: Record::default(),
            next: 0,
            horizon: 0,
            stall: 0,
            returned: false,
            reset: None,
        };
        chip.reset(ResetSource::PowerOn, 0);
        chip
    }

    /// Registers as after a reset. Memories, the line and what the circuit does to the pins stay.
    pub(crate) fn reset(&mut self, source: ResetSource, cycle: u64) {
        self.ports.reset(cycle);
        self.timers = Timers::new(cycle);
        self.timer2 = Timer2::new(cycle);
        self.serial.reset();
        self.interrupts = Interrupts::new();
        self.watchdog = Watchdog::new(self.watchdog_at_power_up, cycle);
        self.flash.reset();
        self.power.reset(source == ResetSource::PowerOn);
        self.auxr = 0;
        self.stall = 0;
        self.reset = None;
        let levels = self.ports.levels();
        self.externals = EXTERNAL_PINS.map(|pin| ExternalInput::new(levels.level(pin).is_high()));
        self.set_gates(levels);
        self.timer2.trigger(levels.level(T2EX).is_high());
        self.serial.line_is_high = levels.level(RECEIVE_PIN).is_high();
        self.plan(cycle);
    }

    /// Lets everything happen that is due by `cycle`.
    #[inline]
    pub(crate) fn settle(&mut self, cycle: u64) {
        while self.next <= cycle {
            self.happen(self.next);
        }
    }

    fn happen(&mut self, cycle: u64) {
        while let Some(edge) = self.scheduled.front().copied().filter(|edge| edge.cycle <= cycle) {
            self.scheduled.pop_front();
            self.change_input(edge.pin, edge.level, cycle);
        }
        self.advance(cycle);
        if self.watchdog.next() <= cycle {
            self.reset = Some(ResetSource::Watchdog);
            // It barks once; the reset that follows winds it up again.
            self.watchdog.stop(cycle);
        }
        self.plan(cycle);
    }

    /// Brings timers and UART up to date, unless they have no clock.
    fn advance(&mut self, cycle: u64) {
        if self.power.is_down() {
            return;
        }
        self.timers.advance(cycle);
        self.timer2.advance(cycle);
        self.serial.advance(cycle);
    }

    /// Finds out what asks for an interrupt, and when something happens next.
    fn plan(&mut self, cycle: u64) {
        self.interrupts.update(self.requests(), cycle);
        let scheduled = self.scheduled.front().map_or(u64::MAX, |edge| edge.cycle);
        self.next = if self.power.is_down() {
            scheduled
        } else {
            let enabled = [Source::Timer0, Source::Timer1].map(|source| self.interrupts.is_enabled(source));
            let timer2 = if self.interrupts.is_enabled(Source::Timer2) {
                self.timer2.next()
            } else {
                u64::MAX
            };
            scheduled
                .min(self.timers.next(enabled))
                .min(timer2)
                .min(self.serial.next())
                .min(self.watchdog.next())
        };
        // What is due is done at once by the caller's loop; a plan never stays behind.
        self.next = self.next.max(cycle + 1);
        self.horizon = if self.needs_machine() {
            0
        } else {
            self.next.min(self.interrupts.next())
        };
    }

    /// Whether something is to be done that only the machine can do.
    fn needs_machine(&self) -> bool {
        self.reset.is_some()
            || self.stall > 0
            || self.power.is_asleep()
            || self.interrupts.is_held()
            || self.record.is_unplaced()
    }

    /// Bit for each source that asks for an interrupt.
    fn requests(&self) -> u8 {
        let requests = [
            self.externals[0].requests(),
            self.timers.has_overflowed(0),
            self.externals[1].requests(),
            self.timers.has_overflowed(1),
            self.serial.requests(),
            self.timer2.requests(),
            self.externals[2].requests(),
            self.externals[3].requests(),
        ];
        let bits = requests.into_iter().rev();
        bits.fold(0, |all, asks| all << 1 | u8::from(asks))
    }

    /// The interrupt whose handler is to be called now.
    pub(crate) fn take_interrupt(&mut self, cycle: u64) -> Option<Source> {
        let source = self.interrupts.take(cycle)?;
        match source {
            Source::External0 => self.externals[0].acknowledge(),
            Source::Timer0 => self.timers.acknowledge(0),
            Source::External1 => self.externals[1].acknowledge(),
            Source::Timer1 => self.timers.acknowledge(1),
            Source::Serial | Source::Timer2 => {}
            Source::External2 => self.externals[2].acknowledge(),
            Source::External3 => self.externals[3].acknowledge(),
        }
        if self.power.wake() {
            self.watchdog.wake(cycle);
        }
        self.plan(cycle);
        Some(source)
    }

    /// Whether one more instruction comes before any interrupt; asks only once.
    pub(crate) fn take_hold(&mut self, cycle: u64) -> bool {
        let held = self.interrupts.take_hold();
        if held {
            self.plan(cycle);
        }
        held
    }

    /// A reset that the chip wants.
    pub(crate) fn take_reset(&mut self) -> Option<ResetSource> {
        self.reset.take()
    }

    /// For how many cycles the core stands still.
    pub(crate) fn take_stall(&mut self, cycle: u64) -> u64 {
        let stall = std::mem::take(&mut self.stall);
        if stall > 0 {
            self.plan(cycle);
        }
        stall
    }

    /// Whether a handler has returned since the last call.
    pub(crate) fn took_return(&mut self) -> bool {
        std::mem::take(&mut self.returned)
    }

    /// Names the instruction to which new records belong.
    pub(crate) fn place_records(&mut self, pc: u16, cycle: u64) {
        if self.record.is_unplaced() {
            self.record.place(pc);
            self.plan(cycle);
        }
    }

    /// The next cycle in which something happens by itself; later than all that has settled.
    pub(crate) fn next_event(&self) -> u64 {
        self.next
    }

    /// When a sleeping core must be looked after; none while it is awake.
    pub(crate) fn sleep_horizon(&self) -> Option<u64> {
        self.power
            .is_asleep()
            .then(|| self.next.min(self.interrupts.next()))
    }

    /// The circuit changes a pin.
    pub(crate) fn set_input(&mut self, pin: Pin, level: Level, cycle: u64) {
        self.settle(cycle);
        self.change_input(pin, level, cycle);
        self.plan(cycle);
    }

    /// The circuit changes all pins.
    pub(crate) fn set_inputs(&mut self, levels: Levels, cycle: u64) {
        self.settle(cycle);
        let before = self.ports.levels();
        self.ports.set_inputs(levels);
        self.notice_levels(before, cycle);
        self.plan(cycle);
    }

    /// The circuit lets inputs depend on a latch.
    pub(crate) fn switch_inputs(&mut self, inputs: SwitchedInputs, cycle: u64) {
        self.settle(cycle);
        let before = self.ports.levels();
        self.ports.switch_inputs(inputs);
        self.notice_levels(before, cycle);
        self.plan(cycle);
    }

    /// The circuit will change a pin; edges of later cycles come later.
    pub(crate) fn schedule_input(&mut self, edge: Edge) {
        let place = self.scheduled.partition_point(|other| other.cycle <= edge.cycle);
        self.scheduled.insert(place, edge);
        self.next = self.next.min(edge.cycle);
        self.horizon = self.horizon.min(edge.cycle);
    }

    fn change_input(&mut self, pin: Pin, level: Level, cycle: u64) {
        let before = self.ports.levels();
        self.ports.set_input(pin, level);
        self.notice_levels(before, cycle);
    }

    /// Tells the parts that listen to pins about changed levels.
    fn notice_levels(&mut self, before: Levels, cycle: u64) {
        let after = self.ports.levels();
        if before == after {
            return;
        }
        self.advance(cycle);
        for (number, pin) in EXTERNAL_PINS.into_iter().enumerate() {
            self.externals[number].see(after.level(pin).is_high());
        }
        let falls = |pin| before.level(pin).is_high() && !after.level(pin).is_high();
        self.set_gates(after);
        for (number, pin) in COUNTING_PINS.into_iter().enumerate() {
            if falls(pin) {
                self.timers.pulse(number);
            }
        }
        if falls(T2) {
            self.timer2.pulse();
        }
        if before.level(T2EX) != after.level(T2EX) {
            self.timer2.trigger(after.level(T2EX).is_high());
        }
        self.serial.line_is_high = after.level(RECEIVE_PIN).is_high();
        self.end_power_down(cycle);
    }

    /// The first two external interrupts' pins are the gates of timers 0 and 1.
    fn set_gates(&mut self, levels: Levels) {
        for (number, pin) in EXTERNAL_PINS.into_iter().take(2).enumerate() {
            self.timers.gate(number, levels.level(pin).is_high());
        }
    }

    /// A low pin of an enabled external interrupt starts the clock again.
    fn end_power_down(&mut self, cycle: u64) {
        const SOURCES: [Source; 4] = [
            Source::External0,
            Source::External1,
            Source::External2,
            Source::External3,
        ];
        let mut inputs = SOURCES.iter().zip(&self.externals);
        let wakes = inputs.any(|(source, input)| input.is_low() && self.interrupts.is_enabled(*source));
        if self.power.is_down() && wakes {
            self.power.wake();
            self.watchdog.wake(cycle);
            self.timers.skip_to(cycle);
            self.timer2.skip_to(cycle);
            self.serial.skip_to(cycle);
        }
    }

    /// Takes over rates of the UART that may have changed.
    fn clock_serial(&mut self, cycle: u64) {
        let clocks = Clocks {
            timer_1: self
                .timers
                .period_of_timer_1()
                .map(|cycles| cycles * TICKS_PER_CYCLE),
            transmit: self.timer2.transmit_period(),
            receive: self.timer2.receive_period(),
            pcon: self.power.pcon(),
        };
        self.serial.set_clocks(&clocks, cycle);
    }

    fn obey(&mut self, order: FlashOrder, cycle: u64) {
        match order {
            FlashOrder::None => {}
            FlashOrder::Stall(cycles) => self.stall += cycles,
            FlashOrder::Reset { into_loader: true } => self.reset = Some(ResetSource::BootLoader),
            FlashOrder::Reset { into_loader: false } => self.reset = Some(ResetSource::Program),
            FlashOrder::Misuse(misuse) => self.record.note(misuse, cycle),
        }
    }
}
