//! The stage that tries packages.

use super::count::Count;
use super::extent::Extent;
use super::runner::{Failed, Result};
use crate::package::trial::{self, Scope};

/// Tries this host's programs in a package; with `--long` the packages that are given out.
pub(super) fn packages(extent: Extent) -> Result {
    match trial::run(scope(extent)).and_then(|trials| trial::print(&trials)) {
        Ok(()) => Ok(Count::ONE),
        Err(error) => Err(Failed {
            count: Count::default(),
            errors: vec![error],
        }),
    }
}

/// The same for programs. Asked for by name it tries what is given out, unless --all says that the scripts are enough.
pub(super) fn as_json(extent: Extent) -> anyhow::Result<()> {
    let scope = if extent == Extent::All {
        Scope::Scripts
    } else {
        Scope::Released
    };
    trial::print(&trial::run(scope)?)
}

fn scope(extent: Extent) -> Scope {
    if extent == Extent::Long {
        Scope::Released
    } else {
        Scope::Scripts
    }
}
