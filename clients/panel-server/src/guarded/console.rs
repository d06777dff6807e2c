//! The Unix socket of the person at the robot's own computer: whoever may open it is the owner.

use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use pairing::Wanted;
use pairing::console::{Order, Reply};
use pairing::wire::{Forgotten, OpenWindow, Refused};
use tokio::io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::{UnixListener, UnixStream};
use tokio::time::timeout;
use tracing::warn;

use super::NotDone;
use crate::gate::Gate;

/// The longest order.
const ORDER_BYTES_MAX: u64 = 4 << 10;

/// Whoever says nothing for so long is let go.
const PATIENCE: Duration = Duration::from_secs(10);

/// Listens at `path`, for the owner of the server alone. A socket that a dead server left is replaced.
pub(crate) fn listen(path: &Path) -> io::Result<UnixListener> {
    let mut fresh = path.as_os_str().to_owned();
    fresh.push(format!(".{}", std::process::id()));
    fs::remove_file(&fresh).ok(); // Left by a crash, or not there.
    let listener = UnixListener::bind(&fresh)?;
    fs::set_permissions(&fresh, fs::Permissions::from_mode(0o600))?;
    fs::rename(&fresh, path)?;
    Ok(listener)
}

/// Answers one order a connection, for ever.
pub(crate) async fn serve_console(listener: UnixListener, gate: Arc<Gate>) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                if let Ok(Err(error)) = timeout(PATIENCE, answer(stream, &gate)).await {
                    warn!(%error, "the console went away");
                }
            }
            Err(error) => {
                warn!(%error, "cannot accept a console");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

async fn answer(mut stream: UnixStream, gate: &Gate) -> io::Result<()> {
    let (reading, mut writing) = stream.split();
    let mut line = String::new();
    BufReader::new(reading.take(ORDER_BYTES_MAX))
        .read_line(&mut line)
        .await?;
    let reply = match serde_json::from_str::<Order>(&line) {
        Ok(order) => obey(order, gate)
            .await
            .unwrap_or_else(|error| Reply::Refused(refused(&error))),
        Err(error) => Reply::Refused(Refused {
            reason: "syntax".to_owned(),
            text: format!(
                "The order could not be read ({error}): rvac and panel-server must be of one version."
            ),
        }),
    };
    let mut text = serde_json::to_vec(&reply)?;
    text.push(b'\n');
    writing.write_all(&text).await
}

async fn obey(order: Order, gate: &Gate) -> Result<Reply, NotDone> {
    let guarded = &gate.guarded;
    Ok(match order {
        Order::Pair { role } => Reply::Opened(gate.open(OpenWindow { role }).await?),
        Order::Add { name, role } => Reply::Added {
            token: guarded.add(Wanted { name, role }).await?.text(),
        },
        Order::Clients => Reply::Clients {
            clients: guarded.watch().borrow().iter().map(Into::into).collect(),
        },
        Order::Revoke { id } => {
            guarded.revoke(id).await?;
            Reply::Done
        }
        Order::SetRole { id, role } => {
            guarded.set_role(id, role).await?;
            Reply::Done
        }
        Order::Vouch { id } => {
            guarded.vouch(id)?;
            Reply::Done
        }
        Order::ForgetAll { identity: false } => {
            guarded.forget_all(Forgotten::Console).await?;
            gate.beep();
            Reply::Done
        }
        Order::ForgetAll { identity: true } => {
            gate.forget_everything(Forgotten::Console).await?;
            gate.beep();
            Reply::Trust(gate.trust())
        }
        Order::Trust => Reply::Trust(gate.trust()),
    })
}

/// A refusal as clients read it.
pub(crate) fn refused(error: &NotDone) -> Refused {
    match error {
        NotDone::Refused(refusal) => (*refusal).into(),
        NotDone::Disk(_) | NotDone::Random(_) | NotDone::Identity(_) => Refused {
            reason: "robot".to_owned(),
            text: error.to_string(),
        },
    }
}
