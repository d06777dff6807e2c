//! `cargo xtask package`: the programs for the Linux board, packed for Debian and as plain archives, for each processor that boards have.

mod archive;
mod compile;
mod images;
mod licences;
pub(crate) mod machine;
mod manuals;
mod tree;
pub(crate) mod trial;

use crate::panel::{self, Page};
use crate::{process, workspace};
use anyhow::Context;
use machine::Machine;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Name of the package.
pub(crate) const NAME: &str = "librervac";

/// Arguments of `cargo xtask package`.
#[derive(Debug, clap::Args)]
pub(crate) struct PackageArguments {
    /// Processors to pack for, separated by commas: arm (ARMv6 with floating point, the Pi Zero), armv7, arm64, amd64; all when none is named.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    machines: Vec<Machine>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// A file that was made.
#[derive(Debug, Serialize)]
pub(crate) struct Packed {
    machine: &'static str,
    triple: &'static str,
    /// From the root of the repository.
    pub(crate) file: PathBuf,
    bytes: u64,
    sha256: String,
}

#[derive(Debug, Serialize)]
struct PackageReport {
    version: String,
    targets: Vec<Packed>,
}

/// Builds and packs, and prints what was made.
pub(crate) fn run(arguments: &PackageArguments) -> anyhow::Result<()> {
    let machines: Vec<Machine> = if arguments.machines.is_empty() {
        Machine::ALL.to_vec()
    } else {
        arguments.machines.clone()
    };
    let common = Common::make()?;
    let mut targets = Vec::new();
    for machine in machines {
        targets.extend(common.pack(machine)?);
    }
    let report = PackageReport {
        version: version().to_owned(),
        targets,
    };
    if arguments.json {
        process::print(&serde_json::to_string_pretty(&report)?);
        return Ok(());
    }
    for packed in &report.targets {
        process::print(&format!(
            "{:6} {:>9} bytes  sha256 {}  {}",
            packed.machine,
            packed.bytes,
            packed.sha256,
            packed.file.display()
        ));
    }
    Ok(())
}

/// The version of all our crates.
pub(crate) fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Where packages are made.
pub(crate) fn folder() -> PathBuf {
    workspace::target().join("package")
}

/// The programs of the board: this host's own, for trials, or those that are given out.
pub(crate) fn programs(machine: Machine, origin: Origin) -> anyhow::Result<Vec<PathBuf>> {
    match origin {
        Origin::Released => compile::programs(machine),
        Origin::Host => trial::programs::of_this_host(),
    }
}

/// Where programs come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// Static programs of the release profile.
    Released,
    /// This host's development programs, quickly.
    Host,
}

/// What all machines get alike: made once.
#[derive(Debug)]
pub(crate) struct Common {
    panel: PathBuf,
    manuals: PathBuf,
    licences: PathBuf,
    firmware: PathBuf,
    epoch_s: u64,
}

impl Common {
    /// Builds the panel, the manuals and the robots' firmware and gathers licences.
    pub(crate) fn make() -> anyhow::Result<Self> {
        let out = folder();
        std::fs::create_dir_all(&out).with_context(|| format!("cannot make {}", out.display()))?;
        Ok(Self {
            panel: panel::build(Page::Release)?,
            manuals: manuals::make(&out.join("manuals"))?,
            licences: licences::gather(&out.join("licences"))?,
            firmware: images::gather(&out.join("firmware"))?,
            epoch_s: epoch_s()?,
        })
    }

    /// The package and the archive for one machine.
    pub(crate) fn pack(&self, machine: Machine) -> anyhow::Result<[Packed; 2]> {
        let programs = compile::programs(machine)?;
        let root = tree::lay(self, machine, &programs)?;
        let package = archive::debian(&root, machine, self.epoch_s)?;
        let plain = archive::plain(&root, machine, self.epoch_s)?;
        Ok([packed(machine, &package)?, packed(machine, &plain)?])
    }
}

fn packed(machine: Machine, file: &Path) -> anyhow::Result<Packed> {
    let text = process::capture(std::process::Command::new("sha256sum").arg(file))?;
    let sha256 = text.split_whitespace().next().context("sha256sum says nothing")?;
    Ok(Packed {
        machine: machine.name(),
        triple: machine.triple(),
        file: file.strip_prefix(workspace::root()).unwrap_or(file).to_path_buf(),
        bytes: std::fs::metadata(file)?.len(),
        sha256: sha256.to_owned(),
    })
}

/// The moment that all files of a package carry: that of the commit, so that the same source makes the same bytes.
fn epoch_s() -> anyhow::Result<u64> {
    if let Ok(given) = std::env::var("SOURCE_DATE_EPOCH") {
        return given
            .parse()
            .context("SOURCE_DATE_EPOCH is not a number of seconds");
    }
    let mut git = std::process::Command::new("git");
    git.current_dir(workspace::root())
        .args(["log", "-1", "--format=%ct"]);
    let text =
        process::capture(&mut git).context("the time of the commit; without git set SOURCE_DATE_EPOCH")?;
    text.trim()
        .parse()
        .context("git says no time; set SOURCE_DATE_EPOCH")
}
