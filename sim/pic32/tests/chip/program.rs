//! Programs word by word, and machines that run them.

use pic32::image::Image;
use pic32::machine::{Grounded, Halt, Machine};
use pic32::pins::Pin;

/// Cycles of a microsecond and of a millisecond.
pub(crate) const US: u64 = 80;
pub(crate) const MS: u64 = 80_000;

/// DEVCFG1 of the board: 8 MHz crystal (HS) and PLL, PBCLK = SYSCLK, no clock switching, watchdog under control of the
/// program with 128 ms.
pub(crate) const DEVCFG1: u32 = 0xFF67_CEDB & !(1 << 5);
/// The same with switching and clock monitor (FCKSM = 0).
pub(crate) const DEVCFG1_MONITOR: u32 = DEVCFG1 & !(3 << 14);
const DEVCFG2: u32 = 0xFFF8_FFD9;

/// Registers of the core by their usual names.
pub(crate) const T0: u32 = 8;
pub(crate) const T1: u32 = 9;
pub(crate) const T2: u32 = 10;
pub(crate) const SP: u32 = 29;

pub(crate) const NOP: u32 = 0;
pub(crate) const WAIT: u32 = 0x4200_0020;
pub(crate) const ERET: u32 = 0x4200_0018;
pub(crate) const EI: u32 = 0x4160_6020;
pub(crate) const EHB: u32 = 0xC0;

pub(crate) const fn lui(to: u32, value: u32) -> u32 {
    0x3C00_0000 | to << 16 | value & 0xFFFF
}
pub(crate) const fn ori(to: u32, from: u32, value: u32) -> u32 {
    0x3400_0000 | from << 21 | to << 16 | value & 0xFFFF
}
pub(crate) const fn addiu(to: u32, from: u32, value: i16) -> u32 {
    0x2400_0000 | from << 21 | to << 16 | value as u16 as u32
}
pub(crate) const fn lw(to: u32, offset: i16, base: u32) -> u32 {
    0x8C00_0000 | base << 21 | to << 16 | offset as u16 as u32
}
pub(crate) const fn sw(from: u32, offset: i16, base: u32) -> u32 {
    0xAC00_0000 | base << 21 | from << 16 | offset as u16 as u32
}
pub(crate) const fn sb(from: u32, offset: i16, base: u32) -> u32 {
    0xA000_0000 | base << 21 | from << 16 | offset as u16 as u32
}
pub(crate) const fn mtc0(from: u32, register: u32, select: u32) -> u32 {
    0x4080_0000 | from << 16 | register << 11 | select
}
pub(crate) const fn mfc0(to: u32, register: u32) -> u32 {
    0x4000_0000 | to << 16 | register << 11
}
/// A branch by so many instructions, counted from the one after it.
pub(crate) const fn branch(by: i16) -> u32 {
    0x1000_0000 | by as u16 as u32
}

/// `to` = a 32-bit constant.
pub(crate) fn li(to: u32, value: u32) -> [u32; 2] {
    [lui(to, value >> 16), ori(to, to, value)]
}

/// Stores a constant at an address, by way of T0 and T1.
pub(crate) fn store(address: u32, value: u32) -> Vec<u32> {
    [li(T0, address).as_slice(), &li(T1, value), &[sw(T1, 0, T0)]].concat()
}

/// An endless loop.
pub(crate) const FOREVER: [u32; 2] = [branch(-1), NOP];
/// An endless loop that waits.
pub(crate) const WAIT_FOREVER: [u32; 3] = [WAIT, branch(-2), NOP];

/// Code at addresses, and configuration words.
pub(crate) struct Program {
    image: Image,
}

impl Program {
    /// This code at the reset vector; the board's configuration.
    pub(crate) fn new(code: &[u32]) -> Program {
        Program {
            image: Image::erased(),
        }
        .at(0x1FC0_0000, code)
        .at(0x1FC0_2FF4, &[DEVCFG2, DEVCFG1, 0x7FFF_FFFF])
    }

    pub(crate) fn at(mut self, address: u32, code: &[u32]) -> Program {
        let bytes: Vec<u8> = code.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.image.write(address, &bytes).expect("in flash");
        self
    }

    pub(crate) fn devcfg1(self, value: u32) -> Program {
        self.at(0x1FC0_2FF8, &[value])
    }

