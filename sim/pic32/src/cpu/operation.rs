//! Decoded instructions, eight bytes each.
//!
//! The fields bear the names of the instruction's fields (`rs`, `rt`, `rd`). What the inner loop executes itself is
//! here; everything else is an [`Uncommon`] instruction.

use super::registers::{Source, WriteTarget};

/// An instruction as the inner loop takes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[rustfmt::skip]
pub(crate) enum Operation {
    Nop,
    /// `lui`, and `addiu` or `ori` with register 0.
    Constant { rt: WriteTarget, value: u32 },
    /// `addiu sp, sp, -n`: the stack grows.
    GrowStack { amount: u32 },
    Addu { rd: WriteTarget, rs: Source, rt: Source },
    Subu { rd: WriteTarget, rs: Source, rt: Source },
    And { rd: WriteTarget, rs: Source, rt: Source },
    Or { rd: WriteTarget, rs: Source, rt: Source },
    Xor { rd: WriteTarget, rs: Source, rt: Source },
    Nor { rd: WriteTarget, rs: Source, rt: Source },
    Slt { rd: WriteTarget, rs: Source, rt: Source },
    Sltu { rd: WriteTarget, rs: Source, rt: Source },
    Movz { rd: WriteTarget, rs: Source, rt: Source },
    Movn { rd: WriteTarget, rs: Source, rt: Source },
    Sllv { rd: WriteTarget, rs: Source, rt: Source },
    Srlv { rd: WriteTarget, rs: Source, rt: Source },
    Srav { rd: WriteTarget, rs: Source, rt: Source },
    Rotrv { rd: WriteTarget, rs: Source, rt: Source },
    Sll { rd: WriteTarget, rt: Source, shift: u8 },
    Srl { rd: WriteTarget, rt: Source, shift: u8 },
    Sra { rd: WriteTarget, rt: Source, shift: u8 },
    Rotr { rd: WriteTarget, rt: Source, shift: u8 },
    Addiu { rt: WriteTarget, rs: Source, value: u32 },
    Slti { rt: WriteTarget, rs: Source, value: i32 },
    Sltiu { rt: WriteTarget, rs: Source, value: u32 },
    Andi { rt: WriteTarget, rs: Source, value: u32 },
    Ori { rt: WriteTarget, rs: Source, value: u32 },
    Xori { rt: WriteTarget, rs: Source, value: u32 },
    /// `mask` has the size of the field and stands at bit 0.
    Ext { rt: WriteTarget, rs: Source, shift: u8, mask: u32 },
    /// `mask` stands where the field goes.
    Ins { rt: WriteTarget, rs: Source, shift: u8, mask: u32 },
    Seb { rd: WriteTarget, rt: Source },
    Seh { rd: WriteTarget, rt: Source },
    Wsbh { rd: WriteTarget, rt: Source },
    Clz { rd: WriteTarget, rs: Source },
    Clo { rd: WriteTarget, rs: Source },
    Mul { rd: WriteTarget, rs: Source, rt: Source },
    Multiply { kind: Multiply, rs: Source, rt: Source },
    Div { rs: Source, rt: Source },
    Divu { rs: Source, rt: Source },
    Mfhi { rd: WriteTarget },
    Mflo { rd: WriteTarget },
    Mthi { rs: Source },
    Mtlo { rs: Source },
    Lb { to: Loaded, base: Source, offset: u32 },
    Lbu { to: Loaded, base: Source, offset: u32 },
    Lh { to: Loaded, base: Source, offset: u32 },
    Lhu { to: Loaded, base: Source, offset: u32 },
    Lw { to: Loaded, base: Source, offset: u32 },
    Lwl { to: Loaded, base: Source, offset: u32 },
    Lwr { to: Loaded, base: Source, offset: u32 },
    Sb { rt: Source, base: Source, offset: u32 },
    Sh { rt: Source, base: Source, offset: u32 },
    Sw { rt: Source, base: Source, offset: u32 },
    Swl { rt: Source, base: Source, offset: u32 },
    Swr { rt: Source, base: Source, offset: u32 },
    /// `words` is the distance from the branch itself to its target.
    Beq { rs: Source, rt: Source, words: i32 },
    Bne { rs: Source, rt: Source, words: i32 },
    Blez { rs: Source, words: i32 },
    Bgtz { rs: Source, words: i32 },
    Bltz { rs: Source, words: i32 },
    Bgez { rs: Source, words: i32 },
    /// `target` is the address in the 256 MiB around the delay slot.
    J { target: u32 },
    Jal { target: u32 },
    Jr { rs: Source },
    Jalr { rd: WriteTarget, rs: Source },
    Uncommon(Uncommon),
}

