//! The pins of a board as a firmware source: a constant a signal, and the words that start-up writes.

use super::pinout::{Active, Kind, Level, Pinout, Pull, Signal};
use crate::chip::Chip;
use crate::codegen::rust_name;
use std::fmt::Write;

const TYPES: &str = "
/// A port of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// Port A.
    A,
    /// Port B, whose pins are analog after reset.
    B,
    /// Port C.
    C,
    /// Port D.
    D,
    /// Port E.
    E,
    /// Port F.
    F,
    /// Port G.
    G,
}

/// What a pin is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Digital input.
    Input,
    /// Digital output.
    Output,
    /// Analog input.
    Analog,
    /// Output of an output compare module.
    Pwm,
    /// Input of an input capture module.
    Capture,
    /// Not used: kept an input.
    Spare,
}

/// The level that means what a signal's name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Active {
    /// 3.3 V.
    High,
    /// 0 V.
    Low,
    /// Nobody knows.
    Unknown,
}

/// One pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its port.
    pub port: Port,
    /// Its bit in the port's registers, 0..=15.
    pub bit: u8,
    /// What it is used for.
    pub kind: Kind,
    /// The level that means what its name says.
    pub active: Active,
    /// Its number as a change notice, if it has one.
    pub change: Option<u8>,
    /// Its number as an analog input, if it has one.
    pub analog: Option<u8>,
}

impl Port {
    /// 0 for port A to 6 for port G: the register blocks lie in this order.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl Signal {
    const fn new(port: Port, bit: u8, kind: Kind, active: Active) -> Self {
        Self {
            port,
            bit,
            kind,
            active,
            change: None,
            analog: None,
        }
    }

    const fn with_change(self, number: u8) -> Self {
        Self {
            change: Some(number),
            ..self
        }
    }

    const fn with_analog(self, number: u8) -> Self {
        Self {
            analog: Some(number),
            ..self
        }
    }

    /// Its bit in the port's registers as a mask.
    #[must_use]
    pub const fn mask(self) -> u32 {
        1 << self.bit
    }

    /// Whether it is active in a word that was read from its port; never, when nobody knows the active level.
    #[must_use]
    pub const fn is_active(self, word: u32) -> bool {
        match self.active {
            Active::High => word & self.mask() != 0,
            Active::Low => word & self.mask() == 0,
            Active::Unknown => false,
        }
    }
}

/// What start-up writes to one port: first `lat`, then `tris`, so that no output glitches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortStart {
    /// The port.
    pub port: Port,
    /// Safe levels of its outputs.
    pub lat: u32,
    /// 1 = input, 0 = output.
    pub tris: u32,
}

const fn start(port: Port, lat: u32, tris: u32) -> PortStart {
    PortStart { port, lat, tris }
}

";

/// The source file for the firmware.
pub(super) fn source(pinout: &Pinout, origin: &str) -> Result<String, std::fmt::Error> {
    let mut text =
        format!("//! Pins of the board. Made by cargo xtask codegen from {origin}. Do not edit.\n{TYPES}");
    for signal in &pinout.signals {
        writeln!(text, "{}", constant(signal, &pinout.chip))?;
    }
    let ports: Vec<char> = ('A'..='G').collect();
    writeln!(
        text,
        "/// Start-up words of all ports.\npub const START: [PortStart; {}] = [",
        ports.len()
    )?;
    for port in ports {
        let (lat, tris) = start_words(pinout, port);
        writeln!(text, "    start(Port::{port}, 0x{lat:04X}, 0x{tris:04X}),")?;
    }
    text.push_str("];\n\n");
    let (digital, analog, pull_ups) = shared_words(pinout);
    writeln!(
        text,
        "/// AD1PCFG: 1 = the pin with this analog number is digital.\npub const DIGITAL: u32 = 0x{digital:04X};\n\
         /// Analog numbers of all signals that are analog, as a mask (AD1CSSL takes a subset).\n\
         pub const ANALOG: u32 = 0x{analog:04X};\n\
         /// CNPUE: weak pull-ups of change notices.\npub const PULL_UPS: u32 = 0x{pull_ups:06X};"
    )?;
    Ok(text)
}

fn constant(signal: &Signal, chip: &Chip) -> String {
    let function = signal
        .function
        .as_ref()
        .map(|name| format!(", {name}"))
        .unwrap_or_default();
    let note = if signal.note.is_empty() {
        String::new()
    } else {
        format!(": {}", signal.note)
    };
    let number = |kind: &str, method: &str| match chip.number(signal.pin, kind) {
        Some(number) => format!(".{method}({number})"),
        None => String::new(),
    };
    format!(
        "/// {}, package pin {}{function}{note}.\n\
         pub const {}: Signal = Signal::new(Port::{}, {}, Kind::{}, Active::{}){}{};",
        signal.port,
        signal.pin,
        rust_name::constant(&signal.name),
        signal.port.port,
        signal.port.bit,
        rust_name::camel(signal.kind.word()),
        match signal.active {
            Active::High => "High",
            Active::Low => "Low",
            Active::Unknown => "Unknown",
        },
        number("CN", "with_change"),
        number("AN", "with_analog"),
    )
}

/// LAT and TRIS of a port.
fn start_words(pinout: &Pinout, port: char) -> (u32, u32) {
    let outputs = pinout
        .signals
        .iter()
        .filter(|signal| signal.port.port == port && signal.kind.drives());
    outputs.fold((0, 0xFFFF), |(lat, tris), signal| {
        let mask = 1 << signal.port.bit;
        (
            if signal.safe == Some(Level::High) {
                lat | mask
            } else {
                lat
            },
            tris & !mask,
        )
    })
}

/// AD1PCFG, all analog inputs, and CNPUE.
fn shared_words(pinout: &Pinout) -> (u32, u32, u32) {
    let (mut digital, mut analog, mut pull_ups) = (0_u32, 0_u32, 0_u32);
    for signal in &pinout.signals {
        let mask = |kind| {
            pinout
                .chip
                .number(signal.pin, kind)
                .map_or(0, |number| 1_u32 << number)
        };
        match signal.kind {
            Kind::Analog => analog |= mask("AN"),
            _ => digital |= mask("AN"),
        }
        if signal.pull == Pull::ChipUp {
            pull_ups |= mask("CN");
        }
    }
    (digital, analog, pull_ups)
}