    #[allow(dead_code, reason = "the tests of the board use it")]
    pub(crate) fn image(&self) -> &Image {
        &self.image
    }

    pub(crate) fn machine(&self) -> Machine {
        Machine::new(&self.image)
    }
}

/// A program that sets up vectored interrupts (exception base 0x9D00_0000, spacing 32 bytes), writes these registers, turns
/// interrupts on and waits for ever. The handler of each vector given clears its flag (register, bit) and counts in RAM at
/// 4 x vector.
pub(crate) fn interrupting(registers: &[(u32, u32)], vectors: &[(u32, u32, u32)]) -> Program {
    let mut code = Vec::new();
    code.extend(li(SP, 0x8000_8000));
    for (value, register, select) in [
        (0x0040_0000, 12, 0),
        (0x9D00_0000, 15, 1),
        (0x20, 12, 1),
        (0x0080_0000, 13, 0),
    ] {
        code.extend(li(T0, value));
        code.extend([mtc0(T0, register, select), EHB]);
    }
    // Leaves the bootstrap vectors and the error level; interrupts are on only at the end.
    code.extend([mtc0(0, 12, 0), EHB]);
    code.extend(store(0xBF88_1008, 0x1000));
    for &(address, value) in registers {
        code.extend(store(address, value));
    }
    code.extend([EI, EHB]);
    code.extend(WAIT_FOREVER);
    let mut program = Program::new(&code);
    for &(vector, flags, bit) in vectors {
        let handler = 0x9D00_1000 + vector * 64;
        let jump = 0x0800_0000 | (handler & 0x0FFF_FFFF) >> 2;
        let count = [
            lui(26, 0x8000),
            lw(27, 4 * vector as i16, 26),
            NOP,
            addiu(27, 27, 1),
            sw(27, 4 * vector as i16, 26),
        ];
        let clear = [
            lui(26, flags >> 16),
            ori(26, 26, flags + 4),
            ori(27, 0, 1 << bit),
            sw(27, 0, 26),
            lw(27, 0, 26),
        ];
        let body = [count.as_slice(), &clear, &[NOP, ERET]].concat();
        program = program
            .at(0x1D00_0200 + vector * 32, &[jump, NOP])
            .at(handler & 0x1FFF_FFFF, &body);
    }
    program
}

/// A machine that executes nothing but WAIT, for tests that write registers themselves.
pub(crate) fn bare() -> Machine {
    Program::new(&WAIT_FOREVER).machine()
}

pub(crate) fn run(machine: &mut Machine, cycle: u64) {
    assert_eq!(machine.run_until(cycle, &mut Grounded), Halt::Reached);
}

pub(crate) fn word(machine: &Machine, address: u32) -> u32 {
    let mut bytes = [0; 4];
    machine.memory().read(address, &mut bytes).expect("in memory");
    u32::from_le_bytes(bytes)
}

pub(crate) fn pin(name: &str) -> Pin {
    name.parse().expect("a pin")
}

/// Addresses of CLR, SET and INV.
pub(crate) const CLR: u32 = 4;
pub(crate) const SET: u32 = 8;
pub(crate) const INV: u32 = 12;

pub(crate) const WDTCON: u32 = 0xBF80_0000;
pub(crate) const INTCON: u32 = 0xBF88_1000;
pub(crate) const IFS0: u32 = 0xBF88_1030;
pub(crate) const IFS1: u32 = 0xBF88_1040;
pub(crate) const IEC0: u32 = 0xBF88_1060;
pub(crate) const IEC1: u32 = 0xBF88_1070;

/// IPC0 to IPC11.
pub(crate) const fn ipc(number: u32) -> u32 {
    0xBF88_1090 + 16 * number
}
/// TxCON of timer 1 to 5; TMRx is 16 further, PRx 32.
pub(crate) const fn timer(number: u32) -> u32 {
    0xBF80_0400 + 0x200 * number
}
/// OCxCON of 1 to 5; OCxR is 16 further, OCxRS 32.
pub(crate) const fn oc(number: u32) -> u32 {
    0xBF80_2E00 + 0x200 * number
}
/// ICxCON of 1 to 5; ICxBUF is 16 further.
pub(crate) const fn ic(number: u32) -> u32 {
    0xBF80_1E00 + 0x200 * number
}
