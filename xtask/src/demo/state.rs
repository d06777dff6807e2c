//! The state folder: private, new, and gone afterwards unless it was asked for by name.

use anyhow::Context;
use std::fs::DirBuilder;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

/// A folder that only its owner may enter.
#[derive(Debug)]
pub(crate) struct State {
    folder: PathBuf,
    kept: bool,
}

impl State {
    /// Makes the folder: the named one, which must not exist yet, or a temporary one.
    ///
    /// The temporary one lies directly below the folder for temporary files because the path of a Unix socket may
    /// not be longer than 107 bytes.
    pub(crate) fn create(named: Option<&Path>) -> anyhow::Result<Self> {
        let folder = match named {
            Some(folder) => std::path::absolute(folder)?,
            None => std::env::temp_dir().join(format!("rvac-demo-{}", std::process::id())),
        };
        DirBuilder::new().mode(0o700).create(&folder).with_context(|| {
            format!(
                "cannot make the new folder {} for sockets, logs and recordings",
                folder.display()
            )
        })?;
        Ok(Self {
            folder,
            kept: named.is_some(),
        })
    }

    /// A path in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

impl Drop for State {
    fn drop(&mut self) {
        if !self.kept {
            // Nothing is left that could be done about a folder that cannot be removed.
            std::fs::remove_dir_all(&self.folder).ok();
        }
    }
}
