//! Which robots are described and have firmware of ours: found in their folders, listed nowhere.

use anyhow::Context;
use serde::Deserialize;
use std::path::Path;

/// A robot with firmware of ours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Board {
    /// Its name in the handshake.
    pub(crate) name: String,
    /// Its microcontroller, by its file in robots/chips.
    pub(crate) chip: String,
    /// The folder of its facts, from the root of the repository.
    pub(crate) facts: String,
    /// The folder of its firmware.
    pub(crate) firmware: String,
    /// What that is written in.
    pub(crate) written_in: WrittenIn,
}

/// What a firmware is written in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum WrittenIn {
    /// Rust, a workspace of its own with this program.
    Rust { program: String },
    /// C.
    C,
}

/// What `pinout.toml` says at its top.
#[derive(Deserialize)]
struct Head {
    chip: String,
    firmware: Option<String>,
}

/// What `robot.toml` says at its top.
#[derive(Deserialize)]
struct Robot {
    name: String,
}

/// A firmware's manifest.
#[derive(Deserialize)]
struct Manifest {
    bin: Vec<Program>,
}

#[derive(Deserialize)]
struct Program {
    name: String,
}

impl Board {
    /// All of them below the root of the repository, by the names of their folders.
    pub(crate) fn all(root: &Path) -> anyhow::Result<Vec<Self>> {
        let read = described(root)?.into_iter().map(|facts| Self::read(root, &facts));
        read.filter_map(anyhow::Result::transpose).collect()
    }

    /// That of a folder of facts; `None` when its robot has no firmware of ours.
    pub(super) fn read(root: &Path, facts: &str) -> anyhow::Result<Option<Self>> {
        let folder = root.join(facts);
        let Head { chip, firmware } = parsed(&folder.join("pinout.toml"))?;
        let Some(firmware) = firmware else {
            return Ok(None);
        };
        let Robot { name } = parsed(&folder.join("robot.toml"))?;
        let written_in = written_in(&root.join(&firmware))?;
        let facts = facts.to_owned();
        Ok(Some(Self {
            name,
            chip,
            facts,
            firmware,
            written_in,
        }))
    }
}

/// Folders of all robots with a pinout, from the root of the repository, sorted.
pub(in crate::codegen) fn described(root: &Path) -> anyhow::Result<Vec<String>> {
    let robots = root.join("robots");
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(&robots).with_context(|| format!("cannot read {}", robots.display()))? {
        let entry = entry?;
        if entry.path().join("pinout.toml").is_file() {
            folders.push(format!("robots/{}", entry.file_name().to_string_lossy()));
        }
    }
    folders.sort();
    Ok(folders)
}

/// A firmware with a manifest is in Rust.
fn written_in(firmware: &Path) -> anyhow::Result<WrittenIn> {
    let manifest = firmware.join("Cargo.toml");
    if !manifest.is_file() {
        return Ok(WrittenIn::C);
    }
    let programs = parsed::<Manifest>(&manifest)?.bin;
    let first = programs.into_iter().next();
    let program = first.with_context(|| format!("{} names no program", manifest.display()))?;
    Ok(WrittenIn::Rust {
        program: program.name,
    })
}

fn parsed<T: serde::de::DeserializeOwned>(path: &Path) -> anyhow::Result<T> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    toml::from_str(&text).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::{Board, WrittenIn};
    use crate::workspace;

    #[test]
    fn robots_with_firmware_are_found_in_their_folders() {
        let boards = Board::all(&workspace::root()).expect("they are described");
        let found: Vec<(&str, &str, bool)> = boards
            .iter()
            .map(|board| {
                let in_c = board.written_in == WrittenIn::C;
                (board.name.as_str(), board.chip.as_str(), in_c)
            })
            .collect();
        assert_eq!(
            found,
            [
                ("sr8730", "pic32mx360f256l", false),
                ("relax", "stc90c58rd", true)
            ]
        );
    }
}
