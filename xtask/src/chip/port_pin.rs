//! How a chip's maker names the pins of its ports.

use serde::Deserialize;
use std::fmt;

/// How a chip's port pins are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PortNames {
    /// Ports have letters, as a PIC32's: `RB5` is bit 5 of port B.
    Lettered,
    /// Ports have digits, as an 8051's: `P1.3` is bit 3 of port 1.
    Numbered,
    /// There is one port: `GPIO7`.
    Single,
}

impl PortNames {
    /// Reads the name of a port pin; `None` when it is none of such a chip.
    pub(crate) fn pin(self, name: &str) -> Option<PortPin> {
        match self {
            Self::Lettered => lettered(name),
            Self::Numbered => numbered(name),
            Self::Single => of_single_port(name),
        }
    }

    /// One of them, for people who wrote another.
    pub(crate) const fn example(self) -> &'static str {
        match self {
            Self::Lettered => "RB5",
            Self::Numbered => "P1.3",
            Self::Single => "GPIO7",
        }
    }
}

fn lettered(name: &str) -> Option<PortPin> {
    let mut letters = name.strip_prefix('R')?.chars();
    let port = letters.next().filter(|letter| ('A'..='G').contains(letter))?;
    let digits = letters.as_str();
    let bit: u8 = digits.parse().ok().filter(|bit| *bit < 16)?;
    (bit.to_string() == digits).then_some(PortPin { port, bit })
}

fn numbered(name: &str) -> Option<PortPin> {
    let mut letters = name.strip_prefix('P')?.chars();
    let port = letters.next().filter(|port| ('0'..='4').contains(port))?;
    let mut bits = letters.as_str().strip_prefix('.')?.chars();
    let bit = bits.next()?.to_digit(8)?;
    let is_whole = bits.next().is_none();
    is_whole.then_some(PortPin { port, bit: bit as u8 })
}

fn of_single_port(name: &str) -> Option<PortPin> {
    let digits = name.strip_prefix("GPIO")?;
    let bit: u8 = digits.parse().ok().filter(|bit| *bit < 48)?;
    (bit.to_string() == digits).then_some(PortPin { port: ' ', bit })
}

/// A pin of a port: `RB5` is bit 5 of port B of a PIC32, `P1.3` bit 3 of port 1 of an 8051, `GPIO7` a pin of a chip with one port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PortPin {
    /// `A` to `G`, or `0` to `4`; a space for the only port.
    pub(crate) port: char,
    /// 0 to 15; of the only port 0 to 47.
    pub(crate) bit: u8,
}

impl fmt::Display for PortPin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.port == ' ' {
            write!(formatter, "GPIO{}", self.bit)
        } else if self.port.is_ascii_digit() {
            write!(formatter, "P{}.{}", self.port, self.bit)
        } else {
            write!(formatter, "R{}{}", self.port, self.bit)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::PortNames::{Lettered, Numbered, Single};

    #[test]
    fn port_pins_are_read_strictly() {
        let table = [
            (Lettered, "RB5", ('B', 5)),
            (Single, "GPIO29", (' ', 29)),
            (Numbered, "P1.3", ('1', 3)),
        ];
        for (names, name, wanted) in table {
            let pin = names.pin(name).expect("a pin");
            assert_eq!((pin.port, pin.bit), wanted, "{name}");
            assert_eq!(pin.to_string(), name);
            assert!(names.pin(names.example()).is_some(), "{names:?}");
        }
        for wrong in ["P5.0", "P1.8", "P13", "P1.", "P1.33", "P1.+1", "RB5"] {
            assert_eq!(Numbered.pin(wrong), None, "{wrong}");
        }
        for wrong in ["RB", "RB16", "RB05", "RH1", "B5", "RTCC", "RB-1", "RB+1", "GPIO7"] {
            assert_eq!(Lettered.pin(wrong), None, "{wrong}");
        }
        for wrong in ["GPIO07", "GPIO48", "P1.3"] {
            assert_eq!(Single.pin(wrong), None, "{wrong}");
        }
    }
}
