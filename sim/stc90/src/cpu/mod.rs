//! The core: registers, internal RAM, and the instructions of the 8051.
//!
//! It knows nothing of peripherals, which are behind the trait [`Bus`]. One call of [`Cpu::run`] executes whole
//! instructions until a cycle or the bus's horizon is reached.
//!
//! The instruction map has a row for each upper half of an opcode and a column for each lower half. Columns 6 to 15 are
//! one instruction with another place of its operand, and columns 0 to 5 have one function each.

mod arithmetic;
mod bits;
mod bus;
mod code;
mod columns;
mod flow;
mod operand;
mod regular;
mod timing;

pub use bus::{Bus, CoreFault, External};
pub use code::{CODE_BYTES, Code};

use timing::CYCLES;

/// PSW: carry.
const CARRY: u8 = 0x80;
/// PSW: carry from bit 3.
const HALF_CARRY: u8 = 0x40;
/// PSW: number of the register bank, as offset of its R0 in internal RAM.
const BANK: u8 = 0x18;
/// PSW: overflow.
const OVERFLOW: u8 = 0x04;
/// PSW: odd number of ones in the accumulator; computed when it is read.
const PARITY: u8 = 0x01;
/// AUXR1: which DPTR.
const DPS: u8 = 0x01;
/// AUXR1: the bits that exist, DPS and the free flag GF2.
const AUXR1_BITS: u8 = 0x09;
/// The stack pointer after a reset.
const SP_RESET: u8 = 0x07;
/// Address of no instruction.
const NO_PC: u32 = 0x1_0000;
/// What the hardware needs to call an interrupt's handler, as long as an LCALL.
const INTERRUPT_CYCLES: u64 = 2;

/// The core with its registers and internal RAM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cpu {
    code: Code,
    ram: [u8; 256],
    cycle: u64,
    pc: u16,
    /// Address of the instruction that is executed.
    begin: u16,
    /// Address whose executions are counted; none is above the last one.
    counted_pc: u32,
    passes: u64,
    a: u8,
    b: u8,
    psw: u8,
    sp: u8,
    sp_max: u8,
    dptr: [u16; 2],
    auxr1: u8,
}

impl Cpu {
    /// A core after a reset at cycle 0, with a cleared RAM.
    #[must_use]
    pub fn new(code: Code) -> Self {
        Self {
            code,
            ram: [0; 256],
            cycle: 0,
            pc: 0,
            begin: 0,
            counted_pc: NO_PC,
            passes: 0,
            a: 0,
            b: 0,
            psw: 0,
            sp: SP_RESET,
            sp_max: SP_RESET,
            dptr: [0; 2],
            auxr1: 0,
        }
    }

    /// Resets the registers; RAM stays as it is.
    pub fn reset(&mut self) {
        *self = Self {
            code: self.code.clone(),
            ram: self.ram,
            cycle: self.cycle,
            sp_max: self.sp_max,
            counted_pc: self.counted_pc,
            passes: self.passes,
            ..Self::new(self.code.clone())
        };
    }

    /// Executes instructions until `cycle` or the bus's horizon is reached.
    pub fn run<B: Bus>(&mut self, bus: &mut B, cycle: u64) {
        while self.cycle < cycle && self.cycle < bus.horizon() {
            self.step(bus);
        }
    }

    /// Executes one instruction.
    #[inline]
    pub fn step<B: Bus>(&mut self, bus: &mut B) {
        self.begin = self.pc;
        self.passes += u64::from(u32::from(self.pc) == self.counted_pc);
        let opcode = self.fetch();
        match opcode & 0x0F {
            0x0 => self.column_0(opcode >> 4, bus),
            0x1 => self.absolute(opcode, bus),
            0x2 => self.column_2(opcode >> 4, bus),
            0x3 => self.column_3(opcode >> 4, bus),
            0x4 => self.column_4(opcode >> 4),
            0x5 => self.column_5(opcode >> 4, bus),
            low => self.regular(opcode >> 4, low, bus),
        }
        self.cycle += u64::from(CYCLES[usize::from(opcode)]);
    }

    /// Calls the handler of an interrupt.
    pub fn interrupt<B: Bus>(&mut self, vector: u16, bus: &mut B) {
        self.begin = self.pc;
        self.push_pc(bus);
        self.pc = vector;
        self.cycle += INTERRUPT_CYCLES;
    }

    /// Lets time pass without executing anything.
    pub fn wait_until(&mut self, cycle: u64) {
        self.cycle = self.cycle.max(cycle);
    }

    /// Machine cycles since power-on.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// When an access of the instruction that is executed takes effect.
    fn access_cycle(&self) -> u64 {
        self.cycle + 1
    }

    /// Address of the next instruction.
    #[must_use]
    pub fn pc(&self) -> u16 {
        self.pc
    }

    /// Address of the instruction that was executed last.
    #[must_use]
    pub fn begin(&self) -> u16 {
        self.begin
    }

    /// Counts from now on how often the instruction at an address is executed: the head of a main loop, say.
    pub fn count_passes(&mut self, pc: u16) {
        self.counted_pc = u32::from(pc);
        self.passes = 0;
    }

    /// How often it was executed since then.
    #[must_use]
    pub fn passes(&self) -> u64 {
        self.passes
    }

    /// Continues at another address.
    pub fn set_pc(&mut self, pc: u16) {
        self.pc = pc;
    }

    /// The accumulator.
    #[must_use]
    pub fn a(&self) -> u8 {
        self.a
    }

    /// The program status word, with parity.
    #[must_use]
    pub fn psw(&self) -> u8 {
        self.psw & !PARITY | (self.a.count_ones() as u8 & PARITY)
    }

    /// The stack pointer.
    #[must_use]
    pub fn sp(&self) -> u8 {
        self.sp
    }

    /// The highest stack pointer that a push or a call has left since power-on.
    #[must_use]
    pub fn sp_max(&self) -> u8 {
        self.sp_max
    }

    /// The selected DPTR.
    #[must_use]
    pub fn dptr(&self) -> u16 {
        self.dptr[usize::from(self.auxr1 & DPS)]
    }

    /// Internal RAM.
    #[must_use]
    pub fn ram(&self) -> &[u8; 256] {
        &self.ram
    }

    /// Internal RAM, to begin with contents of one's own: at power-on it holds anything.
    pub fn ram_mut(&mut self) -> &mut [u8; 256] {
        &mut self.ram
    }

    /// The program.
    #[must_use]
    pub fn code(&self) -> &Code {
        &self.code
    }

    /// The value of a register of the core by its address among the special function registers.
    #[must_use]
    pub fn register(&self, address: u8) -> Option<u8> {
        let [low, high] = self.dptr().to_le_bytes();
        Some(match address {
            0x81 => self.sp,
            0x82 => low,
            0x83 => high,
            0xA2 => self.auxr1,
            0xD0 => self.psw(),
            0xE0 => self.a,
            0xF0 => self.b,
            _ => return None,
        })
    }

    /// Sets it; says whether this is a register of the core.
    pub fn set_register(&mut self, address: u8, value: u8) -> bool {
        let selected = usize::from(self.auxr1 & DPS);
        let [low, high] = self.dptr[selected].to_le_bytes();
        match address {
            0x81 => self.sp = value,
            0x82 => self.dptr[selected] = u16::from_le_bytes([value, high]),
            0x83 => self.dptr[selected] = u16::from_le_bytes([low, value]),
            0xA2 => self.auxr1 = value & AUXR1_BITS,
            0xD0 => self.psw = value,
            0xE0 => self.a = value,
            0xF0 => self.b = value,
            _ => return false,
        }
        true
    }
}
