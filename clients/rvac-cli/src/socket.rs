//! The daemon's socket: JSON objects, each ended by 0x1F.

use std::io::{ErrorKind, Read as _, Write as _};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use rvac_api::{Request, RequestBody, SEPARATOR, Topic, Update};

use crate::arguments::Daemon;
use crate::plain::{plain, plain_json};
use crate::remote::{self, Address};

/// A message longer than this is no message of ours.
const MESSAGE_BYTES_MAX: usize = 64 << 20;

/// A connection to vthal.
#[derive(Debug)]
pub(crate) struct Connection {
    stream: UnixStream,
    received: Vec<u8>,
}

/// One message as it came, and its content if this program knows its kind.
#[derive(Debug)]
pub(crate) struct Message {
    pub(crate) text: String,
    pub(crate) update: Option<Update>,
}

impl Connection {
    /// Connects to the daemon, here or on the network, and introduces this program.
    pub(crate) fn open(daemon: &Daemon) -> anyhow::Result<Self> {
        match &daemon.robot {
            Some(robot) => Self::open_there(robot),
            None => Self::open_here(&daemon.socket),
        }
    }

    /// Connects to the daemon of a robot on the network.
    pub(crate) fn open_there(robot: &Address) -> anyhow::Result<Self> {
        Self::introduced(remote::connect(robot)?)
    }

    /// Connects to the daemon of this computer.
    pub(crate) fn open_here(path: &Path) -> anyhow::Result<Self> {
        let stream = UnixStream::connect(path).with_context(|| {
            format!(
                "cannot reach vthal at {}: is it running? (--socket names another place)",
                path.display()
            )
        })?;
        Self::introduced(stream)
    }

    fn introduced(stream: UnixStream) -> anyhow::Result<Self> {
        let mut connection = Self {
            stream,
            received: Vec::new(),
        };
        connection.send(&Request {
            id: None,
            body: RequestBody::Hello {
                name: "rvac".to_owned(),
            },
        })?;
        Ok(connection)
    }

    /// A second handle for another thread. What is already received stays with the first.
    pub(crate) fn sender(&self) -> anyhow::Result<Self> {
        Ok(Self {
            stream: self.stream.try_clone()?,
            received: Vec::new(),
        })
    }

    pub(crate) fn send(&mut self, request: &Request) -> anyhow::Result<()> {
        let mut bytes = serde_json::to_vec(request)?;
        bytes.push(SEPARATOR);
        self.stream
            .write_all(&bytes)
            .context("vthal has closed the connection")
    }

    pub(crate) fn watch(&mut self, topics: Vec<Topic>) -> anyhow::Result<()> {
        self.send(&Request {
            id: None,
            body: RequestBody::Watch { topics },
        })
    }

    /// The next message, however long it takes.
    pub(crate) fn receive(&mut self) -> anyhow::Result<Message> {
        self.stream.set_read_timeout(None)?;
        match self.receive_some()? {
            Some(message) => Ok(message),
            None => bail!("vthal gave no answer"),
        }
    }

    /// The next message, or `None` when `deadline` comes first.
    pub(crate) fn receive_until(&mut self, deadline: Instant) -> anyhow::Result<Option<Message>> {
        let left = deadline.saturating_duration_since(Instant::now());
        self.stream
            .set_read_timeout(Some(left.max(Duration::from_millis(1))))?;
        self.receive_some()
    }

    fn receive_some(&mut self) -> anyhow::Result<Option<Message>> {
        let mut chunk = [0; 16_384];
        loop {
            if let Some(end) = self.received.iter().position(|byte| *byte == SEPARATOR) {
                let rest = self.received.split_off(end + 1);
                let mut message = std::mem::replace(&mut self.received, rest);
                message.truncate(end);
                return Ok(Some(parse(&message)));
            }
            if self.received.len() > MESSAGE_BYTES_MAX {
                bail!("vthal sent a message of more than {MESSAGE_BYTES_MAX} bytes");
            }
            match self.stream.read(&mut chunk) {
                Ok(0) => bail!("vthal has closed the connection"),
                Ok(count) => self.received.extend_from_slice(&chunk[..count]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return Ok(None);
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error).context("the connection to vthal broke"),
            }
        }
    }
}

fn parse(message: &[u8]) -> Message {
    let text = plain(&String::from_utf8_lossy(message));
    // Without an escape there is nothing more to take out.
    let update = if text.contains('\\') {
        let value = serde_json::from_str(&text).map(plain_json);
        value.and_then(serde_json::from_value).ok()
    } else {
        serde_json::from_str(&text).ok()
    };
    Message { text, update }
}

#[cfg(test)]
mod tests {
    use rvac_api::Update;

    use super::parse;

    #[test]
    fn no_text_of_a_robot_orders_the_terminal_about() {
        let line =
            r#"{"e":"log","number":1,"t":0.5,"level":"warn","part":"robot","text":"\u001b[2J<b>\u0007 ok"}"#;
        let told = parse(line.as_bytes());
        assert_eq!(told.text, line, "escapes of JSON are text already");
        let Some(Update::Log(entry)) = told.update else {
            panic!("{told:?}");
        };
        assert_eq!(entry.text, "\u{fffd}[2J<b>\u{fffd} ok");
        let raw = parse("{\"e\":\"log\",\"text\":\"\u{9b}31m\"}".as_bytes());
        assert!(!raw.text.contains('\u{9b}'));
    }
}
