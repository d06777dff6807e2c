//! The pins of the 100-pin package as the program names them: a port letter and a bit, "RG9".
//!
//! A *level* is what a voltmeter would see, an *output* is what the chip itself does to the pin. A pin that the chip
//! does not drive is *floating* for the chip, whatever the circuit around it does.

use std::fmt;
use std::str::FromStr;

/// One of the seven ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Port {
    /// RA0 to RA15.
    A,
    /// RB0 to RB15, which are also the analog inputs AN0 to AN15.
    B,
    /// RC1 to RC15.
    C,
    /// RD0 to RD15.
    D,
    /// RE0 to RE9.
    E,
    /// RF0 to RF13.
    F,
    /// RG0 to RG15.
    G,
}

impl Port {
    /// All ports in the order of their letters.
    pub const ALL: [Port; 7] = [Port::A, Port::B, Port::C, Port::D, Port::E, Port::F, Port::G];

    /// 0 for port A to 6 for port G.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Which bits exist on the 100-pin part.
    pub const fn present(self) -> u16 {
        match self {
            Port::A => 0xC6FF,
            Port::B => 0xFFFF,
            Port::C => 0xF01E,
            Port::D => 0xFFFF,
            Port::E => 0x03FF,
            Port::F => 0x31FF,
            Port::G => 0xF3CF,
        }
    }

    /// The letter, 'A' to 'G'.
    pub const fn letter(self) -> char {
        (b'A' + self as u8) as char
    }
}

/// A pin that exists on the 100-pin part.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pin {
    port: Port,
    bit: u8,
}

/// How many places an array indexed by [`Pin::index`] needs.
pub const PIN_PLACES: usize = 7 * 16;

/// Pins of CN0 to CN21, from the change-notice table of the reference.
const CHANGE_NOTICE: [Pin; 22] = [
    known(Port::C, 14),
    known(Port::C, 13),
    known(Port::B, 0),
    known(Port::B, 1),
    known(Port::B, 2),
    known(Port::B, 3),
    known(Port::B, 4),
    known(Port::B, 5),
    known(Port::G, 6),
    known(Port::G, 7),
    known(Port::G, 8),
    known(Port::G, 9),
    known(Port::B, 15),
    known(Port::D, 4),
    known(Port::D, 5),
    known(Port::D, 6),
    known(Port::D, 7),
    known(Port::F, 4),
    known(Port::F, 5),
    known(Port::D, 13),
    known(Port::D, 14),
    known(Port::D, 15),
];

/// A pin of one of the tables in this crate, which are checked by the tests.
pub(crate) const fn known(port: Port, bit: u8) -> Pin {
    Pin { port, bit }
}

impl Pin {
    /// The pin with this port and bit, if the package has it.
    pub const fn new(port: Port, bit: u8) -> Option<Pin> {
        if bit < 16 && port.present() & (1 << bit) != 0 {
            Some(Pin { port, bit })
        } else {
            None
        }
    }

    /// Its port.
    pub const fn port(self) -> Port {
        self.port
    }

    /// Its bit in the port's registers, 0 to 15.
    pub const fn bit(self) -> u8 {
        self.bit
    }

    /// Its bit as a mask.
    pub const fn mask(self) -> u16 {
        1 << self.bit
    }

    /// A number below [`PIN_PLACES`].
    pub const fn index(self) -> usize {
        self.port as usize * 16 + self.bit as usize
    }

    /// The number of its change-notice input, 0 to 21, if it has one.
    pub fn change_notice(self) -> Option<u8> {
        CHANGE_NOTICE
            .iter()
            .position(|&pin| pin == self)
            .and_then(|number| u8::try_from(number).ok())
    }

    /// The pin of a change-notice input, 0 to 21.
    pub fn of_change_notice(number: u8) -> Option<Pin> {
        CHANGE_NOTICE.get(usize::from(number)).copied()
    }

    /// The number of its analog input: port B alone has them, with equal numbers.
    pub const fn analog(self) -> Option<u8> {
        match self.port {
            Port::B => Some(self.bit),
            _ => None,
        }
    }

