//! Boards: pins and calibration values as data, made into firmware sources and tables for people.

pub(crate) mod calibration;
mod chip;
mod header;
mod machine;
mod pinout;
mod pins;
mod table;

use super::{Generated, formatted};
use anyhow::Context;
use calibration::Calibration;
use pinout::Pinout;
use std::path::{Path, PathBuf};

/// A robot with firmware of ours.
#[derive(Debug)]
pub(crate) struct Board {
    /// Its name in the handshake.
    pub(crate) name: &'static str,
    /// The folder of its facts.
    pub(crate) facts: &'static str,
    /// The folder of its firmware, a workspace of its own.
    pub(crate) firmware: &'static str,
    /// The program of that workspace which is the firmware.
    pub(crate) program: &'static str,
}

/// All of them.
pub(crate) const BOARDS: [Board; 1] = [Board {
    name: "sr8730",
    facts: "robots/samsung-sr8730",
    firmware: "firmware/sr8730",
    program: "sr8730-firmware",
}];

/// A robot whose firmware is written in C.
struct SmallBoard {
    /// The folder of its facts.
    facts: &'static str,
    /// The header with its pins.
    header: &'static str,
}

/// All of them.
const SMALL_BOARDS: [SmallBoard; 1] = [SmallBoard {
    facts: "robots/vileda-relax",
    header: "firmware/relax/chip/generated/pins.h",
}];

const MODULES: &str = "//! Facts about the board as constants. Made by cargo xtask codegen. Do not edit.\n\n\
                       pub mod calibration;\npub mod machine;\npub mod pins;\n";

/// All files of all boards.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let mut files = Vec::new();
    for board in &BOARDS {
        let folder = root.join(board.facts);
        let sources = root.join(board.firmware).join("src/generated");
        let pinout = Pinout::load(&root.join("robots"), &folder)?;
        let calibration = Calibration::load(&folder)?;
        let from = |file: &str| format!("{}/{file}", board.facts);
        let made = [
            ("mod.rs", MODULES.to_owned()),
            ("pins.rs", pins::source(&pinout, &from("pinout.toml"))?),
            ("calibration.rs", calibration.source(&from("robot.toml"))?),
            ("machine.rs", machine::source(&folder, &from("robot.toml"))?),
        ];
        for (name, text) in made {
            files.push(Generated {
                path: sources.join(name),
                text: formatted(&text).with_context(|| format!("{}/src/generated/{name}", board.firmware))?,
            });
        }
        files.push(readme(&folder, &pinout, &calibration)?);
    }
    for board in &SMALL_BOARDS {
        let folder = root.join(board.facts);
        let pinout = Pinout::load(&root.join("robots"), &folder)?;
        files.push(Generated {
            path: root.join(board.header),
            text: header::source(&pinout, &format!("{}/pinout.toml", board.facts))?,
        });
        files.push(readme(&folder, &pinout, &Calibration::load(&folder)?)?);
    }
    for folder in others(root)? {
        let pinout = Pinout::load(&root.join("robots"), &folder)?;
        files.push(readme(&folder, &pinout, &Calibration::load(&folder)?)?);
    }
    Ok(files)
}

/// Folders of all robots with a pinout for which nothing but their tables is made.
fn others(root: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let known = BOARDS
        .iter()
        .map(|board| board.facts)
        .chain(SMALL_BOARDS.iter().map(|board| board.facts));
    let known: Vec<PathBuf> = known.map(|facts| root.join(facts)).collect();
    let robots = root.join("robots");
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(&robots).with_context(|| format!("cannot read {}", robots.display()))? {
        let folder = entry?.path();
        if folder.join("pinout.toml").is_file() && !known.contains(&folder) {
            folders.push(folder);
        }
    }
    folders.sort();
    Ok(folders)
}

/// The robot's README with fresh tables.
fn readme(folder: &Path, pinout: &Pinout, calibration: &Calibration) -> anyhow::Result<Generated> {
    let path = folder.join("README.md");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let text = table::renewed(&text, pinout, calibration)?;
    Ok(Generated { path, text })
}
