//! Whether a package does what its owner expects: it is installed, set up, used, upgraded, removed and purged in a bare Debian.

mod chroot;
pub(super) mod programs;
mod steps;
mod units;

use super::archive::{self, Edition, Packing};
use super::machine::Machine;
use super::{Common, compile, folder, tree, version};
use crate::{process, system};
use anyhow::{Context, bail};
use chroot::Chroot;
use serde::Serialize;
use std::path::PathBuf;

/// What was seen on one machine.
#[derive(Debug, Serialize)]
pub(crate) struct Trial {
    machine: &'static str,
    /// Static programs of the release profile for this machine; else this host's own, which show that scripts and services are right.
    released: bool,
    installed: bool,
    set_up: bool,
    answered: bool,
    panel_over_tls: bool,
    upgraded: bool,
    removal_kept_state: bool,
    purged: bool,
    /// Milliseconds from the start of the daemon to a robot that answers.
    answers_after_ms: u64,
    /// Memory of both daemons that is their own or shared, KiB. Under an emulator of the processor that is its memory, too.
    vthal_rss_kib: u64,
    panel_server_rss_kib: u64,
}

impl Trial {
    fn is_passed(&self) -> bool {
        self.installed
            && self.set_up
            && self.answered
            && self.panel_over_tls
            && self.upgraded
            && self.removal_kept_state
            && self.purged
    }
}

/// What was seen in all.
#[derive(Debug, Serialize)]
pub(crate) struct Trials {
    machines: Vec<Trial>,
    units: Vec<units::Exposure>,
}

/// Which packages are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    /// This host's development programs, in a package like the others: a minute.
    Scripts,
    /// The packages as they are given out, for PCs and, by an emulator of its processor, for the Pi Zero: half an hour the first time.
    Released,
}

/// Tries the packages; fails when one of them does not do what it should.
pub(crate) fn run(scope: Scope) -> anyhow::Result<Trials> {
    system::need("debootstrap", &["debootstrap"])?;
    let common = Common::make()?;
    let machines: &[Machine] = match scope {
        Scope::Scripts => &[Machine::Amd64],
        Scope::Released => &[Machine::Amd64, Machine::Armv6],
    };
    let mut trials = Vec::new();
    let mut exposures = Vec::new();
    for machine in machines {
        let packages = packages(&common, *machine, scope)?;
        if exposures.is_empty() {
            exposures = units::check(&folder().join(packages.machine.name()))?;
        }
        let chroot = Chroot::bare(*machine)?;
        trials.push(steps::run(&chroot, &packages, scope)?);
    }
    let trials = Trials {
        machines: trials,
        units: exposures,
    };
    if let Some(failed) = trials.machines.iter().find(|trial| !trial.is_passed()) {
        bail!("{}", serde_json::to_string(failed)?);
    }
    Ok(trials)
}

/// Prints what was seen.
pub(crate) fn print(trials: &Trials) -> anyhow::Result<()> {
    process::print(&serde_json::to_string_pretty(trials)?);
    Ok(())
}

/// A package and its successor.
#[derive(Debug)]
struct Editions {
    machine: Machine,
    first: PathBuf,
    next: PathBuf,
}

fn packages(common: &Common, machine: Machine, scope: Scope) -> anyhow::Result<Editions> {
    let (programs, packing) = match scope {
        Scope::Scripts => (programs::of_this_host()?, Packing::Quick),
        Scope::Released => (compile::programs(machine)?, Packing::Small),
    };
    let root = tree::lay(common, machine, &programs)?;
    let edition = |version: String| Edition {
        version,
        epoch_s: common.epoch_s,
        packing,
    };
    let first = archive::debian_of_version(&root, machine, &edition(version().to_owned()))?;
    let kept = folder().join(format!("{}-first.deb", machine.name()));
    std::fs::copy(&first, &kept).with_context(|| format!("cannot copy {}", first.display()))?;
    let next = archive::debian_of_version(&root, machine, &edition(format!("{}+next", version())))?;
    Ok(Editions {
        machine,
        first: kept,
        next,
    })
}
