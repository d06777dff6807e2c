//! A client on any of the routes.

use std::io::ErrorKind;
use std::time::{Duration, Instant};

use anyhow::bail;
use panel_bench::{PATIENCE, Stream, http};
use tungstenite::{Message, WebSocket};
use vthal_bench::Client;

/// Longest wait for a message in one poll.
pub(crate) const LOOK: Duration = Duration::from_millis(100);

/// A sender and receiver of texts.
pub(crate) enum Peer {
    /// At the daemon's own socket.
    Direct(Client),
    /// A page's connection.
    Socket(Box<WebSocket<Box<dyn Stream>>>),
}

impl Peer {
    /// Sends a text.
    pub(crate) fn say(&mut self, text: &str) -> anyhow::Result<()> {
        match self {
            Self::Direct(client) => client.send(text)?,
            Self::Socket(socket) => socket.send(Message::text(text))?,
        }
        Ok(())
    }

    /// The next text; none when nothing came for a while.
    pub(crate) fn hear(&mut self) -> anyhow::Result<Option<String>> {
        match self {
            Self::Direct(client) => Ok(client.next(Instant::now() + LOOK)?),
            Self::Socket(socket) => match socket.read() {
                Ok(Message::Text(text)) => Ok(Some(text.as_str().to_owned())),
                Ok(_) => Ok(None),
                Err(tungstenite::Error::Io(error))
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
                {
                    Ok(None)
                }
                Err(error) => Err(error.into()),
            },
        }
    }

    /// Hears until a text has these words.
    pub(crate) fn hear_until(&mut self, words: &str) -> anyhow::Result<()> {
        let deadline = Instant::now() + PATIENCE;
        while Instant::now() < deadline {
            if self.hear()?.is_some_and(|text| text.contains(words)) {
                return Ok(());
            }
        }
        bail!("nothing with {words} came within {} s", PATIENCE.as_secs())
    }
}

/// Who asks and waits for the answer.
pub(crate) enum Asker {
    /// A question to the daemon.
    Daemon(Peer),
    /// A question to the server itself.
    Server {
        /// The connection, kept.
        stream: Box<dyn Stream>,
        /// What lets it in.
        headers: String,
    },
}

impl Asker {
    /// Asks once.
    pub(crate) fn ask(&mut self) -> anyhow::Result<()> {
        match self {
            Self::Daemon(peer) => {
                peer.say(r#"{"c":"hello","name":"bench"}"#)?;
                peer.hear_until(r#""hello""#)
            }
            Self::Server { stream, headers } => http::get(stream, "/api/session", headers).map(drop),
        }
    }
}
