//! Instruction words.

/// The registers that programs keep for themselves: where their data lie, and addresses on the way to use.
pub(crate) const DATA: u32 = 26;
pub(crate) const SCRATCH: u32 = 28;
pub(crate) const COUNTER: u32 = 27;
pub(crate) const LINK: u32 = 31;

/// SPECIAL: register to register.
pub(crate) fn special(function: u32, rd: u32, rs: u32, rt: u32) -> u32 {
    rs << 21 | rt << 16 | rd << 11 | function
}

/// A shift by a constant; `rs` is 1 for rotations.
pub(crate) fn shift(function: u32, rd: u32, rt: u32, (rs, amount): (u32, u32)) -> u32 {
    rs << 21 | rt << 16 | rd << 11 | amount << 6 | function
}

/// SPECIAL2.
pub(crate) fn special2(function: u32, rd: u32, rs: u32, rt: u32) -> u32 {
    0x1C << 26 | special(function, rd, rs, rt)
}

/// An opcode with an immediate.
pub(crate) fn immediate(opcode: u32, rt: u32, rs: u32, value: u32) -> u32 {
    opcode << 26 | rs << 21 | rt << 16 | value & 0xFFFF
}

/// REGIMM.
pub(crate) fn condition(kind: u32, rs: u32, value: u32) -> u32 {
    immediate(1, kind, rs, value)
}

/// `ext` takes `size` bits from `low` on.
pub(crate) fn ext(rt: u32, rs: u32, low: u32, size: u32) -> u32 {
    0x1F << 26 | rs << 21 | rt << 16 | (size - 1) << 11 | low << 6
}

/// `ins` puts `size` bits to `low`.
pub(crate) fn ins(rt: u32, rs: u32, low: u32, size: u32) -> u32 {
    0x1F << 26 | rs << 21 | rt << 16 | (low + size - 1) << 11 | low << 6 | 4
}

/// `wsbh`, `seb`, `seh` by their kind.
pub(crate) fn bytes(kind: u32, rd: u32, rt: u32) -> u32 {
    0x1F << 26 | rt << 16 | rd << 11 | kind << 6 | 0x20
}

/// `j` or `jal`.
pub(crate) fn jump(opcode: u32, target: u32) -> u32 {
    opcode << 26 | target >> 2 & 0x03FF_FFFF
}

/// `lui` and `ori`: any constant.
pub(crate) fn constant(register: u32, value: u32) -> [u32; 2] {
    [
        immediate(0x0F, register, 0, value >> 16),
        immediate(0x0D, register, register, value),
    ]
}

pub(crate) const NOP: u32 = 0;
pub(crate) const SYSCALL: u32 = 0x0C;
