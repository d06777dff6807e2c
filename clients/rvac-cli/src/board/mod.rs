//! The Linux board in the robot: what about it helps or hinders, as far as its files tell. Nothing is changed here.
//!
//! All paths lie below a root, which is `/` on a board and a folder of files in tests.

mod checks;
mod finding;
mod gyro;
mod serial_devices;
#[cfg(test)]
mod tests;

use std::io;
use std::path::{Path, PathBuf};

pub(crate) use checks::all;
pub(crate) use finding::{Finding, Grade};
pub(crate) use serial_devices::candidates;

/// The files of a Linux system.
#[derive(Clone, Debug)]
pub(crate) struct Board {
    root: PathBuf,
}

impl Board {
    /// The system whose files lie below `root`.
    pub(crate) fn below(root: &Path) -> Self {
        Self {
            root: root.to_owned(),
        }
    }

    /// A path of the system. It is given without the root's slash.
    pub(crate) fn path(&self, inside: &str) -> PathBuf {
        self.root.join(inside.trim_start_matches('/'))
    }

    /// The text of a file; `None` if there is none that can be read.
    pub(crate) fn text(&self, inside: &str) -> Option<String> {
        let bytes = std::fs::read(self.path(inside)).ok()?;
        // The kernel ends the texts of the device tree with a zero.
        Some(
            String::from_utf8_lossy(&bytes)
                .trim_end_matches(['\0', '\n'])
                .to_owned(),
        )
    }

    /// Where a link of the system points to, within the system.
    pub(crate) fn link(&self, inside: &str) -> io::Result<PathBuf> {
        std::fs::read_link(self.path(inside))
    }

    /// Names in a folder, in their order; none if there is no such folder.
    pub(crate) fn names(&self, inside: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(inside))
            .into_iter()
            .flatten()
            .flatten();
        let mut names: Vec<String> = entries
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Whether systemd runs this system.
    pub(crate) fn has_systemd(&self) -> bool {
        self.path("run/systemd/system").is_dir()
    }
}
