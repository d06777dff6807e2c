//! The pins of a board, from robots/*/pinout.toml, checked against the chip's table.

use crate::chip::{Chip, PortNames, PortPin};
use anyhow::{Context, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;

/// What a pin is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
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

impl Kind {
    /// Whether the pin drives.
    pub(super) fn drives(self) -> bool {
        matches!(self, Self::Output | Self::Pwm)
    }

    /// As it stands in the file.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
            Self::Analog => "analog",
            Self::Pwm => "pwm",
            Self::Capture => "capture",
            Self::Spare => "spare",
        }
    }
}

/// A level that means something, if anybody knows which.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Active {
    /// The supply.
    High,
    /// 0 V.
    Low,
    /// Nobody knows.
    Unknown,
}

/// A level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Level {
    /// The supply.
    High,
    /// 0 V.
    Low,
}

/// What holds an input that nothing drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Pull {
    /// A resistor on the board to the supply.
    BoardUp,
    /// The chip's weak pull-up of a change notice.
    ChipUp,
    /// Nothing.
    None,
    /// Nobody knows.
    Unknown,
}

/// How sure a row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(in crate::codegen) enum Confidence {
    /// Written down by who followed the trace.
    Known,
    /// Derived.
    Estimated,
    /// Chosen for the simulator.
    Placeholder,
    /// Nobody knows.
    Unknown,
}

/// One pin of the board.
#[derive(Debug)]
pub(crate) struct Signal {
    /// Our name, in lower case with hyphens.
    pub(in crate::codegen) name: String,
    /// Name in the original software.
    pub(super) original: Option<String>,
    /// Pin of a port.
    pub(in crate::codegen) port: PortPin,
    /// Pin of the package.
    pub(in crate::codegen) pin: u16,
    /// What it is used for.
    pub(super) kind: Kind,
    /// Level that means what the name says.
    pub(super) active: Active,
    /// What holds it.
    pub(super) pull: Pull,
    /// Function of the pin that is used.
    pub(super) function: Option<String>,
    /// Level from the first instruction on.
    pub(super) safe: Option<Level>,
    /// How sure the row is.
    pub(in crate::codegen) confidence: Confidence,
    /// Where it comes from.
    pub(super) source: String,
    /// What else matters.
    pub(super) note: String,
}

/// All pins of a board.
#[derive(Debug)]
pub(crate) struct Pinout {
    /// The chip.
    pub(in crate::codegen) chip: Chip,
    /// In the order of the file.
    pub(in crate::codegen) signals: Vec<Signal>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPinout {
    chip: String,
    /// The folder of the firmware, which [`super::Board`] reads.
    #[serde(rename = "firmware")]
    _firmware: Option<String>,
    /// Pins of a connector that are no port pins. The check of the circuit boards reads them, as it does `connector` of a signal.
    #[serde(rename = "connector")]
    _connector: Option<toml::Table>,
    signal: Vec<RawSignal>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawSignal {
    name: String,
    original: Option<String>,
    port: String,
    pin: u16,
    kind: Kind,
    active: Active,
    pull: Pull,
    function: Option<String>,
    safe: Option<Level>,
    #[serde(rename = "connector")]
    _connector: Option<u8>,
    #[serde(rename = "button-board")]
    _button_board: Option<String>,
    confidence: Confidence,
    source: String,
    note: Option<String>,
}

impl Pinout {
    /// Reads the pinout of a robot's folder; fails with all faults that it has.
    pub(in crate::codegen) fn load(robots: &Path, robot: &Path) -> anyhow::Result<Self> {
        let path = robot.join("pinout.toml");
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text, |chip| Chip::load(robots, chip)).with_context(|| path.display().to_string())
    }

    pub(super) fn parse(text: &str, chip: impl FnOnce(&str) -> anyhow::Result<Chip>) -> anyhow::Result<Self> {
        let raw: RawPinout = toml::from_str(text)?;
        let chip = chip(&raw.chip)?;
        let signals = raw
            .signal
            .into_iter()
            .map(|raw| signal(raw, chip.port_names))
            .collect::<anyhow::Result<_>>()?;
        let pinout = Self { chip, signals };
        let faults = pinout.faults();
        if !faults.is_empty() {
            bail!("{}", faults.join("; "));
        }
        Ok(pinout)
    }

    /// Everything that does not fit together.
    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let (mut names, mut pins) = (BTreeSet::new(), BTreeSet::new());
        for signal in &self.signals {
            if !names.insert(signal.name.as_str()) {
                faults.push(format!("{}: there are two of this name", signal.name));
            }
            if !pins.insert(signal.port) {
                faults.push(format!("{}: {} has a name already", signal.name, signal.port));
            }
            let own = signal.faults(&self.chip);
            faults.extend(own.into_iter().map(|fault| format!("{}: {fault}", signal.name)));
        }
        let forgotten = self
            .chip
            .port_pins()
            .into_iter()
            .filter(|port| !pins.contains(port));
        faults.extend(
            forgotten.map(|port| format!("{port} is missing; name it, as a spare when it is not used")),
        );
        faults
    }
}

