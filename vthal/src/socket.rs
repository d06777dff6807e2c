//! The Unix socket: one listener, mode 0660, no second daemon on the same path.

use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tokio::net::{UnixListener, UnixStream};
use tokio::sync::mpsc::Sender;

use crate::event::Event;

/// Why there is no socket.
#[derive(Debug, thiserror::Error)]
pub enum SocketError {
    /// A daemon listens there.
    #[error("another vthal listens on {}: stop it, or choose another path with --socket", .0.display())]
    Taken(PathBuf),
    /// Something that is no socket lies there.
    #[error("{} exists and is not a socket: remove it, or choose another path with --socket", .0.display())]
    NotASocket(PathBuf),
    /// The system refuses.
    #[error("cannot listen on {}: {error}; check that its folder exists and may be written", .path.display())]
    Refused {
        /// The path.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
}

/// Listens on `path`. A socket file that a dead daemon left is replaced; the new one appears with its mode set.
///
/// # Errors
/// See [`SocketError`].
pub(crate) fn listen(path: &Path) -> Result<UnixListener, SocketError> {
    use std::os::unix::fs::FileTypeExt;
    let refused = |error| SocketError::Refused {
        path: path.to_owned(),
        error,
    };
    match fs::symlink_metadata(path) {
        Ok(found) if !found.file_type().is_socket() => return Err(SocketError::NotASocket(path.to_owned())),
        Ok(_) if std::os::unix::net::UnixStream::connect(path).is_ok() => {
            return Err(SocketError::Taken(path.to_owned()));
        }
        _ => {}
    }
    let mut fresh = path.as_os_str().to_owned();
    fresh.push(format!(".{}", std::process::id()));
    let fresh = PathBuf::from(fresh);
    let listener = UnixListener::bind(&fresh).map_err(refused)?;
    let placed = fs::set_permissions(&fresh, fs::Permissions::from_mode(0o660))
        .and_then(|()| fs::rename(&fresh, path));
    if let Err(error) = placed {
        fs::remove_file(&fresh).ok();
        return Err(refused(error));
    }
    Ok(listener)
}

/// Accepts clients until the daemon's event queue closes.
pub(crate) async fn serve(listener: UnixListener, events: Sender<Event>) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                if events.send(Event::Connected(stream)).await.is_err() {
                    return;
                }
            }
            Err(error) => {
                // Out of file handles: those that are there go on; trying at once would spin.
                tracing::warn!("a client could not connect: {error}");
                tokio::time::sleep(std::time::Duration::from_millis(200)).await;
            }
        }
    }
}

/// Says no to a client for whom there is no room, as far as its socket takes it.
pub(crate) fn turn_away(stream: &UnixStream, message: &[u8]) {
    // It is closed in any case; a client that cannot even take a line gets none.
    stream.try_write(message).ok();
}
