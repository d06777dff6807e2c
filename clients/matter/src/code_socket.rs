//! The socket at which the panel's server asks for the code: whoever connects is told, and the connection ends.

use std::fs::{self, Permissions};
use std::future;
use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _};
use std::os::unix::net::UnixStream as BlockingStream;
use std::path::Path;
use std::time::Duration;

use rvac_api::MatterInvitation;
use tokio::io::AsyncWriteExt as _;
use tokio::net::{UnixListener, UnixStream};
use tokio::time::timeout;

/// Its owner and its group may ask: whoever has the code could join before the owner does.
const SOCKET_MODE: u32 = 0o660;
/// Who asks takes the answer within this time.
const PATIENCE: Duration = Duration::from_secs(2);

/// Begins to listen. A socket that a predecessor has left is replaced, one that somebody listens at is not.
pub(crate) fn listen(path: &Path) -> io::Result<UnixListener> {
    match fs::symlink_metadata(path) {
        Ok(left) if left.file_type().is_socket() && BlockingStream::connect(path).is_err() => {
            fs::remove_file(path)?;
        }
        Ok(_) => return Err(ErrorKind::AddrInUse.into()),
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(error),
    }
    let listener = UnixListener::bind(path)?;
    fs::set_permissions(path, Permissions::from_mode(SOCKET_MODE))?;
    Ok(listener)
}

/// Tells everybody who connects; never ends.
pub(crate) async fn tell(listener: Option<UnixListener>, invitation: impl Fn() -> MatterInvitation) {
    let Some(listener) = listener else {
        return future::pending().await;
    };
    loop {
        match listener.accept().await {
            Ok((stream, _)) => answer(stream, &invitation()).await,
            Err(error) => {
                tracing::warn!(%error, "the panel's server cannot ask for the code");
                tokio::time::sleep(PATIENCE).await;
            }
        }
    }
}

async fn answer(mut stream: UnixStream, invitation: &MatterInvitation) {
    let text = serde_json::to_vec(invitation).unwrap_or_default();
    match timeout(PATIENCE, stream.write_all(&text)).await {
        Ok(Ok(())) => {}
        // It went away, or does not listen: it may ask again.
        Ok(Err(error)) => tracing::debug!(%error, "the code was not taken"),
        Err(_) => tracing::debug!("the code was not taken in time"),
    }
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;
    use std::os::unix::fs::PermissionsExt as _;

    use rvac_api::MatterInvitation;
    use tokio::io::AsyncReadExt as _;
    use tokio::net::UnixStream;

    use super::{listen, tell};
    use crate::store::tests::scratch;

    #[tokio::test]
    async fn whoever_connects_is_told_what_is_so_now() {
        let folder = scratch("code-socket");
        let path = folder.path("code.sock");
        let listener = listen(&path).unwrap();
        let mode = std::fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o660);
        let left_s = std::cell::Cell::new(900);
        let invitation = || {
            left_s.set(left_s.get() - 100);
            MatterInvitation {
                code: Some("MT:X".to_owned()),
                open_s: left_s.get(),
                ..MatterInvitation::default()
            }
        };
        let asks = async {
            let mut told = Vec::new();
            for _ in 0..2 {
                let mut text = String::new();
                let mut stream = UnixStream::connect(&path).await.unwrap();
                stream.read_to_string(&mut text).await.unwrap();
                told.push(serde_json::from_str::<MatterInvitation>(&text).unwrap().open_s);
            }
            told
        };
        let told = tokio::select! {
            told = asks => told,
            () = tell(Some(listener), invitation) => unreachable!("it never ends"),
        };
        assert_eq!(told, [800, 700]);
        std::fs::remove_dir_all(folder.path("")).unwrap();
    }

    #[tokio::test]
    async fn only_a_socket_that_nobody_listens_at_is_replaced() {
        let folder = scratch("code-socket-left");
        let path = folder.path("code.sock");
        let first = listen(&path).unwrap();
        assert_eq!(listen(&path).unwrap_err().kind(), ErrorKind::AddrInUse);
        drop(first);
        assert!(listen(&path).is_ok(), "its predecessor is gone");
        let file = folder.path("choices.json");
        std::fs::write(&file, "kept").unwrap();
        assert_eq!(listen(&file).unwrap_err().kind(), ErrorKind::AddrInUse);
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
        std::fs::remove_dir_all(folder.path("")).unwrap();
    }
}