fn signal(raw: RawSignal, names: PortNames) -> anyhow::Result<Signal> {
    let Some(port) = names.pin(&raw.port) else {
        bail!(
            "{}: {:?} is no port pin such as {}",
            raw.name,
            raw.port,
            names.example()
        );
    };
    Ok(Signal {
        port,
        name: raw.name,
        original: raw.original,
        pin: raw.pin,
        kind: raw.kind,
        active: raw.active,
        pull: raw.pull,
        function: raw.function,
        safe: raw.safe,
        confidence: raw.confidence,
        source: raw.source,
        note: raw.note.unwrap_or_default(),
    })
}

impl Signal {
    fn faults(&self, chip: &Chip) -> Vec<String> {
        let mut faults = Vec::new();
        let plain = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
        if !self.name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !self.name.chars().all(plain)
        {
            faults.push("a name is made of small letters, digits and hyphens".to_owned());
        }
        match chip.package_pin(self.port) {
            Some(pin) if pin == self.pin => {}
            Some(pin) => faults.push(format!("{} is package pin {pin}, not {}", self.port, self.pin)),
            None => faults.push(format!("the {} has no port pin {}", chip.name, self.port)),
        }
        if self.source.trim().is_empty() {
            faults.push("a row without a source cannot be checked by anybody".to_owned());
        }
        faults.extend(self.function_fault(chip));
        faults.extend(self.level_fault());
        if self.pull == Pull::ChipUp && chip.number(self.pin, "CN").is_none() {
            faults.push("the chip has a pull-up only on change notice pins".to_owned());
        }
        faults
    }

    fn function_fault(&self, chip: &Chip) -> Option<String> {
        let has = |prefix: &str| {
            self.function
                .as_ref()
                .is_some_and(|name| name.starts_with(prefix))
        };
        if let Some(function) = &self.function
            && !chip.functions(self.pin).contains(function)
        {
            let known = chip.functions(self.pin).join(", ");
            return Some(format!(
                "package pin {} has no function {function}, but: {known}",
                self.pin
            ));
        }
        match self.kind {
            Kind::Analog if !has("AN") => Some("an analog input needs an AN function".to_owned()),
            Kind::Pwm if !has("OC") => Some("a pwm output needs an OC function".to_owned()),
            Kind::Capture if !has("IC") => Some("a capture input needs an IC function".to_owned()),
            Kind::Input | Kind::Output | Kind::Spare if has("AN") => Some(format!(
                "the function is analog, but the kind is {}",
                self.kind.word()
            )),
            _ => None,
        }
    }

    fn level_fault(&self) -> Option<String> {
        match (self.kind.drives(), self.safe) {
            (true, None) => Some("an output needs a safe level".to_owned()),
            (false, Some(_)) => Some("only outputs have a safe level".to_owned()),
            (true, Some(_)) if self.active == Active::Unknown => {
                Some("nobody may drive a line whose active level is unknown".to_owned())
            }
            // Motors and the charger hang on pwm outputs: at its safe level none of them may run.
            (true, Some(safe)) if self.kind == Kind::Pwm && self.active == active(safe) => {
                Some("a pwm output must be safe at the level that is not active".to_owned())
            }
            _ => None,
        }
    }
}