/// Where a load puts what it loads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Loaded {
    /// The register.
    pub(crate) rt: WriteTarget,
    /// Cycles for which the next instruction waits: 1 when it needs what is loaded.
    pub(crate) stall: u8,
}

/// Multiplications into HI and LO.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Multiply {
    Mult,
    Multu,
    Madd,
    Maddu,
    Msub,
    Msubu,
}

/// What a conditional instruction compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Condition {
    /// Equal.
    Equal,
    /// Not equal.
    NotEqual,
    /// Less, signed.
    Less,
    /// Less, unsigned.
    LessUnsigned,
    /// Greater or equal, signed.
    GreaterEqual,
    /// Greater or equal, unsigned.
    GreaterEqualUnsigned,
    /// Greater, signed.
    Greater,
    /// Less or equal, signed.
    LessEqual,
}

impl Condition {
    /// Whether it holds.
    pub(crate) fn holds(self, left: u32, right: u32) -> bool {
        let (signed_left, signed_right) = (left.cast_signed(), right.cast_signed());
        match self {
            Self::Equal => left == right,
            Self::NotEqual => left != right,
            Self::Less => signed_left < signed_right,
            Self::LessUnsigned => left < right,
            Self::GreaterEqual => signed_left >= signed_right,
            Self::GreaterEqualUnsigned => left >= right,
            Self::Greater => signed_left > signed_right,
            Self::LessEqual => signed_left <= signed_right,
        }
    }
}

/// Instructions that leave the inner loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[rustfmt::skip]
pub(crate) enum Uncommon {
    Add { rd: WriteTarget, rs: Source, rt: Source },
    Sub { rd: WriteTarget, rs: Source, rt: Source },
    Addi { rt: WriteTarget, rs: Source, value: i16 },
    /// `beql`, `bnel`, `blezl`, `bgtzl`, `bltzl`, `bgezl`; `words` counts from the delay slot.
    BranchLikely { condition: Condition, rs: Source, rt: Source, words: i16 },
    /// `bltzal`, `bgezal`.
    BranchLink { condition: Condition, rs: Source, words: i16 },
    /// `bltzall`, `bgezall`.
    BranchLinkLikely { condition: Condition, rs: Source, words: i16 },
    Trap { condition: Condition, rs: Source, rt: Source },
    TrapImmediate { condition: Condition, rs: Source, value: i16 },
    Ll { rt: WriteTarget, base: Source, offset: i16 },
    Sc { rt: Source, to: WriteTarget, base: Source, offset: i16 },
    Syscall,
    Break,
    Sdbbp,
    Wait,
    Eret,
    Deret,
    Di { rt: WriteTarget },
    Ei { rt: WriteTarget },
    Mfc0 { rt: WriteTarget, register: u8, select: u8 },
    Mtc0 { rt: Source, register: u8, select: u8 },
    Rdpgpr { rd: WriteTarget, rt: Source },
    Wrpgpr { rd: WriteTarget, rt: Source },
    Rdhwr { rt: WriteTarget, register: u8 },
    CoprocessorUnusable { unit: u8 },
    Reserved,
    /// A breakpoint of the debugger stands before the instruction.
    Breakpoint,
}
