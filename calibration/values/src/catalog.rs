//! What can be measured on a robot: the tables `[[calibration]]` of its robot.toml and the pins of its pinout.toml.

use serde::Deserialize;

use crate::error::ValuesError;

/// What is known about a robot, as text.
#[derive(Clone, Copy, Debug)]
pub struct RobotTables<'a> {
    /// Its name.
    pub robot: &'a str,
    /// Its robot.toml.
    pub values: &'a str,
    /// Its pinout.toml.
    pub pins: &'a str,
}

/// Robots whose tables are part of this program.
const ROBOTS: [RobotTables<'static>; 1] = [RobotTables {
    robot: "sr8730",
    values: include_str!("../../../robots/samsung-sr8730/robot.toml"),
    pins: include_str!("../../../robots/samsung-sr8730/pinout.toml"),
}];

/// A value that a person measures.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Item {
    /// Name.
    pub name: String,
    /// Its former name, which older files and scripts may still have.
    former_name: Option<String>,
    /// Unit of the whole number.
    pub unit: String,
    /// Least and greatest value that can be true.
    pub range: [i64; 2],
    /// What the firmware takes without it; `None` = what needs it is absent.
    pub assumed: Option<i64>,
    /// What is absent without it.
    pub needed_for: String,
    /// What to do, in a sentence.
    pub measure: String,
}

impl Item {
    /// A value of it as people read it: a plain number has no unit.
    #[must_use]
    pub fn shown(&self, value: i64) -> String {
        match self.unit.as_str() {
            "1" => value.to_string(),
            unit => format!("{value} {unit}"),
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
pub struct Catalog {
    /// Its name.
    pub robot: String,
    /// The values, in the order in which they are best measured.
    pub items: Vec<Item>,
    signals: Vec<Signal>,
}

impl Catalog {
    /// The catalog of a robot whose tables come with this program.
    ///
    /// # Errors
    /// There are no tables of it.
    pub fn of(robot: &str) -> Result<Self, ValuesError> {
        let Some(tables) = ROBOTS.into_iter().find(|tables| tables.robot == robot) else {
            return Err(ValuesError::UnknownRobot {
                robot: robot.to_owned(),
                known: ROBOTS.map(|tables| tables.robot).join(", "),
            });
        };
        Self::read(tables)
    }

    /// The catalog of a robot with these tables.
    ///
    /// # Errors
    /// They are none.
    pub fn read(tables: RobotTables<'_>) -> Result<Self, ValuesError> {
        let values: RobotFile =
            toml::from_str(tables.values).map_err(|error| ValuesError::Table("robot.toml", error))?;
        let pins: Pinout =
            toml::from_str(tables.pins).map_err(|error| ValuesError::Table("pinout.toml", error))?;
        Ok(Self {
            robot: tables.robot.to_owned(),
            items: values.calibration,
            signals: pins.signal,
        })
    }

    /// The value of this name, or of this former name.
    ///
    /// # Errors
    /// There is none.
    pub fn find(&self, name: &str) -> Result<&Item, ValuesError> {
        let is_called = |item: &&Item| item.name == name || item.former_name.as_deref() == Some(name);
        self.items.iter().find(is_called).ok_or_else(|| {
            let known: Vec<&str> = self.items.iter().map(|item| item.name.as_str()).collect();
            ValuesError::UnknownValue {
                name: name.to_owned(),
                known: known.join(", "),
            }
        })
    }

    /// The converter's channel of a signal, which is written `AN14` among the pin's functions.
    ///
    /// # Errors
    /// No pin of the converter reads it.
    pub fn channel(&self, signal: &str) -> Result<usize, ValuesError> {
        let functions = self
            .signals
            .iter()
            .find(|candidate| candidate.name == signal)
            .map_or("", |found| found.function.as_str());
        functions
            .split([',', ' ', '/'])
            .find_map(|function| function.strip_prefix("AN")?.parse().ok())
            .ok_or_else(|| ValuesError::NoChannel(signal.to_owned()))
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
