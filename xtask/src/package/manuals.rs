//! Manual pages and completions, as the programs themselves print them.

use crate::workspace::{self, Profile};
use crate::{process, system};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Shells, and where their completions go on Debian.
const SHELLS: [(&str, &str); 3] = [
    ("bash", "usr/share/bash-completion/completions/rvac"),
    ("zsh", "usr/share/zsh/vendor-completions/_rvac"),
    ("fish", "usr/share/fish/vendor_completions.d/rvac.fish"),
];

/// Programs that print one page of their own.
const SERVICES: [&str; 6] = [
    "vthal",
    "panel-server",
    "rvac-mqtt",
    "rvac-metrics",
    "rvac-hooks",
    "rvac-dialect",
];

/// Writes them below `folder` where they belong in a system; gives the folder.
pub(super) fn make(folder: &Path) -> anyhow::Result<PathBuf> {
    system::need("gzip", &["gzip"])?;
    workspace::build(&[&["rvac"], &SERVICES[..]].concat(), Profile::Dev)?;
    if folder.exists() {
        std::fs::remove_dir_all(folder)?;
    }
    let pages = folder.join("usr/share/man/man1");
    std::fs::create_dir_all(&pages).with_context(|| format!("cannot make {}", pages.display()))?;
    let rvac = workspace::program("rvac", Profile::Dev);
    process::capture(Command::new(&rvac).arg("manual").arg(&pages))?;
    for program in SERVICES {
        let page = process::capture(Command::new(workspace::program(program, Profile::Dev)).arg("manual"))?;
        std::fs::write(pages.join(format!("{program}.1")), page)?;
    }
    let mut gzip = Command::new("gzip");
    gzip.args(["--no-name", "--best", "--recursive"]).arg(&pages);
    process::run("pack the manual pages", &mut gzip)?;
    for (shell, place) in SHELLS {
        let file = folder.join(place);
        std::fs::create_dir_all(file.parent().unwrap_or(folder))?;
        std::fs::write(
            file,
            process::capture(Command::new(&rvac).args(["completions", shell]))?,
        )?;
    }
    Ok(folder.to_path_buf())
}
