//! What this machine has, and Debian's packages for what it lacks.

use crate::process;
use anyhow::{Context, bail};
use std::path::PathBuf;
use std::process::Command;

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
/// The lists are refreshed only when the first attempt fails: a machine with fresh lists needs no network for that.
pub(crate) fn install(packages: &[&str]) -> anyhow::Result<()> {
    let wanted = packages.join(" ");
    let remedy = || format!("install them by hand: apt-get install {wanted}");
    if find("apt-get").is_none() {
        bail!(
            "this machine has no apt-get to install {wanted}; install the packages of the same purpose by hand"
        );
    }
    if apt(
        &format!("install {wanted}"),
        &["install", packages_flag()],
        packages,
    )
    .is_ok()
    {
        return Ok(());
    }
    apt("refresh the package lists", &["update"], &[]).with_context(remedy)?;
    apt(
        &format!("install {wanted}"),
        &["install", packages_flag()],
        packages,
    )
    .with_context(remedy)
}

fn packages_flag() -> &'static str {
    "--no-install-recommends"
}

fn apt(what: &str, words: &[&str], packages: &[&str]) -> anyhow::Result<()> {
    let mut command = if rustix::process::geteuid().is_root() {
        Command::new("apt-get")
    } else if find("sudo").is_some() {
        let mut command = Command::new("sudo");
        command.arg("apt-get");
        command
    } else {
        bail!("only root may install packages and there is no sudo");
    };
    command
        .arg("--yes")
        .args(words)
        .args(packages)
        .env("DEBIAN_FRONTEND", "noninteractive");
    process::run(what, &mut command)
}
