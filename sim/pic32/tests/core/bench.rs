//! A core with memories and a few instructions, and words of instructions.

use pic32::cpu::{Access, Bus, BusFault, Cpu, Exit, Taken, Width};
use pic32::image::Image;
use pic32::memory::{FlashTiming, Memory, Prefetch};

/// Program flash in KSEG0.
pub(crate) const FLASH: u32 = 0x9D00_0000;
/// RAM in KSEG0.
pub(crate) const RAM: u32 = 0x8000_0000;
/// A register of the chip that the bus knows.
pub(crate) const REGISTER: u32 = 0xBF80_0600;

pub(crate) const NOP: u32 = 0;
pub(crate) const WAIT: u32 = 0x4200_0020;
pub(crate) const ERET: u32 = 0x4200_0018;
pub(crate) const DERET: u32 = 0x4200_001F;
pub(crate) const SYSCALL: u32 = 0x0C;
pub(crate) const BREAK: u32 = 0x0D;
/// `jr ra`.
pub(crate) const RETURN: u32 = 0x03E0_0008;
/// `b` over the next instruction but one.
pub(crate) const BRANCH: u32 = 0x1000_0002;

/// Numbers of system registers.
pub(crate) const BAD_ADDRESS: (u8, u8) = (8, 0);
pub(crate) const COUNT: (u8, u8) = (9, 0);
pub(crate) const COMPARE: (u8, u8) = (11, 0);
pub(crate) const STATUS: (u8, u8) = (12, 0);
pub(crate) const INTERRUPT_CONTROL: (u8, u8) = (12, 1);
pub(crate) const SHADOW_CONTROL: (u8, u8) = (12, 2);
pub(crate) const CAUSE: (u8, u8) = (13, 0);
pub(crate) const EPC: (u8, u8) = (14, 0);
pub(crate) const EXCEPTION_BASE: (u8, u8) = (15, 1);
pub(crate) const ERROR_EPC: (u8, u8) = (30, 0);

pub(crate) const IE: u32 = 1;
pub(crate) const EXL: u32 = 2;
pub(crate) const ERL: u32 = 4;
pub(crate) const BEV: u32 = 1 << 22;

/// An opcode with an immediate.
pub(crate) fn immediate(opcode: u32, rt: u32, rs: u32, value: u32) -> u32 {
    opcode << 26 | rs << 21 | rt << 16 | value & 0xFFFF
}

/// SPECIAL.
pub(crate) fn special(function: u32, rd: u32, rs: u32, rt: u32) -> u32 {
    rs << 21 | rt << 16 | rd << 11 | function
}

pub(crate) fn mtc0((register, select): (u8, u8), rt: u32) -> u32 {
    0x4080_0000 | rt << 16 | u32::from(register) << 11 | u32::from(select)
}

pub(crate) fn mfc0((register, select): (u8, u8), rt: u32) -> u32 {
    0x4000_0000 | rt << 16 | u32::from(register) << 11 | u32::from(select)
}

/// One register at [`REGISTER`], and everything that was done to it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Register {
    pub(crate) value: u32,
    pub(crate) accesses: Vec<(Access, Option<u32>)>,
    pub(crate) taken: Vec<Taken>,
    pub(crate) returned: Vec<u64>,
    pub(crate) horizon: Option<u64>,
    /// What the horizon becomes with the next store.
    pub(crate) horizon_after_store: Option<u64>,
}

impl Bus for Register {
    fn load(&mut self, access: Access) -> Result<u32, BusFault> {
        self.accesses.push((access, None));
        match access.address & !3 {
            0x1F80_0600 => Ok(self.value),
            _ => Err(BusFault),
        }
    }

    fn store(&mut self, access: Access, value: u32) -> Result<(), BusFault> {
        self.accesses.push((access, Some(value)));
        if access.address & !3 != 0x1F80_0600 {
            return Err(BusFault);
        }
        if access.width == Width::Word {
            self.value = value;
        }
        self.horizon = self.horizon_after_store.take().or(self.horizon);
        Ok(())
    }

    fn horizon(&self) -> u64 {
        self.horizon.unwrap_or(u64::MAX)
    }

    fn interrupt_taken(&mut self, taken: Taken) {
        self.taken.push(taken);
    }

    fn exception_returned(&mut self, cycle: u64) {
        self.returned.push(cycle);
    }
}

/// All of it.
#[derive(Clone, Debug)]
pub(crate) struct Bench {
    pub(crate) cpu: Cpu,
    pub(crate) memory: Memory,
    pub(crate) bus: Register,
}

impl Bench {
    /// Words at the begin of program flash, executed from there in kernel mode without interrupts; flash and RAM without
    /// wait states.
    pub(crate) fn new(words: &[u32]) -> Self {
        Self::at(FLASH, words)
    }

    /// Words anywhere in flash.
    pub(crate) fn at(address: u32, words: &[u32]) -> Self {
        let mut image = Image::erased();
        image.write(address, &bytes(words)).expect("it is flash");
        let mut memory = Memory::new(&image);
        memory.set_flash_timing(FlashTiming {
            wait_states: 0,
            prefetch: Prefetch::Both,
        });
        memory.set_ram_wait_states(0);
        let mut bench = Self {
            cpu: Cpu::new(),
            memory,
            bus: Register::default(),
        };
        bench.set(EXCEPTION_BASE, 0x9D01_0000);
        bench.set(STATUS, 0);
        bench.cpu.set_pc(address);
        bench
    }

    pub(crate) fn set(&mut self, (register, select): (u8, u8), value: u32) {
        self.cpu.set_system_register(register, select, value);
    }

    pub(crate) fn get(&self, (register, select): (u8, u8)) -> u32 {
        self.cpu.system_register(register, select)
    }

    pub(crate) fn step(&mut self) -> Exit {
        self.cpu.step(&mut self.memory, &mut self.bus)
    }

    pub(crate) fn run(&mut self, cycles: u64) -> Exit {
        let until = self.cpu.cycle() + cycles;
        self.cpu.run(&mut self.memory, &mut self.bus, until)
    }
}

pub(crate) fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
