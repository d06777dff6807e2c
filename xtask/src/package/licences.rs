//! The licences of everything that is linked into the programs and into the page, with their texts, as most of them demand.

use crate::metadata::{self, Package, Workspace};
use anyhow::Context;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What is linked: a workspace for its platform, and the packages in it that make the programs. The Relax's firmware has no crates.
const SOURCES: [(Workspace, &[&str]); 3] = [
    (
        Workspace {
            manifest: "Cargo.toml",
            platform: "arm-unknown-linux-musleabihf",
        },
        &[
            "vthal",
            "panel-server",
            "rvac-cli",
            "rvac-mqtt",
            "rvac-metrics",
            "rvac-hooks",
            "rvac-dialect",
        ],
    ),
    (
        Workspace {
            manifest: "clients/panel/Cargo.toml",
            platform: "wasm32-unknown-unknown",
        },
        &["panel"],
    ),
    (
        Workspace {
            manifest: "firmware/sr8730/Cargo.toml",
            platform: "mipsel-unknown-none",
        },
        &["sr8730"],
    ),
];

/// Beginnings of names of files that hold a licence.
const TEXTS: [&str; 5] = ["license", "licence", "copying", "unlicense", "notice"];

/// A crate of others that is linked.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Linked {
    name: String,
    version: String,
    licence: String,
    folder: PathBuf,
}

/// Writes `THIRD-PARTY.txt` into `folder`; gives the folder.
pub(super) fn gather(folder: &Path) -> anyhow::Result<PathBuf> {
    let mut linked = BTreeSet::new();
    for (workspace, programs) in SOURCES {
        let packages = metadata::packages(&workspace)?;
        for program in programs {
            let others = metadata::linked(&packages, program);
            let others = others.into_iter().filter(|package| !package.ours);
            linked.extend(others.map(Linked::of));
        }
    }
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("THIRD-PARTY.txt"), text(&linked)?)?;
    Ok(folder.to_path_buf())
}

impl Linked {
    fn of(package: &Package) -> Self {
        Self {
            name: package.name.clone(),
            version: package.version.clone(),
            licence: package.licence.clone(),
            folder: package.folder.clone(),
        }
    }
}

fn text(linked: &BTreeSet<Linked>) -> anyhow::Result<String> {
    let mut text = String::from(
        "LibreRVAC is free software: see copyright. These are the works of others that are linked into it.\n\n",
    );
    for one in linked {
        text.push_str(&format!("{} {}: {}\n", one.name, one.version, one.licence));
    }
    for one in linked {
        for (name, content) in texts(&one.folder)? {
            let rule = "-".repeat(80);
            text.push_str(&format!(
                "\n{rule}\n{} {}, {name}\n{rule}\n{content}\n",
                one.name, one.version
            ));
        }
    }
    Ok(text)
}

fn texts(folder: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let mut texts = BTreeMap::new();
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let lower = name.to_lowercase();
        if path.is_file() && TEXTS.iter().any(|beginning| lower.starts_with(beginning)) {
            texts.insert(name, String::from_utf8_lossy(&std::fs::read(&path)?).into_owned());
        }
    }
    Ok(texts)
}
