//! Files that must be whole after a crash at any moment.
//!
//! A new file is written beside the present one, flushed, and renamed over it; the present one stays as `.old`, because SD
//! cards lie about flushing, and so that a person can go back.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Puts `bytes` in place of the file. After a crash at any moment either it or its predecessor is there, whole.
///
/// # Errors
/// What the file system says.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let fresh = beside(path, "new");
    let mut file = File::create(&fresh)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    if path.exists() {
        fs::rename(path, beside(path, "old"))?;
    }
    fs::rename(&fresh, path)?;
    if let Some(folder) = path.parent() {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

/// The present file and its predecessor, whether they are there or not.
pub(crate) fn versions(path: &Path) -> [PathBuf; 2] {
    [path.to_owned(), beside(path, "old")]
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{ending}"));
    PathBuf::from(name)
}
