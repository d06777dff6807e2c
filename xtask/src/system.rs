//! What this machine has, and Debian's packages for what it lacks.

use crate::process;
use anyhow::{Context, bail};
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

static INSTALLING: Mutex<()> = Mutex::new(());

/// Finds a program on the search path.
pub(crate) fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .map(|folder| folder.join(program))
        .find(|file| file.is_file())
}

/// Makes sure that `program` is there, by installing `packages` when it is not.
pub(crate) fn need(program: &str, packages: &[&str]) -> anyhow::Result<()> {
    if find(program).is_some() {
        return Ok(());
    }
    install(packages).with_context(|| format!("{program} is not installed"))?;
    if find(program).is_none() {
        bail!(
            "{program} is still missing after installing {}",
            packages.join(" ")
        );
    }
    Ok(())
}

/// Installs packages with apt-get, through sudo when we are not root.
///
/// What may stand in the way is cleared only when the first attempt fails: an installation that was cut off in its middle
/// (`dpkg` then refuses everything until it is told to finish it), and old package lists. A machine that is in order needs no
/// network for lists.
pub(crate) fn install(packages: &[&str]) -> anyhow::Result<()> {
    let wanted = packages.join(" ");
    let remedy = || format!("install them by hand: apt-get install {wanted}");
    if find("apt-get").is_none() {
        bail!(
            "this machine has no apt-get to install {wanted}; install the packages of the same purpose by hand"
        );
    }
    // Stages that run side by side take turns: apt-get waits for the lock of the packages, and not for that of their lists.
    let _turn = INSTALLING.lock().unwrap_or_else(PoisonError::into_inner);
    let install = || apt_install(packages);
    if install().is_ok() {
        return Ok(());
    }
    finish_interrupted_installation()?;
    refresh_package_lists().with_context(remedy)?;
    install().with_context(remedy)
}

fn apt_install(packages: &[&str]) -> anyhow::Result<()> {
    let mut command = apt_get()?;
    command
        .args(["install", "--no-install-recommends"])
        .args(packages);
    process::run(&format!("install {}", packages.join(" ")), &mut command)
}

fn refresh_package_lists() -> anyhow::Result<()> {
    let mut command = apt_get()?;
    command.arg("update");
    process::run("refresh the package lists", &mut command)
}

/// Lets dpkg finish what a power cut or a closed terminal interrupted; nothing happens when there is nothing to finish.
fn finish_interrupted_installation() -> anyhow::Result<()> {
    let mut command = as_root("dpkg")?;
    command.args(["--configure", "--pending"]);
    process::run("finish an interrupted installation", &mut command)
        .context("finish it by hand: dpkg --configure --pending")
}

fn apt_get() -> anyhow::Result<Command> {
    let mut command = as_root("apt-get")?;
    command.args(["--yes", "--option", LOCK_WAIT]);
    Ok(command)
}

/// Another installation, a machine's nightly update say, is waited for this many seconds.
const LOCK_WAIT: &str = "DPkg::Lock::Timeout=300";

fn as_root(program: &str) -> anyhow::Result<Command> {
    let mut command = if rustix::process::geteuid().is_root() {
        Command::new(program)
    } else if find("sudo").is_some() {
        let mut command = Command::new("sudo");
        command.arg(program);
        command
    } else {
        bail!("only root may install packages and there is no sudo");
    };
    command.env("DEBIAN_FRONTEND", "noninteractive");
    Ok(command)
}
