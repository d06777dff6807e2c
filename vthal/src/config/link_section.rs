//! The link in the configuration: one line, or the table of a serial device.

use std::fmt;
use std::path::PathBuf;

use robot_link::{AddressError, LinkAddress, UartAddress};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use super::{ConfigError, ConfigText};

/// `link = "…"`, or the table of a serial device.
#[derive(Debug)]
pub(super) enum LinkSection {
    Line(String),
    Serial(SerialTable),
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct SerialTable {
    serial: Option<PathBuf>,
    baud: Option<Spanned<u32>>,
}

impl<'de> Deserialize<'de> for LinkSection {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(LinkSectionVisitor)
    }
}

struct LinkSectionVisitor;

impl<'de> Visitor<'de> for LinkSectionVisitor {
    type Value = LinkSection;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a link such as \"uart:/dev/serial0\", or the table of a serial device")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<LinkSection, E> {
        Ok(LinkSection::Line(text.to_owned()))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<LinkSection, M::Error> {
        SerialTable::deserialize(MapAccessDeserializer::new(map)).map(LinkSection::Serial)
    }
}

/// The link of the flags, else that of the file.
pub(super) fn link(
    section: Option<Spanned<LinkSection>>,
    (line, serial, baud): (Option<LinkAddress>, Option<PathBuf>, Option<u32>),
    source: &ConfigText<'_>,
) -> Result<LinkAddress, ConfigError> {
    let (file_line, table) = match section.map(|section| (section.span().start, section.into_inner())) {
        None => (None, SerialTable::default()),
        Some((_, LinkSection::Serial(table))) => (None, table),
        Some((offset, LinkSection::Line(text))) => {
            let address = text
                .parse()
                .map_err(|error: AddressError| source.invalid(offset, error.to_string()))?;
            (Some(address), SerialTable::default())
        }
    };
    let named = table.baud.is_some();
    let file_baud = named.then_some(source.in_range(table.baud, 0, 1_200..=4_000_000)?);
    let address = match (line, serial, file_line, table.serial) {
        (Some(line), ..) => line,
        (None, Some(path), ..) | (None, None, None, Some(path)) => LinkAddress::serial(path, file_baud),
        (None, None, Some(line), _) => line,
        (None, None, None, None) => {
            return Err(ConfigError::Missing {
                what: "link to the robot",
                flag: "--link LINK or --serial PATH",
                key: "link",
            });
        }
    };
    match (baud, address) {
        (None, address) => Ok(address),
        (baud, LinkAddress::Uart(uart)) => Ok(LinkAddress::Uart(UartAddress { baud, ..uart })),
        (Some(_), _) => Err(ConfigError::NoRate),
    }
}
