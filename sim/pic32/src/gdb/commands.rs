//! Requests of the debugger and their answers.

use super::description::{by_number, register_hex, registers, xml};
use super::packet::{PACKET_BYTES, from_hex, hex, number, unescaped};
use super::{DebugTarget, NoMemory, Stop};

/// What becomes of a packet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PacketReply {
    /// This text; the empty one for what is not known here.
    Text(String),
    /// Why the program has stopped.
    Why,
    /// The program runs; an answer comes when it stops.
    Run,
    /// The program ran and has stopped.
    Stop(Stop),
    /// `OK`, and no acknowledgements from now on.
    WithoutAcknowledgement,
    /// `OK`, and the debugger is gone.
    Leave,
    /// The debugger is gone.
    Kill,
}

const OK: &str = "OK";
/// A packet that is not well formed.
const MALFORMED: &str = "E22";
/// An address without memory.
const FAULT: &str = "E14";

/// Does what a packet asks.
pub(super) fn answer(packet: &[u8], target: &mut dyn DebugTarget) -> PacketReply {
    let Some((command, rest)) = packet.split_first() else {
        return PacketReply::Text(String::new());
    };
    let text = match command {
        b'?' => return PacketReply::Why,
        b'c' | b's' => return resume(*command, rest, target),
        b'D' => return PacketReply::Leave,
        b'k' => return PacketReply::Kill,
        b'q' => query(rest, target),
        b'Q' if rest == b"StartNoAckMode" => return PacketReply::WithoutAcknowledgement,
        b'v' => return long(rest, target),
        b'g' => Ok(all_registers(target)),
        b'G' => set_all_registers(rest, target),
        b'p' => one_register(rest, target),
        b'P' => set_one_register(rest, target),
        b'm' => read(rest, target),
        b'M' => write(rest, target),
        b'X' => write_binary(rest, target),
        b'Z' | b'z' => breakpoint(*command, rest, target),
        // One thread: any choice is right.
        b'H' | b'T' => Ok(OK.to_owned()),
        _ => Ok(String::new()),
    };
    PacketReply::Text(text.unwrap_or_else(str::to_owned))
}

/// An answer, or a refusal.
type Text = Result<String, &'static str>;

impl From<NoMemory> for &'static str {
    fn from(_: NoMemory) -> Self {
        FAULT
    }
}

fn resume(command: u8, rest: &[u8], target: &mut dyn DebugTarget) -> PacketReply {
    if let Some(address) = number(rest) {
        target.set_register(super::GdbRegister::ProgramCounter, address);
    }
    match command {
        b'c' => PacketReply::Run,
        _ => PacketReply::Stop(target.step()),
    }
}

fn query(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (name, arguments) = split(rest, b':').unwrap_or((rest, &[]));
    Ok(match name {
        b"Supported" => format!(
            "PacketSize={PACKET_BYTES:x};qXfer:features:read+;QStartNoAckMode+;swbreak+;hwbreak+;vContSupported+"
        ),
        b"Xfer" => return transfer(arguments),
        b"Attached" => "1".to_owned(),
        b"C" => "QC1".to_owned(),
        b"fThreadInfo" => "m1".to_owned(),
        b"sThreadInfo" => "l".to_owned(),
        name if name.starts_with(b"Rcmd,") => return monitor(name.get(5..).unwrap_or_default(), target),
        _ => String::new(),
    })
}

/// A piece of the target description.
fn transfer(arguments: &[u8]) -> Text {
    let Some(range) = arguments.strip_prefix(b"features:read:target.xml:") else {
        return Ok(String::new());
    };
    let (start, length) = pair(range)?;
    let text = xml();
    let start = (start as usize).min(text.len());
    let end = start.saturating_add(length as usize).min(text.len());
    let piece = text.get(start..end).ok_or(MALFORMED)?;
    let mark = if end == text.len() { 'l' } else { 'm' };
    Ok(format!("{mark}{piece}"))
}

