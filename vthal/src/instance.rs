//! One daemon per state folder.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{FlockOperation, flock};

/// Held as long as the daemon lives; the lock ends with the process, however it ends.
#[derive(Debug)]
pub(crate) struct InstanceLock {
    /// `None` where there is no folder, so nothing that two daemons could spoil.
    _folder: Option<File>,
    /// Why nothing can be kept.
    pub(crate) complaint: Option<String>,
}

/// Another daemon uses the state folder.
#[derive(Debug, thiserror::Error)]
#[error("another vthal (process {pid}) uses the state folder {}: stop it, or choose another folder with --state", .folder.display())]
pub struct InstanceTaken {
    /// The folder.
    folder: PathBuf,
    /// Its process, as it wrote it down.
    pid: String,
}

/// Takes the state folder, creating it when it is missing. The lock is on the folder itself, which may be on a card that nobody can
/// write any more: the robot can be driven all the same.
///
/// # Errors
/// See [`InstanceTaken`].
pub(crate) fn take(folder: &Path) -> Result<InstanceLock, InstanceTaken> {
    let made = std::fs::create_dir_all(folder);
    let opened = made.and_then(|()| File::open(folder));
    let pid_file = folder.join("vthal.pid");
    let complaint = |error: io::Error| {
        format!(
            "the state folder {} cannot be written: {error}. Maps, schedules, runs and what was learnt are not kept. Make room, or replace the card",
            folder.display()
        )
    };
    let opened = match opened {
        Ok(opened) => opened,
        Err(error) => {
            return Ok(InstanceLock {
                _folder: None,
                complaint: Some(complaint(error)),
            });
        }
    };
    if flock(&opened, FlockOperation::NonBlockingLockExclusive).is_err() {
        // Only for the message; a number that cannot be read is left out.
        let pid = kept_file::read_text(&pid_file).unwrap_or_default();
        return Err(InstanceTaken {
            folder: folder.to_owned(),
            pid: pid.trim().to_owned(),
        });
    }
    let written = std::fs::write(&pid_file, format!("{}\n", std::process::id()));
    Ok(InstanceLock {
        _folder: Some(opened),
        complaint: written.err().map(complaint),
    })
}
