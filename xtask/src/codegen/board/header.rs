//! The pins of a board with an 8051 as a header for SDCC: a bit variable a signal, the levels that mean something, and what
//! start-up writes.

use super::pinout::{Active, Level, Pinout, Signal};
use crate::codegen::rust_name;
use std::fmt::Write;

/// Address of port 0 among the registers; each next port comes 16 later, and P4 elsewhere.
const PORT_0: u8 = 0x80;
const PORT_STEP: u8 = 0x10;
/// Ports that all packages have.
const PORTS: u8 = 4;

/// The header.
pub(super) fn source(pinout: &Pinout, origin: &str) -> anyhow::Result<String> {
    let mut text = format!(
        "/* Pins of the board. Made by cargo xtask codegen from {origin}. Do not edit.\n *\n \
         * For each signal: a bit variable; _PORT and _MASK for those that are read together; and, where somebody knows\n \
         * it, _ACTIVE, the level that means what the name says. */\n\
         #ifndef PINS_H\n#define PINS_H\n"
    );
    for signal in &pinout.signals {
        push_signal(&mut text, signal)?;
    }
    text.push_str(
        "\n/* What start-up writes to the ports before anything else: outputs safe, inputs let go. */\n",
    );
    for port in 0..PORTS {
        writeln!(text, "#define P{port}_START 0x{:02X}", start(pinout, port))?;
    }
    text.push_str("\n#endif\n");
    Ok(text)
}

fn push_signal(text: &mut String, signal: &Signal) -> std::fmt::Result {
    let name = rust_name::constant(&signal.name);
    let (port, bit) = (number(signal), signal.port.bit);
    let note = signal.note.replace("*/", "* /");
    writeln!(
        text,
        "\n/* {}, package pin {}, {}: {note}. */",
        signal.port,
        signal.pin,
        signal.kind.word()
    )?;
    let address = PORT_0 + PORT_STEP * port + bit;
    writeln!(text, "__sbit __at(0x{address:02X}) {name};")?;
    writeln!(text, "#define {name}_PORT P{port}")?;
    writeln!(text, "#define {name}_MASK 0x{:02X}", 1_u8 << bit)?;
    match signal.active {
        Active::High => writeln!(text, "#define {name}_ACTIVE 1"),
        Active::Low => writeln!(text, "#define {name}_ACTIVE 0"),
        Active::Unknown => Ok(()),
    }
}

/// The number of a port; a port with a letter is none of an 8051, which the chip's table rules out.
fn number(signal: &Signal) -> u8 {
    signal.port.port.to_digit(10).map_or(0, |port| port as u8)
}

/// The latches of a port: a one for everything but an output that is safe when low.
fn start(pinout: &Pinout, port: u8) -> u8 {
    let lows = pinout
        .signals
        .iter()
        .filter(|signal| number(signal) == port && signal.safe == Some(Level::Low));
    lows.fold(0xFF, |latches, signal| latches & !(1 << signal.port.bit))
}

#[cfg(test)]
mod tests {
    use super::source;
    use crate::chip::Chip;
    use crate::codegen::board::pinout::Pinout;

    const CHIP: &str = "name = \"x\"\ntitle = \"X\"\njtag = []\nport-names = \"numbered\"\ncrystal = []\n[memory]\n[pins]\n\
                        4 = [\"P1.3\"]\n34 = [\"AD5\", \"P0.5\"]\n23 = [\"A10\", \"P2.2\"]\n";
    const PINS: &str = "chip = \"x\"\n\
        [[signal]]\nname = \"wheel-back\"\nport = \"P1.3\"\npin = 4\nkind = \"output\"\nactive = \"high\"\npull = \"none\"\n\
        safe = \"low\"\nconfidence = \"known\"\nsource = \"here\"\nnote = \"a wheel\"\n\
        [[signal]]\nname = \"service\"\nport = \"P0.5\"\npin = 34\nkind = \"spare\"\nactive = \"unknown\"\npull = \"unknown\"\n\
        confidence = \"unknown\"\nsource = \"here\"\n\
        [[signal]]\nname = \"bumper\"\nport = \"P2.2\"\npin = 23\nkind = \"input\"\nactive = \"low\"\npull = \"board-up\"\n\
        confidence = \"known\"\nsource = \"here\"\nnote = \"left\"\n";

    #[test]
    fn signals_become_bits_with_levels() {
        let pinout = Pinout::parse(PINS, |_| Chip::parse(CHIP)).expect("valid");
        let text = source(&pinout, "here").expect("text");
        for part in [
            "/* P1.3, package pin 4, output: a wheel. */\n__sbit __at(0x93) WHEEL_BACK;\n#define WHEEL_BACK_PORT P1\n\
             #define WHEEL_BACK_MASK 0x08\n#define WHEEL_BACK_ACTIVE 1\n",
            "__sbit __at(0x85) SERVICE;",
            "__sbit __at(0xA2) BUMPER;",
            "#define BUMPER_ACTIVE 0\n",
            "#define P0_START 0xFF\n#define P1_START 0xF7\n#define P2_START 0xFF\n#define P3_START 0xFF\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("SERVICE_ACTIVE"));
    }
}
