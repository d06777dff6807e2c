//! The manual pages, and what shells need to complete the commands: both from the command line's own definition.

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::CommandFactory as _;
use clap_complete::Shell;

use crate::arguments::Arguments;

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> anyhow::Result<ExitCode> {
    clap_complete::generate(shell, &mut Arguments::command(), "rvac", &mut std::io::stdout());
    Ok(ExitCode::SUCCESS)
}

/// Writes a page for rvac and one for each of its commands.
pub(crate) fn write(folder: &Path) -> anyhow::Result<ExitCode> {
    clap_mangen::generate_to(Arguments::command(), folder)
        .with_context(|| format!("cannot write the manual pages in {}", folder.display()))?;
    Ok(ExitCode::SUCCESS)
}
