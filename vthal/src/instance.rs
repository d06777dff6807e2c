//! One daemon per state folder.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use rustix::fs::{FlockOperation, flock};

/// Held as long as the daemon lives; the lock ends with the process, however it ends.
#[derive(Debug)]
pub(crate) struct InstanceLock {
    _file: File,
}

/// Why the state folder is not ours.
#[derive(Debug, thiserror::Error)]
pub enum InstanceError {
    /// Another daemon uses it.
    #[error("another vthal (process {pid}) uses the state folder {}: stop it, or choose another folder with --state", .folder.display())]
    Taken {
        /// The folder.
        folder: PathBuf,
        /// Its process, as it wrote it down.
        pid: String,
    },
    /// The folder cannot be used.
    #[error("cannot use the state folder {}: {error}; check that it may be written", .folder.display())]
    Unusable {
        /// The folder.
        folder: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
}

/// Takes the state folder, creating it when it is missing.
///
/// # Errors
/// See [`InstanceError`].
pub(crate) fn take(folder: &Path) -> Result<InstanceLock, InstanceError> {
    let unusable = |error| InstanceError::Unusable {
        folder: folder.to_owned(),
        error,
    };
    std::fs::create_dir_all(folder).map_err(unusable)?;
    let path = folder.join("vthal.pid");
    let mut file = OpenOptions::new()
        .create(true)
        .read(true)
        .write(true)
        .truncate(false)
        .open(path)
        .map_err(unusable)?;
    if flock(&file, FlockOperation::NonBlockingLockExclusive).is_err() {
        let mut pid = String::new();
        // Only for the message; a number that cannot be read is left out.
        file.read_to_string(&mut pid).ok();
        return Err(InstanceError::Taken {
            folder: folder.to_owned(),
            pid: pid.trim().to_owned(),
        });
    }
    file.set_len(0)
        .and_then(|()| writeln!(file, "{}", std::process::id()))
        .map_err(unusable)?;
    Ok(InstanceLock { _file: file })
}
