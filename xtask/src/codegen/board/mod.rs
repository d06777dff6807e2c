//! Boards: pins and calibration values as data, made into firmware sources and tables for people.

pub(crate) mod calibration;
mod discovery;
mod header;
mod machine;
mod pinout;
mod pins;
mod table;
mod variant;

use super::{Generated, formatted, machines};
use anyhow::Context;
use calibration::Calibration;
pub(super) use discovery::described;
pub(crate) use discovery::{Board, WrittenIn};
pub(super) use pinout::{Confidence, Pinout};
use std::path::Path;

const MODULES: &str = "//! Facts about the board as constants. Made by cargo xtask codegen. Do not edit.\n\n\
                       pub mod calibration;\npub mod machine;\npub mod pins;\npub mod variant;\n";

/// All files of all boards.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let mut files = Vec::new();
    for facts in discovery::described(root)? {
        let folder = root.join(&facts);
        let pinout = Pinout::load(&root.join("robots"), &folder)?;
        let calibration = Calibration::load(&folder)?;
        if let Some(board) = Board::read(root, &facts)? {
            files.extend(sources(root, &board, (&pinout, &calibration))?);
        }
        files.push(readme(&folder, &pinout, &calibration)?);
    }
    Ok(files)
}

/// What a board's firmware is told of the board, in its language.
fn sources(
    root: &Path,
    board: &Board,
    (pinout, calibration): (&Pinout, &Calibration),
) -> anyhow::Result<Vec<Generated>> {
    let from = |file: &str| format!("{}/{file}", board.facts);
    let firmware = root.join(&board.firmware);
    let variants = machines::variants(root, &board.facts)?;
    let buildable = variant::buildable(&variants);
    if board.written_in == WrittenIn::C {
        variant::check_without_display(&buildable)?;
        return Ok(vec![Generated {
            path: firmware.join("chip/generated/pins.h"),
            text: header::source(pinout, &from("pinout.toml"))?,
        }]);
    }
    variant::check_features(&firmware.join("Cargo.toml"), &buildable)?;
    let made = [
        ("mod.rs", MODULES.to_owned()),
        ("pins.rs", pins::source(pinout, &from("pinout.toml"))?),
        ("calibration.rs", calibration.source(&from("robot.toml"))?),
        (
            "machine.rs",
            machine::source(&root.join(&board.facts), &from("robot.toml"))?,
        ),
        (
            "variant.rs",
            variant::source(&board.name, &buildable, &from("variants"))?,
        ),
    ];
    made.into_iter()
        .map(|(name, text)| {
            let path = firmware.join("src/generated").join(name);
            let text = formatted(&text).with_context(|| path.display().to_string())?;
            Ok(Generated { path, text })
        })
        .collect()
}

/// The robot's README with fresh tables.
fn readme(folder: &Path, pinout: &Pinout, calibration: &Calibration) -> anyhow::Result<Generated> {
    let path = folder.join("README.md");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let text = table::renewed(&text, pinout, calibration)?;
    Ok(Generated { path, text })
}
