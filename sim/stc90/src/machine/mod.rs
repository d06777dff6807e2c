//! The whole chip, with pins and a serial line to the outside.
//!
//! [`Machine::run_until`] executes the program up to a machine cycle. Between two calls the caller acts as the circuit: it
//! sets inputs now or ahead of time, hands over frames for the UART, and takes what the chip did. A machine can be cloned
//! at any time. It has no clock and no randomness of its own: the same image and the same calls give the same bits.
//!
//! Time is counted in machine cycles. In 6T mode one is six clocks of the crystal, in 12T mode twelve; nothing inside of
//! the chip notices the difference, except that the same crystal makes twice as many cycles.

mod account;
mod options;

pub use account::{Account, SourceAccount};
pub use options::{ClockMode, Options};

use crate::cpu::Cpu;
use crate::image::Image;
use crate::peripheral::{Chip, LineFrame, MisuseRecord, ResetSource, SentFrame};
use crate::pins::{Edge, Level, Levels, Pin, SwitchedInputs};

/// How many resets are kept; those after them are only counted.
const KEPT: usize = 64;

/// A reset and where it came in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResetEvent {
    /// What caused it.
    pub source: ResetSource,
    /// When.
    pub cycle: u64,
    /// Address of the instruction that would have been next.
    pub pc: u16,
}

/// An STC90C58RD+ with its program.
#[derive(Clone, Debug)]
pub struct Machine {
    cpu: Cpu,
    chip: Chip,
    options: Options,
    account: Account,
    resets: Vec<ResetEvent>,
    unreported_resets: Vec<ResetSource>,
    reset_count: u64,
    /// The boot loader runs until this cycle.
    loader_until: u64,
    /// The core waits for data flash until this cycle.
    stalled_until: u64,
}

impl Machine {
    /// A chip with this program right after power-on, its memories cleared.
    #[must_use]
    pub fn new(image: &Image, options: Options) -> Self {
        let mut machine = Self {
            cpu: Cpu::new(image.code()),
            chip: Chip::new(options.watchdog_at_power_up),
            options,
            account: Account::default(),
            resets: Vec::new(),
            unreported_resets: Vec::new(),
            reset_count: 0,
            loader_until: 0,
            stalled_until: 0,
        };
        machine.loader_until = machine.loader_cycles(ResetSource::PowerOn);
        machine
    }

    /// Resets the chip now.
    pub fn reset(&mut self, source: ResetSource) {
        self.reset_count += 1;
        if self.unreported_resets.len() < KEPT {
            self.unreported_resets.push(source);
        }
        if self.resets.len() < KEPT {
            self.resets.push(ResetEvent {
                source,
                cycle: self.cycle(),
                pc: self.cpu.pc(),
            });
        }
        self.account.forget_active(self.cycle());
        self.cpu.reset();
        self.chip.reset(source, self.cycle());
        self.stalled_until = 0;
        self.loader_until = self.cycle() + self.loader_cycles(source);
    }

    /// The loader in the chip looks for its host before the program begins, at power-on and when the program asks for it.
    fn loader_cycles(&self, source: ResetSource) -> u64 {
        match source {
            ResetSource::PowerOn | ResetSource::BootLoader => self.options.loader_cycles,
            ResetSource::Pin | ResetSource::Watchdog | ResetSource::Program => 0,
        }
    }

    /// Runs until this cycle since power-on. The instruction that is executed then is finished, so up to three cycles
    /// more may pass.
    pub fn run_until(&mut self, cycle: u64) {
        while self.cycle() < cycle {
            self.advance(cycle);
        }
        self.chip.settle(self.cycle());
        self.account.charge(self.cycle());
    }

    /// Executes one instruction; calls an interrupt's handler first if its turn has come. A core that sleeps or waits does so
    /// for a cycle.
    pub fn step(&mut self) {
        self.advance(self.cycle() + 1);
        self.chip.settle(self.cycle());
        self.account.charge(self.cycle());
    }

    /// Does one thing, or runs until something else is due.
    fn advance(&mut self, cycle: u64) {
        let now = self.cycle();
        if self.loader_until > now {
            self.cpu.wait_until(self.loader_until.min(cycle));
            return;
        }
        self.chip.settle(now);
        if let Some(source) = self.chip.take_reset() {
            self.reset(source);
            return;
        }
        if self.stalled_until > now {
            let next = self.chip.next_event().min(self.stalled_until).min(cycle);
            self.cpu.wait_until(next);
            return;
        }
        if !self.chip.take_hold(now) {
            self.call_handler();
            if let Some(horizon) = self.chip.sleep_horizon() {
                self.sleep(horizon.min(cycle));
                return;
            }
            self.cpu.run(&mut self.chip, cycle);
        } else {
            self.cpu.step(&mut self.chip);
        }
        self.chip.place_records(self.cpu.begin(), self.cycle());
        self.stalled_until = self.cycle() + self.chip.take_stall(self.cycle());
        if self.chip.took_return() {
            self.account.leave(self.cycle());
        }
    }

    fn call_handler(&mut self) {
        if let Some(source) = self.chip.take_interrupt(self.cycle()) {
            self.account.enter(source, self.cycle());
            self.cpu.interrupt(source.vector(), &mut self.chip);
        }
    }

