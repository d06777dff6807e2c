//! Serial devices: opened raw, locked against a second program.

use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::path::{Path, PathBuf};

use rustix::fs::{FlockOperation, Mode, OFlags, flock};
use serial2_tokio::{SerialPort, Settings};

use crate::serial_identity::{BY_ID, links};

/// Which device and how fast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SerialSettings {
    /// Path of the device; may appear later.
    pub path: PathBuf,
    /// Bits per second.
    pub baud: u32,
}

/// An open line. The lock is advisory and dies with the process, however that ends; it has a handle of its own because the
/// port keeps its only one.
#[derive(Debug)]
pub(crate) struct Line {
    /// Reads and writes.
    pub port: SerialPort,
    /// Holds the device.
    pub lock: DeviceLock,
}

/// A device that no second program of ours opens.
#[derive(Debug)]
pub(crate) struct DeviceLock {
    handle: OwnedFd,
}

impl AsFd for DeviceLock {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.handle.as_fd()
    }
}

/// Locks the device against a second daemon, then sets raw mode at the configured rate.
pub(crate) fn open(settings: &SerialSettings) -> Result<Line, OpenError> {
    let path = settings.path.as_path();
    let lock = lock(path)?;
    let port = SerialPort::open(path, |mut line: Settings| {
        line.set_raw();
        line.set_baud_rate(settings.baud)?;
        Ok(line)
    })
    .map_err(|error| OpenError::refused(path, error))?;
    Ok(Line { port, lock })
}

/// Locks a device against a second daemon.
pub(crate) fn lock(path: &Path) -> Result<DeviceLock, OpenError> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let handle = rustix::fs::open(path, flags, Mode::empty())
        .map_err(|error| OpenError::refused(path, error.into()))?;
    flock(&handle, FlockOperation::NonBlockingLockExclusive)
        .map_err(|_| OpenError::InUse(path.to_owned()))?;
    Ok(DeviceLock { handle })
}

/// Why the device is not open.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OpenError {
    /// The system refuses.
    #[error("cannot open the device {}: {error}; waiting for it{}", .path.display(), others(.path))]
    Open {
        /// The device.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// Another program has locked it.
    #[error("the device {} is locked by another program; waiting for it", .0.display())]
    InUse(PathBuf),
}

/// Names the adapters that there are, for whoever configured another one.
fn others(path: &Path) -> String {
    let links = if path.exists() {
        Vec::new()
    } else {
        links(Path::new(BY_ID))
    };
    let names: Vec<String> = links.iter().map(|link| link.display().to_string()).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(" (there is: {})", names.join(", "))
    }
}

impl OpenError {
    /// The system refuses this device.
    pub(crate) fn refused(path: &Path, error: io::Error) -> Self {
        Self::Open {
            path: path.to_owned(),
            error,
        }
    }
}
