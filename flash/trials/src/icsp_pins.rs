//! The lines between a programmer and the emulated PIC32.

use pic32::icsp::{IcspPort, PortFaults, PortViolation};
use pic32::machine::{Grounded, Machine};
use pic32::pins::Level;
use pic32_icsp::{IcspPins, LineLevel};

/// Cycles of the chip's time base.
const CYCLES_PER_US: u64 = 80;

/// What is wrong with the host or the wires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WireFaults {
    /// Clock and data are swapped.
    pub is_swapped: bool,
    /// The host sleeps for 50 ms after so many of its calls; 0 for never.
    pub pause_every: u64,
}

/// What ends a run in its midst.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interruption {
    /// The supply of robot and Linux board fails at this time.
    PowerCut {
        /// Microseconds after the start.
        at_us: u64,
        /// What RAM, and flash that was being changed, hold afterwards.
        seed: u64,
    },
    /// The programmer's process ends at this time: the kernel lets its lines go.
    Killed {
        /// Microseconds after the start.
        at_us: u64,
    },
}

/// The run was interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the lines are gone")]
pub struct LinesLost;

/// A chip with its port, and the host's lines.
#[derive(Clone, Debug)]
pub struct SimulatedIcsp {
    machine: Machine,
    port: IcspPort,
    faults: WireFaults,
    /// Cycles of the chip for half a period of the clock line.
    half_cycles: u64,
    now: u64,
    calls: u64,
    interruption: Option<Interruption>,
    is_lost: bool,
}

impl SimulatedIcsp {
    /// Lines to a chip, with a clock of so many hertz at most.
    pub fn new(machine: Machine, clock_hz: u64, faults: (WireFaults, PortFaults)) -> Self {
        Self {
            now: machine.cycle(),
            machine,
            port: IcspPort::new(faults.1),
            faults: faults.0,
            half_cycles: (CYCLES_PER_US * 500_000 / clock_hz.max(1)).max(1),
            calls: 0,
            interruption: None,
            is_lost: false,
        }
    }

    /// Something ends this run.
    pub fn interrupt(&mut self, interruption: Interruption) {
        self.interruption = Some(interruption);
    }

    /// A new run of the host begins: the lines are there again.
    pub fn start_again(&mut self) {
        self.interruption = None;
        self.is_lost = false;
    }

    /// What the host did wrong.
    pub fn violations(&self) -> &[PortViolation] {
        self.port.violations()
    }

    /// The chip.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The chip, to change it.
    pub fn machine_mut(&mut self) -> &mut Machine {
        &mut self.machine
    }

    /// Lets the program run for so long.
    pub fn run_ms(&mut self, ms: u64) {
        self.now += ms * 1_000 * CYCLES_PER_US;
        self.machine.run_until(self.now, &mut Grounded);
    }

    fn pass(&mut self, cycles: u64) -> Result<(), LinesLost> {
        if self.is_lost {
            return Err(LinesLost);
        }
        self.calls += 1;
        self.now += cycles;
        if self.faults.pause_every != 0 && self.calls.is_multiple_of(self.faults.pause_every) {
            self.now += 50_000 * CYCLES_PER_US;
        }
        let at_us = match self.interruption {
            Some(Interruption::PowerCut { at_us, .. } | Interruption::Killed { at_us }) => at_us,
            None => return Ok(()),
        };
        if self.now < at_us * CYCLES_PER_US {
            return Ok(());
        }
        self.is_lost = true;
        self.port.set_data(None);
        if let Some(Interruption::PowerCut { seed, .. }) = self.interruption {
            self.port.power_cut((self.now, seed), &mut self.machine);
        }
        self.port.set_reset(Level::High, self.now, &mut self.machine);
        Err(LinesLost)
    }
}

impl IcspPins for SimulatedIcsp {
    type Error = LinesLost;

    fn set_reset(&mut self, level: LineLevel) -> Result<(), LinesLost> {
        self.pass(self.half_cycles)?;
        self.port
            .set_reset(Level::of(level.is_high()), self.now, &mut self.machine);
        Ok(())
    }

    fn set_clock(&mut self, level: LineLevel) -> Result<(), LinesLost> {
        self.pass(self.half_cycles)?;
        let level = Level::of(level.is_high());
        match self.faults.is_swapped {
            true => self.port.set_data(Some(level)),
            false => self.port.set_clock(level, self.now, &mut self.machine),
        }
        Ok(())
    }

    fn drive_data(&mut self, level: LineLevel) -> Result<(), LinesLost> {
        self.pass(0)?;
        let level = Level::of(level.is_high());
        match self.faults.is_swapped {
            true => self.port.set_clock(level, self.now, &mut self.machine),
            false => self.port.set_data(Some(level)),
        }
        Ok(())
    }

    fn release_data(&mut self) -> Result<(), LinesLost> {
        self.pass(0)?;
        self.port.set_data(None);
        Ok(())
    }

    fn read_data(&mut self) -> Result<LineLevel, LinesLost> {
        self.pass(0)?;
        Ok(match self.faults.is_swapped {
            // The chip's clock input is no output.
            true => LineLevel::Low,
            false => LineLevel::of(self.port.data().is_high()),
        })
    }

    fn pause_us(&mut self, us: u32) {
        // A pause after the lines are gone is noticed by the next call.
        self.pass(u64::from(us) * CYCLES_PER_US).ok();
    }

    fn now_us(&self) -> u64 {
        self.now / CYCLES_PER_US
    }
}
