//! Calibration values of a robot: the tables `[[calibration]]` of its robot.toml, checked, and as a firmware source.
//!
//! A *record* is what the firmware finds in the last page of its flash: the values in the order of that file.

use crate::codegen::rust_name;
use anyhow::{Context, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use toml::Value;

/// Most values that fit into the record's page, with room for the head and the check value.
const VALUES_MAX: usize = 256;

/// One value.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Item {
    /// Our name, in lower case with hyphens.
    pub(crate) name: String,
    /// Its former name, which files of measured values may still have.
    former_name: Option<String>,
    /// Unit of the stored whole number.
    pub(crate) unit: String,
    /// Least and greatest value that can be true.
    range: [i32; 2],
    /// How sure `assumed` is.
    confidence: String,
    /// What is taken while nothing was measured.
    assumed: Option<i32>,
    /// What is absent without it.
    needed_for: String,
    /// Name of what the daemon calls absent without it.
    ability: Option<String>,
    /// How to find it.
    measure: String,
    /// What the simulated robot has.
    pub(crate) simulated: i32,
}

/// All values of a robot, in the order of the file.
#[derive(Debug)]
pub(crate) struct Calibration {
    /// The values.
    pub(crate) items: Vec<Item>,
}

/// A figure of robot.toml that the simulator uses, and the calibration value that must agree with it: table, key,
/// value, stored units in one unit of the figure.
const TWINS: [(&str, &str, &str, f64); 5] = [
    ("drive", "distance-per-count", "wheel-distance-per-count", 1e6),
    ("drive", "track", "wheel-track", 1e6),
    ("wheel-motor", "free-speed", "wheel-free-speed", 1e3),
    ("wheel-motor", "dead-band-brake", "wheel-dead-band", 1e3),
    ("battery", "capacity", "battery-capacity", 1e3),
];

impl Calibration {
    /// Reads the values of a robot's folder; fails with all faults that they have.
    pub(crate) fn load(robot: &Path) -> anyhow::Result<Self> {
        let path = robot.join("robot.toml");
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads the text of a robot.toml.
    pub(crate) fn parse(text: &str) -> anyhow::Result<Self> {
        let table: toml::Table = text.parse()?;
        let items = match table.get("calibration") {
            Some(list) => list.clone().try_into().context("[[calibration]]")?,
            None => Vec::new(),
        };
        let calibration = Self { items };
        let mut faults = calibration.faults();
        faults.extend(TWINS.iter().filter_map(|twin| calibration.differs(&table, *twin)));
        if !faults.is_empty() {
            bail!("{}", faults.join("; "));
        }
        Ok(calibration)
    }

    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut names = BTreeSet::new();
        for item in &self.items {
            if !names.insert(item.name.as_str()) {
                faults.push(format!("{}: there are two of this name", item.name));
            }
            faults.extend(item.fault().map(|fault| format!("{}: {fault}", item.name)));
        }
        if self.items.len() > VALUES_MAX {
            faults.push(format!("{} values; {VALUES_MAX} at most", self.items.len()));
        }
        faults
    }

    /// The value of this name, or of this former name.
    pub(crate) fn find(&self, name: &str) -> Option<(usize, &Item)> {
        self.items
            .iter()
            .enumerate()
            .find(|(_, item)| item.name == name || item.former_name.as_deref() == Some(name))
    }

    /// The simulated robot is one robot: a figure that stands in two places is the same in both.
    fn differs(&self, table: &toml::Table, twin: (&str, &str, &str, f64)) -> Option<String> {
        let (group, key, name, scale) = twin;
        let (_, item) = self.find(name)?;
        let figure = table
            .get(group)?
            .get(key)?
            .get("value")
            .and_then(Value::as_float)?;
        let stored = figure * scale;
        ((stored - f64::from(item.simulated)).abs() > 0.5).then(|| {
            format!(
                "{name}: simulated is {}, but {group}.{key} is {stored}",
                item.simulated
            )
        })
    }

    /// The source file for the firmware.
    pub(super) fn source(&self, origin: &str) -> anyhow::Result<String> {
        let mut text = format!(
            "//! Calibration values and their places in the record. Made by cargo xtask codegen from {origin}. Do not edit.\n\n\
             /// Number of values in a record.\npub const COUNT: usize = {};\n\n\
             /// A value that a person measures on the robot.\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\n\
             pub enum Calibrated {{\n",
            self.items.len()
        );
        for item in &self.items {
            writeln!(
                text,
                "    /// {} ({}). Needed for {}.\n    {},",
                first_up(&item.name.replace('-', " ")),
                item.unit,
                item.needed_for,
                rust_name::camel(&item.name)
            )?;
        }
        text.push_str("}\n\n");
        text.push_str(ENTRY);
        writeln!(
            text,
            "/// All values, in the order of the record.\npub const ENTRIES: [Entry; COUNT] = ["
        )?;
        for item in &self.items {
            writeln!(text, "    {},", item.entry())?;
        }
        text.push_str("];\n");
        Ok(text)
    }
}

