//! The calibration record: measured values as the firmware finds them in the last page of its flash.
//!
//! Little endian: magic u32, version u16, number of values u16, the values as i32 in the order of robot.toml (the least
//! i32 means unknown), CRC-32C of all before.

use super::checksum::crc_32c;
use super::elf::Segment;
use crate::codegen::board::calibration::Calibration;
use anyhow::{Context, bail};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Physical address of the page.
const ADDRESS: u32 = 0x1D03_F000;
const MAGIC: u32 = 0x4C41_4352;
const VERSION: u16 = 1;
const UNKNOWN: i32 = i32::MIN;

/// What a person measured, as `rvac calibrate` writes it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Measured {
    robot: String,
    values: BTreeMap<String, i64>,
}

/// The record of a file with measured values.
pub(super) fn load(path: &Path, robot: &str, calibration: &Calibration) -> anyhow::Result<Segment> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("cannot read the calibration {}", path.display()))?;
    segment(&text, robot, calibration).with_context(|| format!("calibration {}", path.display()))
}

fn segment(text: &str, robot: &str, calibration: &Calibration) -> anyhow::Result<Segment> {
    let measured: Measured = toml::from_str(text).map_err(|error| {
        let what = "it holds `robot = \"NAME\"` and a table [values] of whole numbers";
        anyhow::anyhow!("{what}: {}", error.message())
    })?;
    if measured.robot != robot {
        bail!("it is of a robot {:?}, not {robot:?}", measured.robot);
    }
    let mut values = vec![UNKNOWN; calibration.items.len()];
    for (name, value) in measured.values {
        let Some((index, item)) = calibration.find(&name) else {
            let known: Vec<&str> = calibration.items.iter().map(|item| item.name.as_str()).collect();
            bail!("there is no value {name:?}; known are: {}", known.join(", "));
        };
        let (low, high) = item.range();
        let fits = i32::try_from(value)
            .ok()
            .filter(|value| (low..=high).contains(value));
        let Some(value) = fits else {
            bail!(
                "{name} is {value} {}, but can only lie in {low} to {high}",
                item.unit
            );
        };
        if let Some(place) = values.get_mut(index) {
            *place = value;
        }
    }
    Ok(Segment {
        physical: ADDRESS,
        offset: 0,
        bytes: bytes(&values)?,
    })
}

fn bytes(values: &[i32]) -> anyhow::Result<Vec<u8>> {
    let mut bytes = MAGIC.to_le_bytes().to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(u16::try_from(values.len())?.to_le_bytes());
    values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes.extend(crc_32c(&bytes).to_le_bytes());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::{bytes, segment};
    use crate::codegen::board::calibration::Calibration;

    const VALUES: &str = "[[calibration]]\nname = \"a\"\nunit = \"mm\"\nrange = [-5, 5]\nconfidence = \"unknown\"\n\
                          needed-for = \"x\"\nmeasure = \"So.\"\nsimulated = 1\n\
                          [[calibration]]\nname = \"b\"\nunit = \"mm\"\nrange = [0, 9]\nconfidence = \"unknown\"\n\
                          needed-for = \"x\"\nmeasure = \"So.\"\nsimulated = 1\n";

    fn calibration() -> Calibration {
        Calibration::parse(VALUES).expect("valid")
    }

    #[test]
    fn a_record_holds_what_was_measured_and_the_mark_for_the_rest() {
        let segment = segment("robot = \"r\"\n[values]\nb = 7\n", "r", &calibration()).expect("valid");
        assert_eq!(segment.physical, 0x1D03_F000);
        assert_eq!(&segment.bytes[..8], [0x52, 0x43, 0x41, 0x4C, 1, 0, 2, 0]);
        assert_eq!(&segment.bytes[8..16], [0, 0, 0, 0x80, 7, 0, 0, 0]);
        assert_eq!(segment.bytes.len(), 20);
        assert_eq!(bytes(&[i32::MIN, 7]).expect("short"), segment.bytes);
    }

    #[test]
    fn a_former_name_stands_for_the_value() {
        let values = VALUES.replacen("name = \"b\"", "name = \"b\"\nformer-name = \"c\"", 1);
        let calibration = Calibration::parse(&values).expect("valid");
        let of = |name: &str| {
            let text = format!("robot = \"r\"\n[values]\n{name} = 7\n");
            segment(&text, "r", &calibration).expect("known").bytes
        };
        assert_eq!(of("c"), of("b"));
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said() {
        let table = [
            ("robot = \"q\"\n[values]\n", "of a robot \"q\", not \"r\""),
            (
                "robot = \"r\"\n[values]\nc = 7\n",
                "no value \"c\"; known are: a, b",
            ),
            (
                "robot = \"r\"\n[values]\nb = 10\n",
                "b is 10 mm, but can only lie in 0 to 9",
            ),
            ("robot = \"r\"\n[values]\nb = 1.5\n", "whole numbers"),
            ("b = 7\n", "it holds `robot"),
        ];
        for (text, wanted) in table {
            let said = format!("{:#}", segment(text, "r", &calibration()).expect_err(text));
            assert!(said.contains(wanted), "{text}: {said}");
        }
    }
}
