//! Figures of robot.toml that the firmware is built with, as whole numbers in small units.

use crate::codegen::rust_name;
use anyhow::{Context, bail};
use std::fmt::Write;
use std::path::Path;
use toml::{Table, Value};

/// A figure: table, key, name of the constant, unit in the file, stored units in one of those, and what it is.
struct Figure(
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    f64,
    &'static str,
);

const FIGURES: [Figure; 8] = [
    Figure("body", "radius", "RADIUS_UM", "m", 1e6, "Radius of the body, µm."),
    Figure(
        "body",
        "swath",
        "SWATH_UM",
        "m",
        1e6,
        "Width that one pass cleans, µm.",
    ),
    Figure(
        "drive",
        "cruise",
        "CRUISE_UM_PER_S",
        "m/s",
        1e6,
        "Usual cleaning speed, µm/s.",
    ),
    Figure(
        "drive",
        "speed-max",
        "SPEED_MAX_UM_PER_S",
        "m/s",
        1e6,
        "Highest speed, µm/s.",
    ),
    Figure(
        "drive",
        "turn-max",
        "TURN_MAX_URAD_PER_S",
        "rad/s",
        1e6,
        "Highest turn rate, µrad/s.",
    ),
    Figure(
        "battery",
        "cells",
        "BATTERY_CELLS",
        "1",
        1.0,
        "Cells of the battery in series.",
    ),
    Figure(
        "battery",
        "charge",
        "CHARGE_MA",
        "A",
        1e3,
        "Charging current of a dock that hears the robot, mA.",
    ),
    Figure("buttons", "count", "BUTTONS", "1", 1.0, "Number of buttons."),
];

/// The source file for the firmware.
pub(super) fn source(robot: &Path, origin: &str) -> anyhow::Result<String> {
    let path = robot.join("robot.toml");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let table: Table = text.parse().with_context(|| path.display().to_string())?;
    let mut out =
        format!("//! Figures of the machine. Made by cargo xtask codegen from {origin}. Do not edit.\n\n");
    for (key, name) in [("name", "DEVICE"), ("title", "TITLE")] {
        let word = table.get(key).and_then(Value::as_str);
        let word = word.with_context(|| format!("{origin}: {key} is missing"))?;
        writeln!(
            out,
            "/// The machine's {key}.\npub const {name}: &str = {word:?};"
        )?;
    }
    for figure in &FIGURES {
        let value = figure.stored(&table).with_context(|| origin.to_owned())?;
        let Figure(_, _, name, _, _, what) = figure;
        writeln!(
            out,
            "/// {what}\npub const {name}: i32 = {};",
            rust_name::number(value)
        )?;
    }
    Ok(out)
}

impl Figure {
    fn stored(&self, table: &Table) -> anyhow::Result<i32> {
        let Self(group, key, _, unit, scale, _) = self;
        let figure = table.get(*group).and_then(|group| group.get(key));
        let figure = figure.with_context(|| format!("{group}.{key} is missing"))?;
        if figure.get("unit").and_then(Value::as_str) != Some(unit) {
            bail!("{group}.{key} must have the unit {unit:?}");
        }
        let value = figure
            .get("value")
            .with_context(|| format!("{group}.{key} has no value"))?;
        let value = value
            .as_float()
            .or_else(|| value.as_integer().map(|whole| whole as f64));
        let stored = value.with_context(|| format!("{group}.{key} is no number"))? * scale;
        let whole = stored.round();
        if !(0.0..=f64::from(i32::MAX)).contains(&whole) || (whole - stored).abs() > 1e-3 {
            bail!("{group}.{key}: {stored} cannot be stored as a whole number");
        }
        Ok(whole as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::Figure;

    #[test]
    fn figures_become_whole_numbers_in_small_units() {
        let table = "[a]\nb = { value = 0.35, unit = \"m/s\" }\nc = { value = 3, unit = \"1\" }"
            .parse()
            .expect("valid");
        let of = |key, unit, scale| {
            Figure("a", key, "X", unit, scale, "X.")
                .stored(&table)
                .map_err(|e| e.to_string())
        };
        assert_eq!(of("b", "m/s", 1e6), Ok(350_000));
        assert_eq!(of("c", "1", 1.0), Ok(3));
        assert!(of("b", "mm/s", 1.0).is_err_and(|said| said.contains("must have the unit")));
        assert!(of("b", "m/s", 1.0).is_err_and(|said| said.contains("whole number")));
        assert!(of("d", "1", 1.0).is_err_and(|said| said.contains("missing")));
    }
}
