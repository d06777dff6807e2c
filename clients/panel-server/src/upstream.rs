//! The connection of one browser to a Unix socket, made again for ever.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::UnixStream;
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep_until, timeout};

use rvac_api::SEPARATOR;

/// Pause between two attempts to connect.
const RETRY_AFTER: Duration = Duration::from_millis(500);

/// A peer that takes this long to accept a request is as good as gone.
const WRITE_LIMIT: Duration = Duration::from_secs(2);

/// The longest message that is accepted; a map of a very large home has about 2 MiB.
const MESSAGE_BYTES_MAX: usize = 8 << 20;

/// What happened on the connection.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// It is open now.
    Connected,
    /// It is gone, or could not be made.
    Lost,
    /// A message came.
    Message(String),
}

/// The connection or the wish for one.
#[derive(Debug)]
pub(crate) struct Upstream {
    path: PathBuf,
    link: Link,
}

#[derive(Debug)]
enum Link {
    Down {
        retry_at: Instant,
    },
    /// A task of its own, so that a cancelled wait does not throw away a connection that is half made.
    Coming(JoinHandle<io::Result<UnixStream>>),
    Up {
        stream: UnixStream,
        received: Vec<u8>,
        searched: usize,
    },
}

impl Upstream {
    /// A connection to the socket at `path`, to be made by the first call of [`Self::next`].
    pub(crate) fn new(path: PathBuf) -> Self {
        Self {
            path,
            link: Link::Down {
                retry_at: Instant::now(),
            },
        }
    }

    /// Waits for the next event. May be cancelled at any time without losing anything.
    pub(crate) async fn next(&mut self) -> Event {
        if let Link::Down { retry_at } = self.link {
            sleep_until(retry_at).await;
            self.link = Link::Coming(tokio::spawn(UnixStream::connect(self.path.clone())));
        }
        let read = match &mut self.link {
            Link::Coming(attempt) => {
                let made = attempt.await;
                return self.finish(made.ok().and_then(Result::ok));
            }
            Link::Up {
                stream,
                received,
                searched,
            } => next_message(stream, received, searched).await,
            Link::Down { .. } => return Event::Lost,
        };
        match read {
            Ok(text) => Event::Message(text),
            Err(_lost) => self.lose(),
        }
    }

    /// Sends one message; when that fails the connection is given up and made again.
    pub(crate) async fn send(&mut self, text: &str) -> Result<(), NotSent> {
        let Link::Up { stream, .. } = &mut self.link else {
            return Err(NotSent);
        };
        let mut bytes = Vec::with_capacity(text.len() + 1);
        bytes.extend_from_slice(text.as_bytes());
        bytes.push(SEPARATOR);
        match timeout(WRITE_LIMIT, stream.write_all(&bytes)).await {
            Ok(Ok(())) => Ok(()),
            _ => {
                self.lose();
                Err(NotSent)
            }
        }
    }

    fn finish(&mut self, made: Option<UnixStream>) -> Event {
        let Some(stream) = made else { return self.lose() };
        self.link = Link::Up {
            stream,
            received: Vec::new(),
            searched: 0,
        };
        Event::Connected
    }

    fn lose(&mut self) -> Event {
        self.link = Link::Down {
            retry_at: Instant::now() + RETRY_AFTER,
        };
        Event::Lost
    }
}

/// The peer is away.
#[derive(Debug)]
pub(crate) struct NotSent;

/// Reads until the next separator. `searched` bytes of `received` are known to hold none.
async fn next_message(
    stream: &mut UnixStream,
    received: &mut Vec<u8>,
    searched: &mut usize,
) -> io::Result<String> {
    loop {
        let fresh = received.get(*searched..).unwrap_or_default();
        if let Some(at) = fresh.iter().position(|byte| *byte == SEPARATOR) {
            let end = *searched + at;
            let message: Vec<u8> = received.drain(..=end).take(end).collect();
            *searched = 0;
            return String::from_utf8(message).map_err(io::Error::other);
        }
        *searched = received.len();
        if received.len() > MESSAGE_BYTES_MAX {
            return Err(io::Error::other("message too long"));
        }
        if stream.read_buf(received).await? == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Event, Upstream};
    use crate::folder::Folder;
    use tokio::io::AsyncWriteExt;
    use tokio::net::UnixListener;

    #[tokio::test]
    async fn splits_messages_however_they_arrive_and_reconnects() {
        let folder = Folder::new();
        let path = folder.join("vthal.sock");
        let listener = UnixListener::bind(&path).unwrap();
        let mut upstream = Upstream::new(path);
        assert_eq!(upstream.next().await, Event::Connected);
        let (mut peer, _) = listener.accept().await.unwrap();
        peer.write_all(b"{\"a\":1}\x1f{\"b\"").await.unwrap();
        assert_eq!(upstream.next().await, Event::Message("{\"a\":1}".to_owned()));
        peer.write_all(b":2}\x1f").await.unwrap();
        assert_eq!(upstream.next().await, Event::Message("{\"b\":2}".to_owned()));
        drop(peer);
        assert_eq!(upstream.next().await, Event::Lost);
        assert!(upstream.send("{}").await.is_err());
        assert_eq!(upstream.next().await, Event::Connected);
    }
}