const ENTRY: &str = "\
impl Calibrated {
    /// Its place in the record.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// What is known of a value before anybody has measured it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which one.
    pub value: Calibrated,
    /// Least value that can be true.
    pub low: i32,
    /// Greatest value that can be true.
    pub high: i32,
    /// What to take while nobody has measured it; `None` = it is unknown then.
    pub assumed: Option<i32>,
}

";

impl Item {
    fn fault(&self) -> Option<String> {
        let [low, high] = self.range;
        let within = |value: i32| low <= value && value <= high;
        let plain = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
        if !self.name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !self.name.chars().all(plain)
        {
            return Some("a name is made of small letters, digits and hyphens".to_owned());
        }
        if !self.ability.iter().flat_map(|name| name.chars()).all(plain) {
            return Some("an ability is made of small letters, digits and hyphens".to_owned());
        }
        if low > high || low == i32::MIN {
            return Some(format!(
                "range [{low}, {high}] is empty or holds the mark of an unknown value"
            ));
        }
        if !within(self.simulated) {
            return Some(format!(
                "simulated is {}, outside of [{low}, {high}]",
                self.simulated
            ));
        }
        if self.assumed.is_some_and(|value| !within(value)) {
            return Some(format!("assumed lies outside of [{low}, {high}]"));
        }
        match (self.confidence.as_str(), self.assumed) {
            ("unknown", None) | ("estimated", Some(_)) => {}
            ("unknown", Some(_)) => return Some("what is assumed is at least estimated".to_owned()),
            ("estimated", None) => return Some("estimated, but nothing is assumed".to_owned()),
            (other, _) => return Some(format!("confidence {other:?}: unknown or estimated")),
        }
        let said = [&self.unit, &self.needed_for, &self.measure];
        (said.iter().any(|text| text.trim().is_empty()) || !self.measure.ends_with('.')).then(|| {
            "unit, needed-for and a sentence in measure are for people: they may not be empty".to_owned()
        })
    }

    fn entry(&self) -> String {
        let [low, high] = self.range;
        let assumed = match self.assumed {
            Some(value) => format!("Some({})", rust_name::number(value)),
            None => "None".to_owned(),
        };
        format!(
            "Entry {{ value: Calibrated::{}, low: {}, high: {}, assumed: {assumed} }}",
            rust_name::camel(&self.name),
            rust_name::number(low),
            rust_name::number(high)
        )
    }

    /// For people.
    pub(super) fn row(&self) -> String {
        let [low, high] = self.range;
        let assumed = self.assumed.map(|value| value.to_string()).unwrap_or_default();
        let measure = self.measure.replace('|', "\\|");
        format!(
            "| `{}` | {} | {low} | {high} | {assumed} | {measure} |",
            self.name, self.unit
        )
    }
}

fn first_up(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().collect::<String>() + letters.as_str(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::Calibration;

    const GOOD: &str = "[drive]\ntrack = { value = 0.23 }\n[[calibration]]\nname = \"wheel-track\"\nunit = \"um\"\n\
                        range = [100_000, 500_000]\nconfidence = \"unknown\"\nneeded-for = \"drive\"\n\
                        measure = \"Turn it.\"\nsimulated = 230_000\n";

    #[test]
    fn values_become_an_enum_in_the_order_of_the_file() {
        let second = GOOD
            .split_once("[[")
            .map_or("", |(_, tail)| tail)
            .replace("wheel-track", "dock-code-ones");
        let text = format!(
            "{GOOD}[[{}",
            second.replace("\"unknown\"", "\"estimated\"\nassumed = 200_000")
        );
        let calibration = Calibration::parse(&text).expect("valid");
        let source = calibration.source("here").expect("text");
        for part in [
            "pub const COUNT: usize = 2;",
            "    /// Wheel track (um). Needed for drive.\n    WheelTrack,",
            "Entry { value: Calibrated::WheelTrack, low: 100_000, high: 500_000, assumed: None }",
            "assumed: Some(200_000) }",
        ] {
            assert!(source.contains(part), "{part}\n{source}");
        }
        assert!(source.find("WheelTrack,") < source.find("DockCodeOnes,"));
        assert_eq!(
            calibration.find("dock-code-ones").map(|(index, _)| index),
            Some(1)
        );
    }

    #[test]
    fn each_slip_is_named() {
        let table = [
            (
                "230_000",
                "231_000",
                "simulated is 231000, but drive.track is 230000",
            ),
            ("230_000", "50_000", "outside of"),
            ("[100_000, 500_000]", "[500_000, 100_000]", "empty"),
            ("\"unknown\"", "\"known\"", "unknown or estimated"),
            ("\"unknown\"", "\"estimated\"", "nothing is assumed"),
            (
                "\"unknown\"",
                "\"unknown\"\nassumed = 200_000",
                "at least estimated",
            ),
            ("\"Turn it.\"", "\"\"", "may not be empty"),
            ("wheel-track", "Wheel", "small letters"),
            ("unit = \"um\"", "unit = \"um\"\ncolour = 1", "colour"),
        ];
        for (from, to, wanted) in table {
            let said = format!("{:#}", Calibration::parse(&GOOD.replace(from, to)).expect_err(to));
            assert!(said.contains(wanted), "{to}: {said}");
        }
    }
}
