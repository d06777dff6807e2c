//! Replaying a recording is the work of `vthal replay`: the brain lives there.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context as _, bail};

use crate::arguments::ReplayOptions;

pub(crate) fn run(options: &ReplayOptions) -> anyhow::Result<ExitCode> {
    if !options.file.is_file() {
        bail!("there is no recording {}", options.file.display());
    }
    let vthal = options.vthal.clone().unwrap_or_else(sibling);
    let status = Command::new(&vthal)
        .arg("replay")
        .arg(&options.file)
        .status()
        .with_context(|| {
            format!(
                "cannot run {}: name the executable with --vthal PATH",
                vthal.display()
            )
        })?;
    match status.code() {
        Some(code) => Ok(ExitCode::from(u8::try_from(code).unwrap_or(1))),
        None => bail!("{} was ended by a signal", vthal.display()),
    }
}

/// The `vthal` beside this executable, else the one that the PATH leads to.
fn sibling() -> PathBuf {
    let beside = std::env::current_exe()
        .ok()
        .map(|own| own.with_file_name("vthal"));
    beside
        .filter(|path| path.is_file())
        .unwrap_or_else(|| PathBuf::from("vthal"))
}
