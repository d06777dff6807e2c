//! Which registers an instruction reads: a load stalls when the next instruction needs what it loads.

use crate::cpu::STACK_POINTER;
use crate::cpu::operation::{Loaded, Operation, Uncommon};
use crate::cpu::registers::{Source, WriteTarget};

/// Where a load puts what it loads.
pub(super) fn loaded(operation: &mut Operation) -> Option<&mut Loaded> {
    match operation {
        Operation::Lb { to, .. }
        | Operation::Lbu { to, .. }
        | Operation::Lh { to, .. }
        | Operation::Lhu { to, .. }
        | Operation::Lw { to, .. }
        | Operation::Lwl { to, .. }
        | Operation::Lwr { to, .. } => Some(to),
        _ => None,
    }
}

/// Whether the instruction after this one is its delay slot.
pub(super) fn has_delay_slot(operation: Operation) -> bool {
    matches!(
        operation,
        Operation::Beq { .. }
            | Operation::Bne { .. }
            | Operation::Blez { .. }
            | Operation::Bgtz { .. }
            | Operation::Bltz { .. }
            | Operation::Bgez { .. }
            | Operation::J { .. }
            | Operation::Jal { .. }
            | Operation::Jr { .. }
            | Operation::Jalr { .. }
            | Operation::Uncommon(
                Uncommon::BranchLikely { .. }
                    | Uncommon::BranchLink { .. }
                    | Uncommon::BranchLinkLikely { .. }
            )
    )
}

/// Whether the instruction needs the register at its begin.
pub(super) fn reads(operation: Operation, loaded: WriteTarget) -> bool {
    let (first, second) = sources(operation);
    let is_read = |source: Option<Source>| source.is_some_and(|source| loaded.is_read_by(source));
    let inserted = matches!(operation, Operation::Ins { rt, .. } if rt == loaded);
    is_read(first) || is_read(second) || inserted
}

/// The registers that an instruction reads.
fn sources(operation: Operation) -> (Option<Source>, Option<Source>) {
    match operation {
        Operation::Nop
        | Operation::Constant { .. }
        | Operation::Mfhi { .. }
        | Operation::Mflo { .. }
        | Operation::J { .. }
        | Operation::Jal { .. } => (None, None),
        Operation::GrowStack { .. } => (Some(Source::new(STACK_POINTER)), None),
        Operation::Addu { rs, rt, .. }
        | Operation::Subu { rs, rt, .. }
        | Operation::And { rs, rt, .. }
        | Operation::Or { rs, rt, .. }
        | Operation::Xor { rs, rt, .. }
        | Operation::Nor { rs, rt, .. }
        | Operation::Slt { rs, rt, .. }
        | Operation::Sltu { rs, rt, .. }
        | Operation::Movz { rs, rt, .. }
        | Operation::Movn { rs, rt, .. }
        | Operation::Sllv { rs, rt, .. }
        | Operation::Srlv { rs, rt, .. }
        | Operation::Srav { rs, rt, .. }
        | Operation::Rotrv { rs, rt, .. }
        | Operation::Mul { rs, rt, .. }
        | Operation::Multiply { rs, rt, .. }
        | Operation::Div { rs, rt }
        | Operation::Divu { rs, rt }
        | Operation::Beq { rs, rt, .. }
        | Operation::Bne { rs, rt, .. } => (Some(rs), Some(rt)),
        Operation::Sll { rt, .. }
        | Operation::Srl { rt, .. }
        | Operation::Sra { rt, .. }
        | Operation::Rotr { rt, .. }
        | Operation::Seb { rt, .. }
        | Operation::Seh { rt, .. }
        | Operation::Wsbh { rt, .. } => (Some(rt), None),
        Operation::Addiu { rs, .. }
        | Operation::Slti { rs, .. }
        | Operation::Sltiu { rs, .. }
        | Operation::Andi { rs, .. }
        | Operation::Ori { rs, .. }
        | Operation::Xori { rs, .. }
        | Operation::Ext { rs, .. }
        | Operation::Ins { rs, .. }
        | Operation::Clz { rs, .. }
        | Operation::Clo { rs, .. }
        | Operation::Mthi { rs }
        | Operation::Mtlo { rs }
        | Operation::Blez { rs, .. }
        | Operation::Bgtz { rs, .. }
        | Operation::Bltz { rs, .. }
        | Operation::Bgez { rs, .. }
        | Operation::Jr { rs }
        | Operation::Jalr { rs, .. } => (Some(rs), None),
        _ => memory_sources(operation),
    }
}

fn memory_sources(operation: Operation) -> (Option<Source>, Option<Source>) {
    match operation {
        Operation::Lb { base, .. }
        | Operation::Lbu { base, .. }
        | Operation::Lh { base, .. }
        | Operation::Lhu { base, .. }
        | Operation::Lw { base, .. }
        | Operation::Lwl { base, .. }
        | Operation::Lwr { base, .. } => (Some(base), None),
        Operation::Sb { rt, base, .. }
        | Operation::Sh { rt, base, .. }
        | Operation::Sw { rt, base, .. }
        | Operation::Swl { rt, base, .. }
        | Operation::Swr { rt, base, .. } => (Some(base), Some(rt)),
        Operation::Uncommon(uncommon) => uncommon_sources(uncommon),
        _ => (None, None),
    }
}

fn uncommon_sources(uncommon: Uncommon) -> (Option<Source>, Option<Source>) {
    match uncommon {
        Uncommon::Add { rs, rt, .. }
        | Uncommon::Sub { rs, rt, .. }
        | Uncommon::BranchLikely { rs, rt, .. }
        | Uncommon::Trap { rs, rt, .. } => (Some(rs), Some(rt)),
        Uncommon::Addi { rs, .. }
        | Uncommon::BranchLink { rs, .. }
        | Uncommon::BranchLinkLikely { rs, .. }
        | Uncommon::TrapImmediate { rs, .. } => (Some(rs), None),
        Uncommon::Ll { base, .. } => (Some(base), None),
        Uncommon::Sc { rt, base, .. } => (Some(base), Some(rt)),
        Uncommon::Mtc0 { rt, .. } | Uncommon::Rdpgpr { rt, .. } | Uncommon::Wrpgpr { rt, .. } => {
            (Some(rt), None)
        }
        _ => (None, None),
    }
}
