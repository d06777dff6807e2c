//! The target description: which registers there are, in which order.

use super::{DebugTarget, GdbRegister};
use std::fmt::Write;

/// Registers of the floating point unit, which GDB wants to hear of for any MIPS: 32 and two of control. They are told
/// as not available.
const FLOAT_REGISTERS: u32 = 34;
/// The first of them.
const FLOAT_START: u32 = 38;

/// All registers that exist, in the order of their numbers.
pub(super) fn registers() -> impl Iterator<Item = GdbRegister> {
    let others = [
        GdbRegister::Status,
        GdbRegister::Low,
        GdbRegister::High,
        GdbRegister::BadAddress,
        GdbRegister::Cause,
        GdbRegister::ProgramCounter,
    ];
    (0..32).map(GdbRegister::General).chain(others)
}

/// A register by its number, or whether it is one that does not exist here.
pub(super) fn by_number(number: u32) -> Option<Option<GdbRegister>> {
    match number {
        ..FLOAT_START => registers().nth(number as usize).map(Some),
        _ if number < FLOAT_START + FLOAT_REGISTERS => Some(None),
        _ => None,
    }
}

/// A register as the protocol encodes it.
pub(super) fn register_hex(target: &dyn DebugTarget, register: Option<GdbRegister>) -> String {
    match register {
        Some(register) => super::packet::hex(&target.register(register).to_le_bytes()),
        None => "xxxxxxxx".to_owned(),
    }
}

/// The XML that GDB reads at the begin.
pub(super) fn xml() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?><!DOCTYPE target SYSTEM \"gdb-target.dtd\"><target version=\"1.0\">\
         <architecture>mips:isa32r2</architecture><osabi>none</osabi>",
    );
    let cpu = (0..32).map(|number| (format!("r{number}"), number));
    let cpu = cpu.chain([
        ("lo".to_owned(), 33),
        ("hi".to_owned(), 34),
        ("pc".to_owned(), 37),
    ]);
    feature(&mut text, "org.gnu.gdb.mips.cpu", "int", cpu);
    let system = [("status", 32), ("badvaddr", 35), ("cause", 36)];
    let system = system.into_iter().map(|(name, number)| (name.to_owned(), number));
    feature(&mut text, "org.gnu.gdb.mips.cp0", "int", system);
    let float = (0..32).map(|number| (format!("f{number}"), FLOAT_START + number));
    let float = float.chain([("fcsr".to_owned(), 70), ("fir".to_owned(), 71)]);
    feature(&mut text, "org.gnu.gdb.mips.fpu", "ieee_single", float);
    text.push_str("</target>");
    text
}

fn feature(text: &mut String, name: &str, kind: &str, registers: impl Iterator<Item = (String, u32)>) {
    // Writing to a string cannot fail.
    let _ = write!(text, "<feature name=\"{name}\">");
    for (name, number) in registers {
        let kind = if name.starts_with("fc") || name.starts_with("fi") {
            "int"
        } else {
            kind
        };
        let _ = write!(
            text,
            "<reg name=\"{name}\" bitsize=\"32\" regnum=\"{number}\" type=\"{kind}\"/>"
        );
    }
    text.push_str("</feature>");
}
