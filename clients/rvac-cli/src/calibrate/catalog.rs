//! What can be measured on a robot: the tables `[[calibration]]` of its robot.toml and the pins of its pinout.toml.

use anyhow::{Context as _, bail};
use serde::Deserialize;

/// Robots whose tables are part of this program: name, robot.toml, pinout.toml.
const ROBOTS: [(&str, &str, &str); 1] = [(
    "sr8730",
    include_str!("../../../../robots/samsung-sr8730/robot.toml"),
    include_str!("../../../../robots/samsung-sr8730/pinout.toml"),
)];

/// A value that a person measures.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct Item {
    /// Name.
    pub(crate) name: String,
    /// Its former name, which older files and scripts may still have.
    former_name: Option<String>,
    /// Unit of the whole number.
    pub(crate) unit: String,
    /// Least and greatest value that can be true.
    pub(crate) range: [i64; 2],
    /// What the firmware takes without it; `None` = what needs it is absent.
    pub(crate) assumed: Option<i64>,
    /// What is absent without it.
    pub(crate) needed_for: String,
    /// What to do, in a sentence.
    pub(crate) measure: String,
}

impl Item {
    /// A value of it as people read it: a plain number has no unit.
    pub(crate) fn shown(&self, value: i64) -> String {
        match self.unit.as_str() {
            "1" => value.to_string(),
            unit => format!("{value} {unit}"),
        }
    }

    /// What a person is asked who types it.
    pub(crate) fn asked(&self) -> String {
        match self.unit.as_str() {
            "1" => "The value, a whole number?".to_owned(),
            unit => format!("The value, in {unit}?"),
        }
    }
}

#[derive(Debug, Deserialize)]
struct RobotFile {
    #[serde(default)]
    calibration: Vec<Item>,
}

#[derive(Debug, Deserialize)]
struct Pinout {
    signal: Vec<Signal>,
}

#[derive(Debug, Deserialize)]
struct Signal {
    name: String,
    #[serde(default)]
    function: String,
}

/// All that can be measured on one robot.
#[derive(Debug)]
pub(crate) struct Catalog {
    /// Its name.
    pub(crate) robot: &'static str,
    /// The values, in the order in which they are best measured.
    pub(crate) items: Vec<Item>,
    signals: Vec<Signal>,
}

impl Catalog {
    /// The catalog of a robot.
    pub(crate) fn of(robot: &str) -> anyhow::Result<Self> {
        let Some((name, values, pins)) = ROBOTS.into_iter().find(|(name, ..)| *name == robot) else {
            let known = ROBOTS.map(|(name, ..)| name).join(", ");
            bail!("nothing can be calibrated on a robot {robot:?}; known: {known}");
        };
        let values: RobotFile = toml::from_str(values).context("robot.toml of this program")?;
        let pins: Pinout = toml::from_str(pins).context("pinout.toml of this program")?;
        Ok(Self {
            robot: name,
            items: values.calibration,
            signals: pins.signal,
        })
    }

    /// The value of this name, or of this former name.
    pub(crate) fn find(&self, name: &str) -> anyhow::Result<&Item> {
        let is_called = |item: &&Item| item.name == name || item.former_name.as_deref() == Some(name);
        self.items.iter().find(is_called).with_context(|| {
            let known: Vec<&str> = self.items.iter().map(|item| item.name.as_str()).collect();
            format!("there is no value {name:?}; known: {}", known.join(", "))
        })
    }

    /// The converter's channel of a signal, which is written `AN14` among the pin's functions.
    pub(crate) fn channel(&self, signal: &str) -> anyhow::Result<usize> {
        let functions = self
            .signals
            .iter()
            .find(|candidate| candidate.name == signal)
            .map_or("", |found| found.function.as_str());
        functions
            .split([',', ' ', '/'])
            .find_map(|function| function.strip_prefix("AN")?.parse().ok())
            .with_context(|| format!("the pinout gives {signal:?} no channel of the converter"))
    }
}

#[cfg(test)]
mod tests {
    use super::Catalog;

    #[test]
    fn the_robots_own_tables_are_read() {
        let catalog = Catalog::of("sr8730").expect("known");
        let item = catalog.find("wheel-distance-per-count").expect("listed");
        assert_eq!(item.shown(500_000), "500000 nm");
        let former = catalog.find("wheel-count-way").expect("its former name");
        assert_eq!(former.name, item.name);
        let order = catalog.find("wheel-left-order").expect("listed");
        assert_eq!(order.shown(1), "1");
        for (signal, channel) in [
            ("button-ladder", 0),
            ("charger-voltage", 2),
            ("battery-voltage", 3),
            ("cliff-left", 11),
            ("proximity-receive", 12),
            ("wheel-left-current", 14),
        ] {
            assert_eq!(catalog.channel(signal).expect(signal), channel, "{signal}");
        }
        assert!(catalog.channel("vacuum-enable").is_err());
    }

    #[test]
    fn what_is_unknown_is_answered_with_what_is_known() {
        let error = Catalog::of("toaster").expect_err("unknown").to_string();
        assert_eq!(
            error,
            "nothing can be calibrated on a robot \"toaster\"; known: sr8730"
        );
        let catalog = Catalog::of("sr8730").expect("known");
        let error = catalog.find("wheel").expect_err("unknown").to_string();
        assert!(error.contains("known: wheel-distance-per-count, "), "{error}");
    }
}
