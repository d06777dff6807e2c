//! What a microcontroller is, from robots/chips/*.toml: what each pin of its package can be, and its memory.

mod memory;
mod port_pin;

pub(crate) use memory::Region;
pub(crate) use port_pin::{PortNames, PortPin};

use anyhow::{Context, bail};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A microcontroller's package.
#[derive(Debug)]
pub(crate) struct Chip {
    /// Name of its file.
    pub(crate) name: String,
    /// What people call it.
    pub(crate) title: String,
    /// How its port pins are called.
    pub(crate) port_names: PortNames,
    /// Port pins that carry the crystal.
    crystal: Vec<PortPin>,
    pins: BTreeMap<u16, Vec<String>>,
    memory: BTreeMap<String, Region>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Raw {
    name: String,
    title: String,
    #[serde(rename = "jtag")]
    _jtag: Vec<String>,
    port_names: PortNames,
    crystal: Vec<String>,
    memory: BTreeMap<String, Region>,
    pins: BTreeMap<String, Vec<String>>,
}

impl Chip {
    /// Reads `robots/chips/NAME.toml`.
    pub(crate) fn load(robots: &Path, name: &str) -> anyhow::Result<Self> {
        let path = robots.join("chips").join(format!("{name}.toml"));
        let text = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}, which describes the chip", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads the text of such a file.
    pub(crate) fn parse(text: &str) -> anyhow::Result<Self> {
        let raw: Raw = toml::from_str(text)?;
        let pin = |(number, functions): (String, Vec<String>)| match number.parse() {
            Ok(number) => Ok((number, functions)),
            Err(_) => bail!("[pins]: {number:?} is no number of a package pin"),
        };
        let port = |text: &String| {
            raw.port_names.pin(text).with_context(|| {
                format!(
                    "crystal: {text:?} is no port pin such as {}",
                    raw.port_names.example()
                )
            })
        };
        Ok(Self {
            name: raw.name,
            title: raw.title,
            port_names: raw.port_names,
            memory: raw.memory,
            crystal: raw.crystal.iter().map(port).collect::<anyhow::Result<_>>()?,
            pins: raw.pins.into_iter().map(pin).collect::<anyhow::Result<_>>()?,
        })
    }

    /// A stretch of its memory.
    pub(crate) fn region(&self, name: &str) -> anyhow::Result<&Region> {
        self.memory
            .get(name)
            .with_context(|| format!("robots/chips/{}.toml has no [memory.{name}]", self.name))
    }

    /// Package pin of a port pin that a board can use.
    pub(crate) fn package_pin(&self, port: PortPin) -> Option<u16> {
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
    pub(crate) fn functions(&self, pin: u16) -> &[String] {
        self.pins.get(&pin).map(Vec::as_slice).unwrap_or_default()
    }

    /// Number of a pin's function of one kind: 7 for `CN` on the pin that has CN7.
    pub(crate) fn number(&self, pin: u16, kind: &str) -> Option<u8> {
        self.functions(pin)
            .iter()
            .find_map(|function| function.strip_prefix(kind)?.parse().ok())
    }

    /// All port pins that a board can use, sorted.
    pub(crate) fn port_pins(&self) -> Vec<PortPin> {
        let mut all: Vec<PortPin> = self
            .pins
            .values()
            .flatten()
            .filter_map(|name| self.port_names.pin(name))
            .filter(|port| !self.crystal.contains(port))
            .collect();
        all.sort_unstable();
        all
    }
}

#[cfg(test)]
mod tests {
    use super::{Chip, PortNames, PortPin};

    #[test]
    fn the_crystal_is_no_port_pin_and_functions_are_found() {
        let chip = Chip::parse(
            "name = \"x\"\ntitle = \"X\"\njtag = []\nport-names = \"lettered\"\ncrystal = [\"RC12\"]\n[memory.ram]\nstart = 0\nbytes = 64\nbudget-bytes = 48\n[pins]\n20 = [\"AN5\", \"CN7\", \"RB5\"]\n63 = [\"RC12\"]\n",
        )
        .expect("valid");
        let port = PortNames::Lettered.pin("RB5").expect("a pin");
        assert_eq!(chip.package_pin(port), Some(20));
        assert_eq!(chip.number(20, "CN"), Some(7));
        assert_eq!(chip.number(20, "AN"), Some(5));
        assert_eq!(chip.number(20, "C"), None);
        assert_eq!(chip.package_pin(PortPin { port: 'C', bit: 12 }), None);
        assert_eq!(chip.port_pins(), [port]);
        let ram = chip.region("ram").expect("it has some");
        assert_eq!((ram.addresses(), ram.budget_bytes()), (0..64, 48));
        assert!(chip.region("flash").is_err());
    }
}
