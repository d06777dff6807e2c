//! The host's own programs, for a package that is tried and not given out.

use crate::package::folder;
use crate::process;
use crate::workspace::{self, Profile};
use std::path::PathBuf;
use std::process::Command;

/// Builds what the tests build anyway, and leaves out what is only for a debugger: packing it takes minutes.
pub(crate) fn of_this_host() -> anyhow::Result<Vec<PathBuf>> {
    let names = [
        "vthal",
        "panel-server",
        "rvac",
        "rvac-mqtt",
        "rvac-metrics",
        "rvac-hooks",
        "rvac-dialect",
    ];
    workspace::build(&names, Profile::Dev)?;
    let stripped = folder().join("host");
    std::fs::create_dir_all(&stripped)?;
    let mut programs = Vec::new();
    for name in names {
        let program = stripped.join(name);
        let mut strip = Command::new("strip");
        strip
            .arg("-o")
            .arg(&program)
            .arg(workspace::program(name, Profile::Dev));
        process::capture(&mut strip)?;
        programs.push(program);
    }
    Ok(programs)
}
