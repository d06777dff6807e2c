//! What each pin of a microcontroller's package can be, from robots/chips/*.toml.

use anyhow::{Context, bail};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// A microcontroller's package.
#[derive(Debug)]
pub(super) struct Chip {
    /// Name of its file.
    pub(super) name: String,
    /// Port pins that carry the crystal.
    crystal: Vec<PortPin>,
    pins: BTreeMap<u16, Vec<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    name: String,
    #[serde(rename = "title")]
    _title: String,
    #[serde(rename = "jtag")]
    _jtag: Vec<String>,
    crystal: Vec<String>,
    pins: BTreeMap<String, Vec<String>>,
}

/// A pin of a port: `RB5` is bit 5 of port B of a PIC32, `P1.3` bit 3 of port 1 of an 8051, `GPIO7` a pin of a chip with one port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PortPin {
    /// `A` to `G`, or `0` to `4`; a space for the only port.
    pub(super) port: char,
    /// 0 to 15; of the only port 0 to 47.
    pub(super) bit: u8,
}

impl PortPin {
    /// Reads `RB5`, `P1.3` or `GPIO7`; `None` when it is no port pin.
    pub(super) fn parse(text: &str) -> Option<Self> {
        Self::lettered(text)
            .or_else(|| Self::numbered(text))
            .or_else(|| Self::of_only_port(text))
    }

    fn of_only_port(text: &str) -> Option<Self> {
        let digits = text.strip_prefix("GPIO")?;
        let bit: u8 = digits.parse().ok().filter(|bit| *bit < 48)?;
        (bit.to_string() == digits).then_some(Self { port: ' ', bit })
    }

    fn numbered(text: &str) -> Option<Self> {
        let mut letters = text.strip_prefix('P')?.chars();
        let port = letters.next().filter(|port| ('0'..='4').contains(port))?;
        let mut bits = letters.as_str().strip_prefix('.')?.chars();
        let bit = bits.next()?.to_digit(8)?;
        let is_whole = bits.next().is_none();
        is_whole.then_some(Self { port, bit: bit as u8 })
    }

    fn lettered(text: &str) -> Option<Self> {
        let mut letters = text.strip_prefix('R')?.chars();
        let port = letters.next().filter(|letter| ('A'..='G').contains(letter))?;
        let digits = letters.as_str();
        let bit: u8 = digits.parse().ok().filter(|bit| *bit < 16)?;
        (bit.to_string() == digits).then_some(Self { port, bit })
    }
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

impl Chip {
    /// Reads `robots/chips/NAME.toml`.
    pub(super) fn load(robots: &Path, name: &str) -> anyhow::Result<Self> {
        let path = robots.join("chips").join(format!("{name}.toml"));
        let text = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}, which describes the chip", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads the text of such a file.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        let raw: Raw = toml::from_str(text)?;
        let pin = |(number, functions): (String, Vec<String>)| match number.parse() {
            Ok(number) => Ok((number, functions)),
            Err(_) => bail!("[pins]: {number:?} is no number of a package pin"),
        };
        let port = |text: &String| {
            PortPin::parse(text)
                .with_context(|| format!("crystal: {text:?} is no port pin such as RC12, P1.3 or GPIO7"))
        };
        Ok(Self {
            name: raw.name,
            crystal: raw.crystal.iter().map(port).collect::<anyhow::Result<_>>()?,
            pins: raw.pins.into_iter().map(pin).collect::<anyhow::Result<_>>()?,
        })
    }

    /// Package pin of a port pin that a board can use.
    pub(super) fn package_pin(&self, port: PortPin) -> Option<u16> {
        if self.crystal.contains(&port) {
            return None;
        }
        let name = port.to_string();
        self.pins
            .iter()
            .find(|(_, functions)| functions.contains(&name))
            .map(|(number, _)| *number)
    }

    /// Functions of a package pin.
    pub(super) fn functions(&self, pin: u16) -> &[String] {
        self.pins.get(&pin).map(Vec::as_slice).unwrap_or_default()
    }

    /// Number of a pin's function of one kind: 7 for `CN` on the pin that has CN7.
    pub(super) fn number(&self, pin: u16, kind: &str) -> Option<u8> {
        self.functions(pin)
            .iter()
            .find_map(|function| function.strip_prefix(kind)?.parse().ok())
    }

    /// All port pins that a board can use, sorted.
    pub(super) fn port_pins(&self) -> Vec<PortPin> {
        let mut all: Vec<PortPin> = self
            .pins
            .values()
            .flatten()
            .filter_map(|name| PortPin::parse(name))
            .filter(|port| !self.crystal.contains(port))
            .collect();
        all.sort_unstable();
        all
    }
}

#[cfg(test)]
mod tests {
    use super::{Chip, PortPin};

    #[test]
    fn port_pins_are_read_strictly() {
        assert_eq!(
            PortPin::parse("RB5").map(|pin| pin.to_string()),
            Some("RB5".to_owned())
        );
        assert_eq!(
            PortPin::parse("GPIO29").map(|pin| (pin.port, pin.bit, pin.to_string())),
            Some((' ', 29, "GPIO29".to_owned()))
        );
        assert_eq!(PortPin::parse("GPIO07"), None);
        assert_eq!(
            PortPin::parse("P1.3").map(|pin| (pin.port, pin.bit, pin.to_string())),
            Some(('1', 3, "P1.3".to_owned()))
        );
        for wrong in ["P5.0", "P1.8", "P13", "P1.", "P1.33", "P1.+1"] {
            assert_eq!(PortPin::parse(wrong), None, "{wrong}");
        }
        for wrong in ["RB", "RB16", "RB05", "RH1", "B5", "RTCC", "RB-1", "RB+1"] {
            assert_eq!(PortPin::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_crystal_is_no_port_pin_and_functions_are_found() {
        let chip = Chip::parse(
            "name = \"x\"\ntitle = \"X\"\njtag = []\ncrystal = [\"RC12\"]\n[pins]\n20 = [\"AN5\", \"CN7\", \"RB5\"]\n63 = [\"RC12\"]\n",
        )
        .expect("valid");
        let port = PortPin::parse("RB5").expect("a pin");
        assert_eq!(chip.package_pin(port), Some(20));
        assert_eq!(chip.number(20, "CN"), Some(7));
        assert_eq!(chip.number(20, "AN"), Some(5));
        assert_eq!(chip.number(20, "C"), None);
        assert_eq!(chip.package_pin(PortPin { port: 'C', bit: 12 }), None);
        assert_eq!(chip.port_pins(), [port]);
    }
}