/// `monitor` commands of the debugger's user.
fn monitor(command: &[u8], target: &mut dyn DebugTarget) -> Text {
    let command = from_hex(command).ok_or(MALFORMED)?;
    let text = match command.as_slice() {
        b"reset" => {
            target.reset();
            "the chip was reset\n".to_owned()
        }
        b"cycle" => format!("{} cycles of SYSCLK since power-on\n", target.cycle()),
        _ => "monitor reset: resets the chip\nmonitor cycle: tells the time in cycles of SYSCLK\n".to_owned(),
    };
    Ok(hex(text.as_bytes()))
}

fn long(rest: &[u8], target: &mut dyn DebugTarget) -> PacketReply {
    match rest {
        b"Cont?" => PacketReply::Text("vCont;c;C;s;S".to_owned()),
        _ => match rest.strip_prefix(b"Cont;").and_then(|actions| actions.first()) {
            Some(b'c' | b'C') => PacketReply::Run,
            Some(b's' | b'S') => PacketReply::Stop(target.step()),
            _ => PacketReply::Text(String::new()),
        },
    }
}

fn all_registers(target: &dyn DebugTarget) -> String {
    registers()
        .map(|register| register_hex(target, Some(register)))
        .collect()
}

fn set_all_registers(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    for (register, digits) in registers().zip(rest.chunks_exact(8)) {
        target.set_register(register, word(digits)?);
    }
    Ok(OK.to_owned())
}

fn one_register(rest: &[u8], target: &dyn DebugTarget) -> Text {
    let register = number(rest).and_then(by_number).ok_or(MALFORMED)?;
    Ok(register_hex(target, register))
}

fn set_one_register(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (register, digits) = split(rest, b'=').ok_or(MALFORMED)?;
    let register = number(register).and_then(by_number).ok_or(MALFORMED)?;
    if let Some(register) = register {
        target.set_register(register, word(digits)?);
    }
    Ok(OK.to_owned())
}

fn word(digits: &[u8]) -> Result<u32, &'static str> {
    let bytes = from_hex(digits).ok_or(MALFORMED)?;
    let bytes: [u8; 4] = bytes.as_slice().try_into().map_err(|_| MALFORMED)?;
    Ok(u32::from_le_bytes(bytes))
}

fn read(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (address, length) = pair(rest)?;
    let length = (length as usize).min(PACKET_BYTES / 2);
    let mut bytes = vec![0; length];
    target.read(address, &mut bytes)?;
    Ok(hex(&bytes))
}

fn write(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (place, digits) = split(rest, b':').ok_or(MALFORMED)?;
    let (address, length) = pair(place)?;
    let bytes = from_hex(digits).ok_or(MALFORMED)?;
    put(target, (address, length), &bytes)
}

fn write_binary(rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (place, contents) = split(rest, b':').ok_or(MALFORMED)?;
    put(target, pair(place)?, &unescaped(contents))
}

fn put(target: &mut dyn DebugTarget, (address, length): (u32, u32), bytes: &[u8]) -> Text {
    if bytes.len() != length as usize {
        return Err(MALFORMED);
    }
    target.write(address, bytes)?;
    Ok(OK.to_owned())
}

/// `Z0` and `Z1` are breakpoints; the others would be watchpoints.
fn breakpoint(command: u8, rest: &[u8], target: &mut dyn DebugTarget) -> Text {
    let (kind, place) = split(rest, b',').ok_or(MALFORMED)?;
    let (address, _) = pair(place)?;
    match (kind, command) {
        (b"0" | b"1", b'Z') => target.set_breakpoint(address)?,
        (b"0" | b"1", _) => target.clear_breakpoint(address)?,
        _ => return Ok(String::new()),
    }
    Ok(OK.to_owned())
}

/// Two numbers with a comma between them.
fn pair(text: &[u8]) -> Result<(u32, u32), &'static str> {
    let (first, second) = split(text, b',').ok_or(MALFORMED)?;
    number(first).zip(number(second)).ok_or(MALFORMED)
}

fn split(text: &[u8], mark: u8) -> Option<(&[u8], &[u8])> {
    let place = text.iter().position(|byte| *byte == mark)?;
    Some((text.get(..place)?, text.get(place + 1..)?))
}
