//! The end of a daemon's socket that a test answers, and the connections it takes.

use std::io;
use std::time::Duration;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{UnixListener, UnixStream};
use tokio::time::timeout;

/// Whatever is awaited comes within this time or the test fails.
pub(crate) const DEADLINE: Duration = Duration::from_secs(20);

/// A connection that the server made.
#[derive(Debug)]
pub(crate) struct Daemon(UnixStream);

impl Daemon {
    /// The next connection.
    pub(crate) async fn accept(listener: &UnixListener) -> Self {
        let (stream, _) = timeout(DEADLINE, listener.accept())
            .await
            .expect("a connection in time")
            .unwrap();
        Self(stream)
    }

    pub(crate) async fn say(&mut self, text: &str) {
        self.try_say(text).await.unwrap();
    }

    /// The same to a server that may be gone.
    pub(crate) async fn try_say(&mut self, text: &str) -> io::Result<()> {
        self.0.write_all(format!("{text}\u{1f}").as_bytes()).await
    }

    /// The next message; none when the other end is gone.
    pub(crate) async fn hear(&mut self) -> Option<String> {
        let mut text = Vec::new();
        loop {
            match timeout(DEADLINE, self.0.read_u8())
                .await
                .expect("a message in time")
            {
                Ok(0x1f) => return Some(String::from_utf8(text).unwrap()),
                Ok(byte) => text.push(byte),
                Err(_) => return None,
            }
        }
    }
}