fn active(level: Level) -> Active {
    match level {
        Level::High => Active::High,
        Level::Low => Active::Low,
    }
}

#[cfg(test)]
mod tests {
    use super::Pinout;
    use crate::chip::Chip;

    const CHIP: &str = "name = \"x\"\ntitle = \"X\"\njtag = []\nport-names = \"lettered\"\ncrystal = []\n[memory]\n[pins]\n\
                        14 = [\"CN11\", \"RG9\"]\n72 = [\"OC1\", \"RD0\"]\n20 = [\"AN5\", \"CN7\", \"RB5\"]\n";

    const GOOD: [&str; 3] = [
        "name = \"bumper\"\nport = \"RG9\"\npin = 14\nkind = \"input\"\nactive = \"low\"\npull = \"chip-up\"\nfunction = \"CN11\"",
        "name = \"wheel\"\nport = \"RD0\"\npin = 72\nkind = \"pwm\"\nactive = \"high\"\npull = \"none\"\nfunction = \"OC1\"\nsafe = \"low\"",
        "name = \"level\"\nport = \"RB5\"\npin = 20\nkind = \"analog\"\nactive = \"high\"\npull = \"unknown\"\nfunction = \"AN5\"",
    ];

    fn read(signals: &[String]) -> Result<usize, String> {
        let mut text = "chip = \"x\"\n".to_owned();
        for signal in signals {
            text += &format!("[[signal]]\n{signal}\nconfidence = \"known\"\nsource = \"board\"\n");
        }
        Pinout::parse(&text, |_| Chip::parse(CHIP))
            .map(|pinout| pinout.signals.len())
            .map_err(|error| format!("{error:#}"))
    }

    /// The good pinout with one text replaced in one signal.
    fn refused(signal: usize, from: &str, to: &str) -> String {
        let mut signals = GOOD.map(str::to_owned);
        assert!(signals[signal].contains(from), "{from}");
        signals[signal] = signals[signal].replace(from, to);
        read(&signals).expect_err(to)
    }

    #[test]
    fn a_coherent_pinout_is_taken() {
        assert_eq!(read(&GOOD.map(str::to_owned)), Ok(3));
    }

    #[test]
    fn each_slip_is_named() {
        let table = [
            (0, "RG9", "RG8", "no port pin RG8"),
            (0, "RG9", "RD0", "RD0 has a name already"),
            (0, "pin = 14", "pin = 15", "RG9 is package pin 14, not 15"),
            (0, "\"bumper\"", "\"wheel\"", "two of this name"),
            (0, "\"bumper\"", "\"Bumper\"", "small letters"),
            (0, "CN11", "CN12", "no function CN12, but: CN11, RG9"),
            (
                0,
                "\"low\"",
                "\"low\"\nsafe = \"low\"",
                "only outputs have a safe level",
            ),
            (1, "\nsafe = \"low\"", "", "an output needs a safe level"),
            (1, "safe = \"low\"", "safe = \"high\"", "not active"),
            (1, "active = \"high\"", "active = \"unknown\"", "nobody may drive"),
            (1, "\nfunction = \"OC1\"", "", "needs an OC function"),
            (1, "\"none\"", "\"chip-up\"", "only on change notice pins"),
            (2, "\"analog\"", "\"input\"", "the function is analog"),
            (2, "AN5", "CN7", "an analog input needs an AN function"),
        ];
        for (signal, from, to, wanted) in table {
            let said = refused(signal, from, to);
            assert!(said.contains(wanted), "{to}: {said}");
        }
    }

    #[test]
    fn a_forgotten_pin_is_named() {
        let said = read(&[GOOD[0].to_owned(), GOOD[1].to_owned()]).expect_err("one is missing");
        assert!(said.contains("RB5 is missing"), "{said}");
    }
}
