//! The calibration record as a part of a robot's image.

use super::elf::Segment;
use anyhow::Context;
use calibration_values::{Catalog, Measurements, RECORD_ADDRESS, RobotTables, record};
use std::path::Path;

/// The record of a file with measured values, for the robot of this folder.
pub(super) fn load(path: &Path, robot: &str, folder: &Path) -> anyhow::Result<Segment> {
    let read = |path: &Path| {
        std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
    };
    let catalog = Catalog::read(RobotTables {
        robot,
        values: &read(&folder.join("robot.toml"))?,
        pins: &read(&folder.join("pinout.toml"))?,
    })
    .with_context(|| folder.display().to_string())?;
    let measured = Measurements::parse(path, &read(path)?, &catalog)?;
    Ok(Segment {
        physical: RECORD_ADDRESS,
        offset: 0,
        bytes: record(&catalog, &measured)?,
    })
}
