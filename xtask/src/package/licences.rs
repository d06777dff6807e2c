//! The licences of everything that is linked into the programs and into the page, with their texts, as most of them demand.

use crate::workspace;
use anyhow::Context;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What is linked: a workspace and the packages in it that make the programs.
const SOURCES: [(&str, &str, &[&str]); 2] = [
    (
        "Cargo.toml",
        "arm-unknown-linux-musleabihf",
        &["vthal", "panel-server", "rvac-cli"],
    ),
    ("clients/panel/Cargo.toml", "wasm32-unknown-unknown", &["panel"]),
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
    for (manifest, triple, programs) in SOURCES {
        linked.extend(of_workspace(manifest, triple, programs)?);
    }
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("THIRD-PARTY.txt"), text(&linked)?)?;
    Ok(folder.to_path_buf())
}

fn of_workspace(manifest: &str, triple: &str, programs: &[&str]) -> anyhow::Result<BTreeSet<Linked>> {
    let mut cargo = workspace::cargo();
    cargo.args(["metadata", "--format-version", "1", "--locked"]);
    cargo.args(["--manifest-path", manifest, "--filter-platform", triple]);
    let metadata: Value = serde_json::from_str(&crate::process::capture(&mut cargo)?)
        .with_context(|| format!("cargo's metadata of {manifest}"))?;
    let packages: BTreeMap<&str, &Value> = list(&metadata["packages"])
        .filter_map(|package| Some((package["id"].as_str()?, package)))
        .collect();
    let needs: BTreeMap<&str, Vec<&str>> = list(&metadata["resolve"]["nodes"])
        .filter_map(|node| Some((node["id"].as_str()?, linked_by(node))))
        .collect();
    let mut seen = BTreeSet::new();
    let mut open: Vec<&str> = packages
        .iter()
        .filter(|(_, package)| {
            package["name"]
                .as_str()
                .is_some_and(|name| programs.contains(&name))
        })
        .map(|(id, _)| *id)
        .collect();
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            open.extend(needs.get(id).into_iter().flatten());
        }
    }
    Ok(seen
        .iter()
        .filter_map(|id| packages.get(id))
        .filter(|package| !package["source"].is_null())
        .map(|package| Linked {
            name: string(&package["name"]),
            version: string(&package["version"]),
            licence: string(&package["license"]),
            folder: Path::new(&string(&package["manifest_path"]))
                .parent()
                .map(Path::to_path_buf)
                .unwrap_or_default(),
        })
        .collect())
}

fn linked_by(node: &Value) -> Vec<&str> {
    list(&node["deps"])
        .filter(|dependency| list(&dependency["dep_kinds"]).any(|kind| kind["kind"].is_null()))
        .filter_map(|dependency| dependency["pkg"].as_str())
        .collect()
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

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn string(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}
