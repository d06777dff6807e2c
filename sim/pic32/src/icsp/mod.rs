//! The port for programmers: two wires and the reset, behind which sit the two test access ports of the chip.
//!
//! [`IcspPort`] follows the lines edge by edge: the key that opens the port, cycles of four clocks on one data line, the state
//! machine of IEEE 1149.1, the chip's own commands and the probe of its core. What the programmer asks for happens in the
//! [`Machine`] that it hands over, so that the chip which is programmed is the one that runs afterwards.
//!
//! Not modelled: the four-wire port at RA0, RA1, RA4 and RA5, the debug request while the program runs, and hardware
//! breakpoints. OpenOCD halts the core at reset, reads, erases and writes through it (`flash/trials`, `serve_jtag`).

mod fault;
mod registers;
mod tap_state;

pub use fault::{PortFaults, PortViolation};
pub use registers::CHIP_ERASE_MS;

use crate::machine::{Grounded, Machine};
use crate::pins::Level;
use registers::TestPorts;

/// "MCHP", most significant bit first.
const KEY: u32 = 0x4D43_4850;
/// The pulse of the reset line before the key may last so long, in cycles of 80 MHz: 500 us.
const PULSE_CYCLES_MAX: u64 = 40_000;

/// What the port does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum IcspState {
    /// The program runs.
    Run,
    /// The reset line is low; bits of the key come in.
    Key {
        bits: u32,
        register: u32,
        is_short: bool,
    },
    /// Programming mode; `phase` counts clocks of a cycle, 0 to 3.
    Program { phase: u8, tdi: bool, tdo: bool },
}

/// The programming port of one chip.
#[derive(Clone, Debug)]
pub struct IcspPort {
    state: IcspState,
    clock: Level,
    /// What the host does to the data line; nothing when it has let go.
    data: Option<Level>,
    risen_at: Option<u64>,
    ports: TestPorts,
    faults: PortFaults,
    violations: Vec<PortViolation>,
    flips: home::Pcg,
}

impl IcspPort {
    /// The port of a chip whose program runs.
    pub fn new(faults: PortFaults) -> Self {
        Self {
            state: IcspState::Run,
            clock: Level::Low,
            data: None,
            risen_at: None,
            ports: TestPorts::new(faults),
            faults,
            violations: Vec::new(),
            flips: home::Pcg::new(faults.seed, 0x1C5B),
        }
    }

    /// What the host did that a chip may not understand, each kind once.
    pub fn violations(&self) -> &[PortViolation] {
        &self.violations
    }

    /// Whether programming mode is on.
    pub fn is_programming(&self) -> bool {
        matches!(self.state, IcspState::Program { .. })
    }

    /// The host pulls the reset line low, or lets it go.
    pub fn set_reset(&mut self, level: Level, cycle: u64, machine: &mut Machine) {
        match (level, self.state) {
            (Level::Low, IcspState::Run | IcspState::Program { .. }) => {
                catch_up(machine, cycle);
                let pulse = self.risen_at.map(|risen| cycle.saturating_sub(risen));
                let is_short = pulse.is_some_and(|cycles| cycles <= PULSE_CYCLES_MAX);
                self.state = IcspState::Key {
                    bits: 0,
                    register: 0,
                    is_short,
                };
                machine.hold_in_reset();
            }
            (Level::High, IcspState::Key { bits, register, .. }) => {
                catch_up(machine, cycle);
                self.risen_at = Some(cycle);
                self.leave_reset(bits >= 32 && register == KEY, machine);
            }
            (Level::Low, IcspState::Key { .. }) | (Level::High, _) => {}
        }
    }

    fn leave_reset(&mut self, has_key: bool, machine: &mut Machine) {
        let is_short = matches!(self.state, IcspState::Key { is_short: true, .. });
        if has_key && !is_short {
            self.violate(PortViolation::KeyWithoutPulse);
        }
        if has_key && is_short && !self.faults.is_deaf {
            self.state = IcspState::Program {
                phase: 0,
                tdi: false,
                tdo: false,
            };
            self.ports.enter(machine);
        } else {
            self.state = IcspState::Run;
            machine.release_reset();
        }
    }

    /// The host drives the data line, or lets it go.
    pub fn set_data(&mut self, level: Option<Level>) {
        self.data = level;
    }

    /// The host drives the clock line.
    pub fn set_clock(&mut self, level: Level, cycle: u64, machine: &mut Machine) {
        let before = std::mem::replace(&mut self.clock, level);
        match (before, level) {
            (Level::High, Level::Low) => self.fall(cycle, machine),
            (Level::Low, Level::High) => self.rise(),
            _ => {}
        }
    }

    fn rise(&mut self) {
        if let IcspState::Program { phase: 2 | 3, .. } = self.state
            && self.data.is_some()
        {
            self.violate(PortViolation::BothDrive);
        }
    }

    fn fall(&mut self, cycle: u64, machine: &mut Machine) {
        let high = self.heard().is_high();
        self.state = match self.state {
            IcspState::Run => IcspState::Run,
            IcspState::Key {
                bits,
                register,
                is_short,
            } => IcspState::Key {
                bits: bits.saturating_add(1),
                register: register << 1 | u32::from(high),
                is_short,
            },
            IcspState::Program { phase: 0, tdo, .. } => IcspState::Program {
                phase: 1,
                tdi: high,
                tdo,
            },
            IcspState::Program { phase: 1, tdi, .. } => {
                let tdo = self.ports.step((tdi, high), cycle, machine);
                if let Some(violation) = self.ports.take_violation() {
                    self.violate(violation);
                }
                IcspState::Program { phase: 2, tdi, tdo }
            }
            IcspState::Program { phase, tdi, tdo } => IcspState::Program {
                phase: (phase + 1) & 3,
                tdi,
                tdo,
            },
        };
    }

    /// What the chip hears on the data line. A line that nobody drives reads low here.
    fn heard(&self) -> Level {
        self.faults.stuck_data.or(self.data).unwrap_or(Level::Low)
    }

    /// What a voltmeter would see on the data line.
    pub fn data(&mut self) -> Level {
        if let Some(level) = self.faults.stuck_data {
            return level;
        }
        match self.state {
            IcspState::Program { phase: 3, tdo, .. } => {
                let is_flipped = self.faults.flip_one_in != 0
                    && self.flips.next_u32().is_multiple_of(self.faults.flip_one_in);
                Level::of(tdo != is_flipped)
            }
            _ => self.data.unwrap_or(Level::Low),
        }
    }

    /// The supply fails and comes back: the port forgets, the program starts unless the reset line is held low.
    pub fn power_cut(&mut self, (cycle, seed): (u64, u64), machine: &mut Machine) {
        catch_up(machine, cycle);
        self.ports.cut(machine, cycle, seed);
        machine.power_cut(seed);
        let held = matches!(self.state, IcspState::Key { .. });
        self.risen_at = None;
        self.state = match held {
            true => IcspState::Key {
                bits: 0,
                register: 0,
                is_short: false,
            },
            false => IcspState::Run,
        };
        if held {
            machine.hold_in_reset();
        }
    }

    fn violate(&mut self, violation: PortViolation) {
        if !self.violations.contains(&violation) {
            self.violations.push(violation);
        }
    }
}

/// Lets the chip's own time pass. While it is programmed its pins float, so nothing is around it.
fn catch_up(machine: &mut Machine, cycle: u64) {
    if machine.cycle() < cycle {
        machine.run_until(cycle, &mut Grounded);
    }
}
