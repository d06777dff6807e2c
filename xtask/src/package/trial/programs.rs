//! The host's own programs, for a package that is tried and not given out.

use crate::workspace::{self, Profile};
use std::path::PathBuf;

/// Builds what the tests build anyway.
pub(super) fn of_this_host() -> anyhow::Result<Vec<PathBuf>> {
    let names = ["vthal", "panel-server", "rvac"];
    workspace::build(&names, Profile::Dev)?;
    Ok(names.map(|name| workspace::program(name, Profile::Dev)).to_vec())
}
