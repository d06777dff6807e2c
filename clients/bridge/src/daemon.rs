//! The connection to the daemon's socket, made again for ever.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use rvac_api::{Request, RequestBody, SEPARATOR, Topic, Update};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::UnixStream;
use tokio::time::{Instant, sleep_until, timeout};

/// Pause between two attempts to connect.
const RETRY_AFTER: Duration = Duration::from_millis(500);
/// A daemon that takes this long to accept a request is as good as gone.
const WRITE_LIMIT: Duration = Duration::from_secs(2);
/// The longest message that is accepted; a map of a very large home has about 2 MiB.
const MESSAGE_BYTES_MAX: usize = 8 << 20;
/// Capacity that a buffer keeps after a large message.
const BUFFER_BYTES: usize = 64 << 10;

/// What happened on the connection.
#[derive(Debug)]
pub enum News {
    /// It is open, and all topics are asked for.
    Connected,
    /// It is gone, or could not be made.
    Lost,
    /// The daemon says something.
    Update(Box<Update>),
}

/// The connection, or the wish for one.
#[derive(Debug)]
pub struct Daemon {
    path: PathBuf,
    /// What the daemon's log calls this program.
    name: &'static str,
    topics: Vec<Topic>,
    stream: Option<UnixStream>,
    /// It is introduced, and has asked for its topics.
    greeted: bool,
    received: Vec<u8>,
    /// So many bytes of it hold no separator.
    searched: usize,
    retry_at: Instant,
    last_id: u32,
}

/// The daemon is away.
#[derive(Debug, thiserror::Error)]
#[error("the robot's daemon is away")]
pub struct NotSent;

impl Daemon {
    /// A connection to the socket at `path` that follows these topics, to be made by the first call of [`Self::next`].
    #[must_use]
    pub fn new(path: PathBuf, name: &'static str, topics: &[Topic]) -> Self {
        Self {
            path,
            name,
            topics: topics.to_vec(),
            stream: None,
            greeted: false,
            received: Vec::new(),
            searched: 0,
            retry_at: Instant::now(),
            last_id: 0,
        }
    }

    /// Waits for the next news. May be cancelled at any time without losing anything.
    pub async fn next(&mut self) -> News {
        // A wait that was cancelled in the middle of the greeting begins anew.
        if !self.greeted {
            sleep_until(self.retry_at).await;
            return match self.connect().await {
                Ok(()) => News::Connected,
                Err(_) => self.lose(),
            };
        }
        loop {
            match self.next_message().await {
                // Updates of a newer daemon are passed over.
                Ok(message) => {
                    if let Ok(update) = serde_json::from_slice(&message) {
                        return News::Update(Box::new(update));
                    }
                }
                Err(error) => {
                    tracing::info!(%error, "the daemon is gone");
                    return self.lose();
                }
            }
        }
    }

    /// Says once more who this is, to hear who the robot is; see [`crate::Knowledge::wants_hello`].
    ///
    /// # Errors
    /// [`NotSent`] when the daemon is away.
    pub async fn hello(&mut self) -> Result<(), NotSent> {
        let name = self.name.to_owned();
        self.request(RequestBody::Hello { name }).await.map(drop)
    }

    /// Asks for something; gives the number that the answer will carry.
    ///
    /// # Errors
    /// [`NotSent`] when the daemon is away; the connection is then made again.
    pub async fn request(&mut self, body: RequestBody) -> Result<u32, NotSent> {
        self.last_id = self.last_id.wrapping_add(1);
        let id = self.last_id;
        let request = Request { id: Some(id), body };
        match self.send(&request).await {
            Ok(()) => Ok(id),
            Err(_) => {
                self.lose();
                Err(NotSent)
            }
        }
    }

    async fn connect(&mut self) -> io::Result<()> {
        self.stream = Some(UnixStream::connect(&self.path).await?);
        let hello = RequestBody::Hello {
            name: self.name.to_owned(),
        };
        let watch = RequestBody::Watch {
            topics: self.topics.clone(),
        };
        for body in [hello, watch] {
            self.send(&Request { id: None, body }).await?;
        }
        self.greeted = true;
        Ok(())
    }

    async fn send(&mut self, request: &Request) -> io::Result<()> {
        let mut bytes = serde_json::to_vec(request)?;
        bytes.push(SEPARATOR);
        let Some(stream) = &mut self.stream else {
            return Err(io::ErrorKind::NotConnected.into());
        };
        timeout(WRITE_LIMIT, stream.write_all(&bytes)).await?
    }

    fn lose(&mut self) -> News {
        self.stream = None;
        self.greeted = false;
        self.received = Vec::new();
        self.searched = 0;
        self.retry_at = Instant::now() + RETRY_AFTER;
        News::Lost
    }

    async fn next_message(&mut self) -> io::Result<Vec<u8>> {
        let Some(stream) = &mut self.stream else {
            return Err(io::ErrorKind::NotConnected.into());
        };
        loop {
            let fresh = self.received.get(self.searched..).unwrap_or_default();
            if let Some(at) = fresh.iter().position(|byte| *byte == SEPARATOR) {
                let rest = self.received.split_off(self.searched + at + 1);
                let mut message = std::mem::replace(&mut self.received, rest);
                message.pop();
                self.searched = 0;
                return Ok(message);
            }
            self.searched = self.received.len();
            if self.received.len() > MESSAGE_BYTES_MAX {
                return Err(io::Error::other("a message of the daemon is too long"));
            }
            if self.received.is_empty() {
                self.received.shrink_to(BUFFER_BYTES);
            }
            if stream.read_buf(&mut self.received).await? == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{Topic, Update};
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
    use tokio::net::UnixListener;

    use super::{Daemon, News};

    #[tokio::test]
    async fn messages_arrive_whole_however_they_are_cut_and_the_connection_comes_back() {
        let path = std::env::temp_dir().join(format!("rvac-bridge-{}.sock", std::process::id()));
        std::fs::remove_file(&path).ok(); // Of an earlier run.
        let listener = UnixListener::bind(&path).unwrap();
        let mut daemon = Daemon::new(path.clone(), "test", &[Topic::Status]);
        assert!(matches!(daemon.next().await, News::Connected));
        let (mut peer, _) = listener.accept().await.unwrap();
        let mut asked = vec![0; 256];
        let count = peer.read(&mut asked).await.unwrap();
        let asked = String::from_utf8_lossy(&asked[..count]).into_owned();
        assert!(asked.starts_with(r#"{"c":"hello","name":"test"}"#), "{asked}");
        peer.write_all(b"{\"e\":\"of-tomorrow\"}\x1f{\"e\":\"done\",")
            .await
            .unwrap();
        peer.write_all(b"\"id\":7}\x1f").await.unwrap();
        let News::Update(update) = daemon.next().await else {
            panic!("an update");
        };
        assert_eq!(*update, Update::Done { id: 7 });
        drop(peer);
        assert!(matches!(daemon.next().await, News::Lost));
        assert!(matches!(daemon.next().await, News::Connected));
        std::fs::remove_file(path).ok(); // The system's folder is cleared anyway.
    }
}