    fn sleep(&mut self, cycle: u64) {
        let from = self.cycle();
        self.cpu.wait_until(cycle.max(from + 1));
        self.account.add_idle(self.cycle() - from);
    }

    /// Machine cycles since power-on.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.cpu.cycle()
    }

    /// How many of them are a second.
    #[must_use]
    pub fn cycles_per_s(&self) -> f64 {
        self.options.cycles_per_s()
    }

    /// Whether the chip's boot loader runs instead of the program.
    #[must_use]
    pub fn is_in_loader(&self) -> bool {
        self.loader_until > self.cycle()
    }

    /// Whether the core waits for data flash.
    #[must_use]
    pub fn is_stalled(&self) -> bool {
        self.stalled_until > self.cycle()
    }

    /// The core.
    #[must_use]
    pub fn cpu(&self) -> &Cpu {
        &self.cpu
    }

    /// The core, to change its registers and its RAM.
    pub fn cpu_mut(&mut self) -> &mut Cpu {
        &mut self.cpu
    }

    /// What the special function register at an address holds; of a port its latch. Nothing notices.
    #[must_use]
    pub fn register(&self, address: u8) -> u8 {
        self.cpu
            .register(address)
            .unwrap_or_else(|| self.chip.peek(address, self.cycle()))
    }

    /// External memory on the chip.
    #[must_use]
    pub fn xram(&self) -> &[u8] {
        self.chip.xram()
    }

    /// The same, to begin with contents of one's own: at power-on it holds anything.
    pub fn xram_mut(&mut self) -> &mut [u8] {
        self.chip.xram_mut()
    }

    /// Data flash, its first byte that of address 0x8000.
    #[must_use]
    pub fn data_flash(&self) -> &[u8] {
        self.chip.data_flash()
    }

    /// The circuit pulls a pin low, or lets it go.
    pub fn set_input(&mut self, pin: Pin, level: Level) {
        self.chip.set_input(pin, level, self.cycle());
    }

    /// The circuit does so to all pins at once.
    pub fn set_inputs(&mut self, levels: Levels) {
        self.chip.set_inputs(levels, self.cycle());
    }

    /// The circuit lets inputs depend on what the chip does to one of its pins, besides [`Self::set_inputs`]; replaces what
    /// was set so before.
    pub fn switch_inputs(&mut self, inputs: SwitchedInputs) {
        self.chip.switch_inputs(inputs, self.cycle());
    }

    /// The circuit will change a pin in a cycle to come.
    pub fn schedule_input(&mut self, mut edge: Edge) {
        edge.cycle = edge.cycle.max(self.cycle());
        self.chip.schedule_input(edge);
    }

    /// What the chip does to all pins: low is pulled, high is let go.
    #[must_use]
    pub fn outputs(&self) -> Levels {
        self.chip.latches()
    }

    /// What a voltmeter would see at all pins.
    #[must_use]
    pub fn levels(&self) -> Levels {
        self.chip.levels()
    }

    /// What a voltmeter would see at one pin.
    #[must_use]
    pub fn level(&self, pin: Pin) -> Level {
        self.chip.level(pin)
    }

    /// Keeps edges of what the chip does to this pin from now on.
    pub fn watch(&mut self, pin: Pin) {
        self.chip.watch(pin);
    }

    /// Edges of watched pins since the last call, in their order.
    pub fn take_edges(&mut self) -> Vec<Edge> {
        self.chip.take_edges()
    }

    /// A frame comes along the line to the UART. It begins now or later, and not before the last one.
    pub fn hear(&mut self, mut frame: LineFrame) {
        frame.cycle = frame.cycle.max(self.cycle());
        self.chip.hear(frame);
    }

    /// Frames that the UART has sent since the last call, up to their stop bits. One that was cut off is not among them.
    pub fn take_sent(&mut self) -> Vec<SentFrame> {
        self.chip.take_sent()
    }

    /// How long a bit is for the UART's receiver, in sixths of a cycle; nothing while it has no rate.
    #[must_use]
    pub fn bit_ticks(&self) -> Option<u64> {
        self.chip.receive_bit()
    }

    /// Bytes that were lost because the program had not yet taken the one before.
    #[must_use]
    pub fn overruns(&self) -> u64 {
        self.chip.lost()[0]
    }

    /// Frames that came while the receiver was off or busy.
    #[must_use]
    pub fn unheard(&self) -> u64 {
        self.chip.lost()[1]
    }

    /// What the program did that works by luck or not at all, each kind once.
    #[must_use]
    pub fn misuses(&self) -> &[MisuseRecord] {
        self.chip.misuses()
    }

    /// The first 64 resets after power-on.
    #[must_use]
    pub fn resets(&self) -> &[ResetEvent] {
        &self.resets
    }

    /// What has reset the chip since the last call, at most 64 of them.
    pub fn take_resets(&mut self) -> Vec<ResetSource> {
        std::mem::take(&mut self.unreported_resets)
    }

    /// How often the chip was reset after power-on.
    #[must_use]
    pub fn reset_count(&self) -> u64 {
        self.reset_count
    }

    /// Where the time went.
    #[must_use]
    pub fn account(&self) -> &Account {
        &self.account
    }
}
