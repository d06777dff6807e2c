//! The two ways to build the page.

use crate::workspace;
use std::path::PathBuf;

/// For whom the page is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Page {
    /// For robots and packages: as small as can be, which takes minutes on one core.
    Release,
    /// For the demo: there soon, and several times as large.
    Demo,
}

impl Page {
    /// The profile of clients/panel, and the name of the compiler's folder for it.
    pub(super) fn profile(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Demo => "demo",
        }
    }

    /// Where its packed files lie.
    pub(crate) fn folder(self) -> PathBuf {
        workspace::target().join(match self {
            Self::Release => "panel",
            Self::Demo => "panel-demo",
        })
    }

    /// Where the compiler leaves it: a folder that no other build locks.
    pub(super) fn target(self) -> PathBuf {
        workspace::target().join(match self {
            Self::Release => "panel-wasm",
            Self::Demo => "panel-demo-wasm",
        })
    }
}
