//! What variants of a robot change, as a firmware source: a feature of the firmware's crate chooses one.

use crate::codegen::machines::{BoardLikeness, MachineFacts};
use crate::codegen::rust_name;
use anyhow::bail;
use std::fmt::Write;
use std::path::Path;

const TYPES: &str = "
use super::pins::Signal;

/// Lines of a display.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    /// Commons of the digits, from the left.
    pub digits: [Signal; 4],
    /// Segments a to g.
    pub segments: [Signal; 7],
    /// The colon.
    pub colon: Signal,
}
";

/// The variants that take this robot's firmware: those with the same board.
pub(super) fn buildable(variants: &[MachineFacts]) -> Vec<&MachineFacts> {
    let same = |machine: &&MachineFacts| machine.likeness() == Some(BoardLikeness::Same);
    variants.iter().filter(same).collect()
}

/// The source file for the firmware of the robot of this name.
pub(super) fn source(
    robot: &str,
    variants: &[&MachineFacts],
    origin: &str,
) -> Result<String, std::fmt::Error> {
    let mut text = format!(
        "//! What a variant changes: a feature of its name chooses it. Made by cargo xtask codegen from {origin}. Do not edit.\n{TYPES}"
    );
    let features: Vec<String> = variants
        .iter()
        .map(|variant| format!("feature = {:?}", variant.name))
        .collect();
    for (place, one) in features.iter().enumerate() {
        for other in features.iter().skip(place + 1) {
            writeln!(
                text,
                "\n#[cfg(all({one}, {other}))]\ncompile_error!(\"a robot is one variant at most\");"
            )?;
        }
    }
    let none = format!("not(any({}))", features.join(", "));
    push_constants(&mut text, &none, (robot, None))?;
    for (variant, feature) in variants.iter().zip(&features) {
        push_constants(&mut text, feature, (robot, Some(variant)))?;
    }
    Ok(text)
}

fn push_constants(
    text: &mut String,
    chosen: &str,
    (robot, variant): (&str, Option<&MachineFacts>),
) -> std::fmt::Result {
    let suffix = variant.map_or(String::new(), |variant| format!(", \"+{}\"", variant.name));
    let display = variant.and_then(MachineFacts::display);
    let signals = |names: &[String]| {
        let constants = names
            .iter()
            .map(|name| format!("super::pins::{}", rust_name::constant(name)));
        constants.collect::<Vec<_>>().join(", ")
    };
    let display = display.map_or("None".to_owned(), |lines| {
        format!(
            "Some(Display {{ digits: [{}], segments: [{}], colon: super::pins::{} }})",
            signals(&lines.digits),
            signals(&lines.segments),
            rust_name::constant(&lines.colon)
        )
    });
    writeln!(
        text,
        "\n/// Name and version of the firmware, as the host is told.\n#[cfg({chosen})]\n\
         pub const FIRMWARE: &str = concat!(\"{robot}-\", env!(\"CARGO_PKG_VERSION\"){suffix});\n\n\
         /// The display, if one is fitted.\n#[cfg({chosen})]\npub const DISPLAY: Option<Display> = {display};"
    )
}

/// Firmware in C drives no display.
pub(super) fn check_without_display(variants: &[&MachineFacts]) -> anyhow::Result<()> {
    match variants.iter().find(|variant| variant.display().is_some()) {
        Some(variant) => bail!("{}: the firmware in C drives no display", variant.file.display()),
        None => Ok(()),
    }
}

/// Each variant with this board can be chosen: the manifest of the firmware has a feature of its name.
pub(super) fn check_features(manifest: &Path, variants: &[&MachineFacts]) -> anyhow::Result<()> {
    let table: toml::Table = std::fs::read_to_string(manifest)?.parse()?;
    let features = table.get("features").and_then(toml::Value::as_table);
    let has = |name: &str| features.is_some_and(|features| features.contains_key(name));
    match variants.iter().find(|variant| !has(&variant.name)) {
        Some(variant) => bail!("{} needs the feature {}", manifest.display(), variant.name),
        None => Ok(()),
    }
}
