//! Daemon and panel of this board, and whether they answer.

use std::io::{Read as _, Write as _};
use std::net::{Ipv4Addr, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use rvac_api::{Activity, Request, RequestBody, SEPARATOR, Topic, Update};

use crate::board::{Board, BoardError, Health};

/// One look.
const LOOK: Duration = Duration::from_secs(3);
const PAUSE: Duration = Duration::from_millis(500);
/// The first message of the daemon is shorter.
const MESSAGE_BYTES_MAX: usize = 1 << 20;

/// How programs are started again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Restart {
    /// By this command.
    Command(Vec<String>),
    /// Not at all: the board starts, and they come afterwards.
    Later,
}

/// The programs on this board.
#[derive(Clone, Debug)]
pub(crate) struct Services {
    pub(crate) restart: Restart,
    pub(crate) socket: PathBuf,
    /// Port of the panel's plain page; none without a panel.
    pub(crate) page_port: Option<u16>,
    /// A panel makes its certificate at its first start, and a robot greets within seconds.
    pub(crate) patience: Duration,
}

/// What the daemon says when it is greeted.
pub(crate) struct Greeting {
    /// The robot's name for itself, if one answers it.
    pub(crate) robot: Option<String>,
}

impl Board for Services {
    fn restart(&mut self) -> Result<(), BoardError> {
        let Restart::Command(words) = &self.restart else {
            return Ok(());
        };
        let command = words.join(" ");
        let Some((program, arguments)) = words.split_first() else {
            return Ok(());
        };
        match Command::new(program).args(arguments).status() {
            Err(error) => Err(BoardError::Command { command, error }),
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(BoardError::Status {
                command,
                status: status.to_string(),
            }),
        }
    }

    fn works(&mut self) -> bool {
        let watch = RequestBody::Watch {
            topics: vec![Topic::Status],
        };
        let state = self.ask(watch, |update| match update {
            Update::Status(status) => Some(Activity::from_name(&status.state)),
            _ => None,
        });
        // A daemon that does not answer moves nothing.
        state.flatten().is_some_and(Activity::moves)
    }

    fn look(&mut self) -> Health {
        let greeting = self.greet();
        Health {
            daemon: greeting.is_some(),
            robot: greeting.is_some_and(|greeting| greeting.robot.is_some()),
            panel: self.page_port.is_some_and(has_page),
        }
    }

    fn wait_for(&mut self, wanted: Health) -> Health {
        let deadline = Instant::now() + self.patience;
        loop {
            let health = self.look();
            if health.covers(wanted) || Instant::now() >= deadline {
                return health;
            }
            std::thread::sleep(PAUSE);
        }
    }
}

impl Services {
    /// What the daemon says; nothing if none answers.
    pub(crate) fn greet(&self) -> Option<Greeting> {
        let hello = RequestBody::Hello {
            name: "rvac update".to_owned(),
        };
        self.ask(hello, |update| match update {
            Update::Hello { robot, .. } => Some(Greeting {
                robot: robot.map(|robot| robot.device),
            }),
            _ => None,
        })
    }

    /// Asks the daemon and waits for the answer that is wanted.
    fn ask<T>(&self, body: RequestBody, wanted: impl Fn(Update) -> Option<T>) -> Option<T> {
        let mut stream = UnixStream::connect(&self.socket).ok()?;
        stream.set_read_timeout(Some(LOOK)).ok()?;
        let mut bytes = serde_json::to_vec(&Request { id: None, body }).ok()?;
        bytes.push(SEPARATOR);
        stream.write_all(&bytes).ok()?;
        let mut received = Vec::new();
        let mut chunk = [0; 4096];
        loop {
            while let Some(end) = received.iter().position(|byte| *byte == SEPARATOR) {
                let message: Vec<u8> = received.drain(..=end).collect();
                let message = message.get(..end).unwrap_or_default();
                if let Some(answer) = serde_json::from_slice(message).ok().and_then(&wanted) {
                    return Some(answer);
                }
            }
            let count = stream.read(&mut chunk).ok()?;
            if count == 0 || received.len() > MESSAGE_BYTES_MAX {
                return None;
            }
            received.extend_from_slice(chunk.get(..count).unwrap_or_default());
        }
    }
}

/// Whether the plain page is there: it needs no certificate.
fn has_page(port: u16) -> bool {
    page(port).is_some_and(|answer| answer.starts_with(b"HTTP/1.1 200"))
}

fn page(port: u16) -> Option<Vec<u8>> {
    let address = (Ipv4Addr::LOCALHOST, port).into();
    let mut stream = TcpStream::connect_timeout(&address, LOOK).ok()?;
    stream.set_read_timeout(Some(LOOK)).ok()?;
    stream
        .write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        .ok()?;
    let mut answer = vec![0; 12];
    stream.read_exact(&mut answer).ok()?;
    Some(answer)
}
