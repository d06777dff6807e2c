//! The files of the project: what git follows or would follow.

use crate::{process, workspace};
use anyhow::Context;
use std::path::PathBuf;
use std::process::Command;

/// A file and its path from the root of the repository.
#[derive(Debug)]
pub(super) struct File {
    /// With `/` between the parts.
    pub(super) path: String,
    /// Its bytes.
    pub(super) bytes: Vec<u8>,
}

/// All files, sorted by path.
#[derive(Debug)]
pub(super) struct Files {
    all: Vec<File>,
}

impl Files {
    /// Reads all files that git follows, and the new ones that it is not told to ignore.
    pub(super) fn list() -> anyhow::Result<Self> {
        let root = workspace::root();
        let mut git = Command::new("git");
        git.current_dir(&root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
        let listed = process::capture(&mut git).context("tidy needs git to list the files of the project")?;
        let mut all = Vec::new();
        for path in listed.split('\0').filter(|path| !path.is_empty()) {
            // A file that was just deleted is still listed.
            if let Ok(bytes) = std::fs::read(root.join(path)) {
                all.push(File {
                    path: path.to_owned(),
                    bytes,
                });
            }
        }
        all.sort_by(|left, right| left.path.cmp(&right.path));
        all.dedup_by(|left, right| left.path == right.path);
        Ok(Self { all })
    }

    /// All files.
    pub(super) fn all(&self) -> impl Iterator<Item = &File> {
        self.all.iter()
    }

    /// All files whose name ends with one of `endings` and that are text.
    pub(super) fn texts<'a>(&'a self, endings: &'a [&str]) -> impl Iterator<Item = (&'a str, &'a str)> {
        let fits = move |path: &str| endings.iter().any(|ending| path.ends_with(ending));
        self.all
            .iter()
            .filter(move |file| fits(&file.path))
            .filter_map(|file| Some((file.path.as_str(), std::str::from_utf8(&file.bytes).ok()?)))
    }

    /// The text of one file.
    pub(super) fn text(&self, path: &str) -> Option<&str> {
        self.all
            .iter()
            .find(|file| file.path == path)
            .and_then(|file| std::str::from_utf8(&file.bytes).ok())
    }

    /// Whether there is such a file or a folder with files.
    pub(super) fn has(&self, path: &str) -> bool {
        let folder = format!("{}/", path.trim_end_matches('/'));
        self.all
            .iter()
            .any(|file| file.path == path || file.path.starts_with(&folder))
    }

    /// A path on this machine.
    pub(super) fn outside(relative: &str) -> PathBuf {
        workspace::root().join(relative)
    }
}
