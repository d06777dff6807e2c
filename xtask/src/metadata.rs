//! What cargo knows about packages and their dependencies.

use crate::process;
use anyhow::Context;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A package.
#[derive(Debug, Default)]
pub(crate) struct Package {
    /// Its name.
    pub(crate) name: String,
    /// Its version.
    pub(crate) version: String,
    /// The folder of its source.
    pub(crate) folder: PathBuf,
    /// Its licence expression; empty when it has none.
    pub(crate) licence: String,
    /// Whether its source lies in this repository.
    pub(crate) ours: bool,
    /// Identities of the packages it is linked with; not those that its build script or its tests need.
    pub(crate) needs: Vec<String>,
}

/// A workspace of this repository and what it is compiled for.
#[derive(Debug)]
pub(crate) struct Workspace {
    /// Its manifest.
    pub(crate) manifest: &'static str,
    /// Dependencies for other platforms are left out.
    pub(crate) platform: &'static str,
}

/// All of them. The first seven hold what users and robots run.
pub(crate) const WORKSPACES: [Workspace; 9] = [
    Workspace {
        manifest: "Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
    Workspace {
        manifest: "clients/panel/Cargo.toml",
        platform: "wasm32-unknown-unknown",
    },
    Workspace {
        manifest: "clients/foxglove/Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
    Workspace {
        manifest: "clients/matter/Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
    Workspace {
        manifest: "clients/ros2/Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
    Workspace {
        manifest: "firmware/sr8730/Cargo.toml",
        platform: "mipsel-unknown-none",
    },
    Workspace {
        manifest: "firmware/pic32mx3-hal/Cargo.toml",
        platform: "mipsel-unknown-none",
    },
    Workspace {
        manifest: "xtask/uipack/Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
    Workspace {
        manifest: "protocol/fuzz/Cargo.toml",
        platform: "x86_64-unknown-linux-gnu",
    },
];

/// All packages of a workspace by their identity.
pub(crate) type Packages = BTreeMap<String, Package>;

/// Asks cargo about a workspace.
pub(crate) fn packages(workspace: &Workspace) -> anyhow::Result<Packages> {
    let mut cargo = crate::workspace::cargo();
    cargo.args([
        "metadata",
        "--format-version",
        "1",
        "--locked",
        "--manifest-path",
        workspace.manifest,
    ]);
    cargo.args(["--filter-platform", workspace.platform]);
    let metadata: Value = serde_json::from_str(&process::capture(&mut cargo)?)
        .with_context(|| format!("cargo's metadata of {}", workspace.manifest))?;
    let mut packages = Packages::new();
    for package in list(&metadata["packages"]) {
        let entry = packages.entry(text(&package["id"])).or_default();
        entry.name = text(&package["name"]);
        entry.version = text(&package["version"]);
        entry.folder = Path::new(&text(&package["manifest_path"]))
            .parent()
            .map(Path::to_path_buf)
            .unwrap_or_default();
        entry.licence = text(&package["license"]);
        entry.ours = package["source"].is_null();
    }
    for node in list(&metadata["resolve"]["nodes"]) {
        let needs = list(&node["deps"])
            .filter(|dependency| list(&dependency["dep_kinds"]).any(|kind| kind["kind"].is_null()));
        packages.entry(text(&node["id"])).or_default().needs =
            needs.map(|dependency| text(&dependency["pkg"])).collect();
    }
    Ok(packages)
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// Every package that `from` is linked with.
pub(crate) fn linked<'a>(packages: &'a Packages, from: &str) -> Vec<&'a Package> {
    let start = packages
        .iter()
        .filter(|(_, package)| package.ours && package.name == from);
    let mut open: Vec<&str> = start.map(|(id, _)| id.as_str()).collect();
    let mut seen = BTreeSet::new();
    while let Some(id) = open.pop() {
        if seen.insert(id)
            && let Some(package) = packages.get(id)
        {
            open.extend(package.needs.iter().map(String::as_str));
        }
    }
    seen.iter().filter_map(|id| packages.get(*id)).collect()
}

/// Every package that `from` reaches, with the way to it as names, nearest first.
pub(crate) fn reach(packages: &Packages, from: &str) -> Vec<Vec<String>> {
    let start = packages
        .iter()
        .find(|(_, package)| package.ours && package.name == from)
        .map(|(id, _)| id.clone());
    let mut ways: Vec<(String, Vec<String>)> =
        start.map(|id| (id, vec![from.to_owned()])).into_iter().collect();
    let mut next = 0;
    while let Some((id, way)) = ways.get(next).cloned() {
        next += 1;
        for needed in packages
            .get(&id)
            .map(|package| package.needs.as_slice())
            .unwrap_or_default()
        {
            if ways.iter().any(|(seen, _)| seen == needed) {
                continue;
            }
            let mut further = way.clone();
            further.push(
                packages
                    .get(needed)
                    .map(|package| package.name.clone())
                    .unwrap_or_default(),
            );
            ways.push((needed.clone(), further));
        }
    }
    ways.into_iter().skip(1).map(|(_, way)| way).collect()
}