    /// All pins, by port and bit.
    pub fn all() -> impl Iterator<Item = Pin> {
        Port::ALL
            .into_iter()
            .flat_map(|port| (0..16).filter_map(move |bit| Pin::new(port, bit)))
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "R{}{}", self.port.letter(), self.bit)
    }
}

impl fmt::Debug for Pin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// Why a text is not the name of a pin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PinError {
    /// It does not have the form of "RG9".
    #[error("{0:?} is not of the form RG9")]
    Form(String),
    /// The form is right, but the 100-pin part has no such pin.
    #[error("the 100-pin part has no pin {0}")]
    Absent(String),
}

impl FromStr for Pin {
    type Err = PinError;

    fn from_str(text: &str) -> Result<Pin, PinError> {
        let form = || PinError::Form(text.to_owned());
        let rest = text.strip_prefix('R').ok_or_else(form)?;
        let letter = rest.chars().next().ok_or_else(form)?;
        let digits = &rest[letter.len_utf8()..];
        let decimal = digits.bytes().all(|byte| byte.is_ascii_digit());
        let padded = digits.len() > 1 && digits.starts_with('0');
        if !decimal || padded {
            return Err(form());
        }
        let bit: u8 = digits.parse().map_err(|_| form())?;
        let port = Port::ALL
            .into_iter()
            .find(|port| port.letter() == letter)
            .ok_or_else(form)?;
        Pin::new(port, bit).ok_or_else(|| PinError::Absent(text.to_owned()))
    }
}

/// What a voltmeter would see on a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Level {
    /// Ground.
    Low,
    /// The supply.
    High,
}

impl Level {
    /// High for `true`.
    pub const fn of(high: bool) -> Level {
        if high { Level::High } else { Level::Low }
    }

    /// Whether it is high.
    pub const fn is_high(self) -> bool {
        matches!(self, Level::High)
    }
}

/// What the chip itself does to a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PinDriver {
    /// It drives the pin to the supply.
    High,
    /// It drives the pin to ground.
    Low,
    /// It leaves the pin alone: an input, or an open drain that is off. A weak pull-up does not count as driving.
    Floating,
}

impl PinDriver {
    /// Whether the chip drives the pin high: the question of everything that is switched on by a high level.
    pub const fn is_high(self) -> bool {
        matches!(self, PinDriver::High)
    }

    /// The level that it gives the pin, if it drives it.
    pub const fn level(self) -> Option<Level> {
        match self {
            PinDriver::High => Some(Level::High),
            PinDriver::Low => Some(Level::Low),
            PinDriver::Floating => None,
        }
    }
}

impl From<Level> for PinDriver {
    fn from(level: Level) -> PinDriver {
        match level {
            Level::Low => PinDriver::Low,
            Level::High => PinDriver::High,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_data_sheet_and_of_pins_that_exist() {
        for pin in Pin::all() {
            assert_eq!(pin.to_string().parse(), Ok(pin));
        }
        assert_eq!(Pin::all().count(), 12 + 16 + 8 + 16 + 10 + 11 + 12);
        for wrong in [
            "", "R", "RG", "G9", "RG9 ", "RG09", "RH1", "rg9", "RG+9", "RG-1", "RG999", "RÄ1",
        ] {
            assert_eq!(wrong.parse::<Pin>(), Err(PinError::Form(wrong.to_owned())));
        }
        for absent in ["RA8", "RC0", "RE10", "RF9", "RG4", "RG16"] {
            assert_eq!(absent.parse::<Pin>(), Err(PinError::Absent(absent.to_owned())));
        }
    }

    #[test]
    fn change_notice_inputs_are_distinct_pins_of_the_package() {
        for (number, pin) in (0..22).zip(CHANGE_NOTICE) {
            assert_eq!(Pin::new(pin.port, pin.bit), Some(pin));
            assert_eq!(pin.change_notice(), Some(number));
        }
        assert_eq!(Pin::of_change_notice(22), None);
        assert_eq!("RG15".parse::<Pin>().map(Pin::change_notice), Ok(None));
    }
}
