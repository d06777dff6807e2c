//! A machine as a target of the debugger.

use super::{DebugTarget, GdbRegister, NoMemory, Stop};
use crate::cpu::ExceptionCode;
use crate::machine::{Halt, Machine, ProgramFault, StopAt, Surroundings};
use crate::peripheral::ResetSource;

/// Cycles of a moment: 10 ms, short enough that a person who interrupts does not wait.
const MOMENT: u64 = 800_000;
/// The window of the special function registers.
const REGISTERS: std::ops::Range<u32> = 0x1F80_0000..0x1F90_0000;

/// A machine and what is around it. Exceptions of the program stop it.
#[derive(Debug)]
pub struct DebugChip<'a, S: Surroundings> {
    machine: &'a mut Machine,
    surroundings: &'a mut S,
}

impl<'a, S: Surroundings> DebugChip<'a, S> {
    /// The machine stops at exceptions from now on.
    pub fn new(machine: &'a mut Machine, surroundings: &'a mut S) -> Self {
        machine.stop_at(StopAt::Exceptions);
        Self {
            machine,
            surroundings,
        }
    }
}

impl<S: Surroundings> DebugTarget for DebugChip<'_, S> {
    fn register(&self, register: GdbRegister) -> u32 {
        let cpu = self.machine.cpu();
        match register {
            GdbRegister::General(number) => cpu.register(number),
            GdbRegister::Status => cpu.system_register(12, 0),
            GdbRegister::Low => cpu.product().1,
            GdbRegister::High => cpu.product().0,
            GdbRegister::BadAddress => cpu.system_register(8, 0),
            GdbRegister::Cause => cpu.system_register(13, 0),
            GdbRegister::ProgramCounter => cpu.pc(),
        }
    }

    fn set_register(&mut self, register: GdbRegister, value: u32) {
        let cpu = self.machine.cpu_mut();
        let (high, low) = cpu.product();
        match register {
            GdbRegister::General(number) => cpu.set_register(number, value),
            GdbRegister::Status => cpu.set_system_register(12, 0, value),
            GdbRegister::Low => cpu.set_product(high, value),
            GdbRegister::High => cpu.set_product(value, low),
            GdbRegister::Cause => cpu.set_system_register(13, 0, value),
            // The debugger writes all registers back; the same address must not break a delay slot.
            GdbRegister::ProgramCounter if value != cpu.pc() => cpu.set_pc(value),
            GdbRegister::ProgramCounter | GdbRegister::BadAddress => {}
        }
    }

    fn read(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), NoMemory> {
        let start = physical(address)?;
        if !REGISTERS.contains(&start) {
            return self.machine.memory().read(start, bytes).map_err(|_| NoMemory);
        }
        for (address, byte) in (start..).zip(bytes) {
            let word = self.machine.peek_register(address & !3).ok_or(NoMemory)?;
            *byte = (word >> (8 * (address & 3))) as u8;
        }
        Ok(())
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), NoMemory> {
        let start = physical(address)?;
        if !REGISTERS.contains(&start) {
            return self
                .machine
                .memory_mut()
                .write(start, bytes)
                .map_err(|_| NoMemory);
        }
        let (words, rest) = bytes.as_chunks();
        if start & 3 != 0 || !rest.is_empty() {
            return Err(NoMemory);
        }
        for (address, word) in (start..).step_by(4).zip(words) {
            self.machine.write_register(address, u32::from_le_bytes(*word));
        }
        Ok(())
    }

    fn set_breakpoint(&mut self, address: u32) -> Result<(), NoMemory> {
        let place = physical(address)?;
        self.machine
            .memory_mut()
            .set_breakpoint(place)
            .map_err(|_| NoMemory)
    }

    fn clear_breakpoint(&mut self, address: u32) -> Result<(), NoMemory> {
        let place = physical(address)?;
        self.machine
            .memory_mut()
            .clear_breakpoint(place)
            .map_err(|_| NoMemory)
    }

    fn step(&mut self) -> Stop {
        let halt = self.machine.step(self.surroundings);
        stop(halt).unwrap_or(Stop::Stepped)
    }

    fn run(&mut self) -> Option<Stop> {
        let until = self.machine.cycle() + MOMENT;
        stop(self.machine.run_until(until, self.surroundings))
    }

    fn reset(&mut self) {
        self.machine.reset(ResetSource::MasterClear);
    }

    fn cycle(&self) -> u64 {
        self.machine.cycle()
    }
}

/// The physical address behind KSEG0 and KSEG1.
fn physical(address: u32) -> Result<u32, NoMemory> {
    match address >> 29 {
        4 | 5 => Ok(address & 0x1FFF_FFFF),
        _ => Err(NoMemory),
    }
}

fn stop(halt: Halt) -> Option<Stop> {
    match halt {
        Halt::Reached => None,
        Halt::Breakpoint => Some(Stop::Breakpoint),
        Halt::Fault(ProgramFault::Misuse(_)) => Some(Stop::Trapped),
        Halt::Fault(ProgramFault::Exception(exception)) => Some(match exception.code {
            ExceptionCode::AddressLoad
            | ExceptionCode::AddressStore
            | ExceptionCode::BusFetch
            | ExceptionCode::BusData => Stop::BadAddress,
            ExceptionCode::Reserved | ExceptionCode::CoprocessorUnusable => Stop::BadInstruction,
            ExceptionCode::Syscall
            | ExceptionCode::Breakpoint
            | ExceptionCode::Overflow
            | ExceptionCode::Trap => Stop::Trapped,
        }),
    }
}
