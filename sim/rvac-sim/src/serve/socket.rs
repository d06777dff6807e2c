//! The Unix socket of the simulator.

use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::FileTypeExt;
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};

/// A listening socket; its file goes with the value.
#[derive(Debug)]
pub(crate) struct SocketListener {
    listener: UnixListener,
    path: PathBuf,
}

/// Why the socket cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum SocketError {
    /// Somebody listens there.
    #[error("another program listens on the socket {}; end it or choose another --socket", .0.display())]
    InUse(PathBuf),
    /// Something else has the name.
    #[error("{} exists and is not a socket; remove it or choose another --socket", .0.display())]
    Taken(PathBuf),
    /// The system refuses.
    #[error("cannot listen on the socket {}: {error}; choose another --socket", path.display())]
    Open {
        /// Where.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl SocketListener {
    /// Listens on `path`. A socket without a listener was left by a killed simulator, and is
    /// replaced.
    pub(crate) fn open(path: &Path) -> Result<Self, SocketError> {
        clear(path)?;
        let open = |path: &Path| {
            let listener = UnixListener::bind(path)?;
            listener.set_nonblocking(true)?;
            Ok(listener)
        };
        let listener = open(path).map_err(|error| SocketError::Open {
            path: path.to_owned(),
            error,
        })?;
        Ok(Self {
            listener,
            path: path.to_owned(),
        })
    }

    /// The next client that waits.
    pub(crate) fn accept(&self) -> io::Result<Option<UnixStream>> {
        match self.listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(true)?;
                Ok(Some(stream))
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(None),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(None),
            Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => Ok(None),
            Err(error) => Err(error),
        }
    }
}

fn clear(path: &Path) -> Result<(), SocketError> {
    let Ok(there) = std::fs::symlink_metadata(path) else {
        return Ok(());
    };
    if !there.file_type().is_socket() {
        return Err(SocketError::Taken(path.to_owned()));
    }
    if UnixStream::connect(path).is_ok() {
        return Err(SocketError::InUse(path.to_owned()));
    }
    std::fs::remove_file(path).map_err(|error| SocketError::Open {
        path: path.to_owned(),
        error,
    })
}

impl AsFd for SocketListener {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.listener.as_fd()
    }
}

impl Drop for SocketListener {
    fn drop(&mut self) {
        // Best effort: the folder may be gone already.
        std::fs::remove_file(&self.path).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::{SocketError, SocketListener};

    #[test]
    fn a_dead_socket_is_replaced_and_a_living_one_is_not() {
        let path = std::env::temp_dir().join(format!("rvac-sim-{}-socket", std::process::id()));
        let first = SocketListener::open(&path).unwrap();
        assert!(matches!(SocketListener::open(&path), Err(SocketError::InUse(_))));
        // What is left when a process is killed: the file without the listener.
        let SocketListener { .. } = &first;
        let kept = path.with_extension("kept");
        std::fs::hard_link(&path, &kept).unwrap();
        drop(first);
        assert!(!path.exists());
        std::fs::rename(&kept, &path).unwrap();
        drop(SocketListener::open(&path).unwrap());
        assert!(!path.exists());
        std::fs::write(&path, "precious").unwrap();
        assert!(matches!(SocketListener::open(&path), Err(SocketError::Taken(_))));
        std::fs::remove_file(&path).unwrap();
    }
}
