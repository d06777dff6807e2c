//! The calibration record: measured values as the SR8730's firmware finds them in the last page of its flash.
//!
//! Little endian: magic u32, version u16, number of values u16, the values as i32 in the order of robot.toml (the least
//! i32 means unknown), CRC-32C of all before.

use rvac_protocol::crc::crc32c;

use crate::catalog::Catalog;
use crate::error::ValuesError;
use crate::measurements::Measurements;

/// Physical address of the page.
pub const RECORD_ADDRESS: u32 = 0x1D03_F000;
/// First word: "RCAL", lowest byte first.
pub const MAGIC: u32 = 0x4C41_4352;
const VERSION: u16 = 1;
const UNKNOWN: i32 = i32::MIN;
/// A page, without the head and the check value.
const VALUES_MAX: usize = (4096 - 12) / 4;

/// The record of what was measured.
///
/// # Errors
/// A value that cannot be true, or more values than a page of flash holds.
pub fn record(catalog: &Catalog, measured: &Measurements) -> Result<Vec<u8>, ValuesError> {
    let count = catalog.items.len();
    let too_many = || ValuesError::TooMany(count);
    if count > VALUES_MAX {
        return Err(too_many());
    }
    let mut bytes = MAGIC.to_le_bytes().to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(u16::try_from(count).map_err(|_more| too_many())?.to_le_bytes());
    for item in &catalog.items {
        let value = match measured.get(&item.name) {
            None => UNKNOWN,
            Some(value) => {
                let [low, high] = item.range;
                let fits = i32::try_from(value)
                    .ok()
                    .filter(|_| (low..=high).contains(&value));
                fits.ok_or_else(|| ValuesError::OutOfRange {
                    name: item.name.clone(),
                    value,
                    unit: item.unit.clone(),
                    low,
                    high,
                })?
            }
        };
        bytes.extend(value.to_le_bytes());
    }
    let check = !crc32c(u32::MAX, &bytes);
    bytes.extend(check.to_le_bytes());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::record;
    use crate::catalog::{Catalog, RobotTables};
    use crate::measurements::Measurements;

    const VALUES: &str = "[[calibration]]\nname = \"a\"\nunit = \"mm\"\nrange = [-5, 5]\nneeded-for = \"x\"\nmeasure = \"So.\"\n\
                          [[calibration]]\nname = \"b\"\nformer-name = \"c\"\nunit = \"mm\"\nrange = [0, 9]\nneeded-for = \"x\"\nmeasure = \"So.\"\n";

    fn catalog() -> Catalog {
        Catalog::read(RobotTables {
            robot: "r",
            values: VALUES,
            pins: "signal = []",
        })
        .expect("valid")
    }

    fn record_of(text: &str) -> Result<Vec<u8>, String> {
        let catalog = catalog();
        Measurements::parse(Path::new("mine.toml"), text, &catalog)
            .and_then(|measured| record(&catalog, &measured))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_record_holds_what_was_measured_and_the_mark_for_the_rest() {
        let bytes = record_of("robot = \"r\"\n[values]\nb = 7\n").expect("valid");
        assert_eq!(bytes[..8], [0x52, 0x43, 0x41, 0x4C, 1, 0, 2, 0]);
        assert_eq!(bytes[8..16], [0, 0, 0, 0x80, 7, 0, 0, 0]);
        // CRC-32C of these sixteen bytes, reckoned elsewhere.
        assert_eq!(bytes[16..], 0x52EC_4B31_u32.to_le_bytes());
    }

    #[test]
    fn a_former_name_stands_for_the_value() {
        let of = |name: &str| record_of(&format!("robot = \"r\"\n[values]\n{name} = 7\n")).expect("known");
        assert_eq!(of("c"), of("b"));
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said() {
        let table = [
            ("robot = \"q\"\n[values]\n", "of a robot \"q\", not \"r\""),
            ("robot = \"r\"\n[values]\nd = 7\n", "no value \"d\"; known: a, b"),
            (
                "robot = \"r\"\n[values]\nb = 10\n",
                "b is 10 mm, but can only lie in 0 to 9",
            ),
            ("robot = \"r\"\n[values]\nb = 1.5\n", "whole numbers"),
            ("b = 7\n", "it holds `robot"),
        ];
        for (text, wanted) in table {
            let said = record_of(text).expect_err(text);
            assert!(said.contains(wanted), "{text}: {said}");
        }
    }
}
