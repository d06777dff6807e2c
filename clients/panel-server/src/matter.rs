//! The code by which a home lets the robot in by Matter, as `rvac-matter` tells it over its own socket.

use std::io;
use std::path::Path;
use std::time::Duration;

use rvac_api::MatterInvitation;
use tokio::io::AsyncReadExt as _;
use tokio::net::UnixStream;
use tokio::time::timeout;

/// What it says is a fraction of that.
const ANSWER_BYTES_MAX: u64 = 4 << 10;
/// It answers at once, or is as good as away.
const PATIENCE: Duration = Duration::from_secs(2);

/// What it says now; nothing when it does not run, or says nothing that is understood.
pub(crate) async fn invitation(socket: &Path) -> Option<MatterInvitation> {
    match timeout(PATIENCE, ask(socket)).await {
        Ok(Ok(told)) => Some(told),
        Ok(Err(error))
            if matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::ConnectionRefused
            ) =>
        {
            None
        }
        Ok(Err(error)) => {
            tracing::warn!(%error, socket = %socket.display(), "rvac-matter tells no code");
            None
        }
        Err(_) => {
            tracing::warn!(socket = %socket.display(), "rvac-matter does not answer");
            None
        }
    }
}

async fn ask(socket: &Path) -> io::Result<MatterInvitation> {
    let stream = UnixStream::connect(socket).await?;
    let mut answer = Vec::new();
    stream.take(ANSWER_BYTES_MAX).read_to_end(&mut answer).await?;
    Ok(serde_json::from_slice(&answer)?)
}
