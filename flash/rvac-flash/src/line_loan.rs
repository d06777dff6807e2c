//! The daemon lends its line: asked over its socket, and given back when this program's connection ends.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::fs::{FlockOperation, flock};
use rvac_api::{Failure, Request, RequestBody, SEPARATOR, Update};

/// The daemon closes its device at once; it may be busy for a moment.
const CLOSE_WAIT: Duration = Duration::from_secs(5);
/// How long its answer may take.
const ANSWER_WAIT: Duration = Duration::from_secs(5);
/// A message of the daemon is shorter.
const MESSAGE_BYTES_MAX: usize = 1 << 20;
const NUMBER: u32 = 1;

/// The line, as long as this lives.
#[derive(Debug)]
pub(crate) struct LineLoan {
    _daemon: Option<UnixStream>,
    _lock: Option<File>,
}

/// Why the line is not ours.
#[derive(Debug, thiserror::Error)]
pub enum LoanError {
    /// No daemon answers.
    #[error(
        "the daemon does not answer at {}: {error}. It knows whether the robot stands on its dock. If it does not run, look at the \
         robot and say --robot-is-silent", .socket.display()
    )]
    NoDaemon {
        /// Its socket.
        socket: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// The daemon refuses.
    #[error("{}", .0.text)]
    Refused(Failure),
    /// The device is locked by another program.
    #[error("{} is still used by another program", .0.display())]
    InUse(PathBuf),
    /// The device cannot be opened.
    #[error("{}: {error}", .device.display())]
    Device {
        /// Which.
        device: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
}

/// Whether the robot can be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotAnswers {
    /// The daemon knows where it stands.
    Expected,
    /// It is silent, and the owner has looked.
    Silent,
}

impl LineLoan {
    /// Borrows the line.
    pub(crate) fn take(socket: &Path, device: &Path, answers: RobotAnswers) -> Result<Self, LoanError> {
        let daemon = match UnixStream::connect(socket) {
            Ok(stream) => Some(ask(stream, socket, answers)?),
            Err(_) if answers == RobotAnswers::Silent => None,
            Err(error) => {
                return Err(LoanError::NoDaemon {
                    socket: socket.to_owned(),
                    error,
                });
            }
        };
        Ok(Self {
            _daemon: daemon,
            _lock: lock(device)?,
        })
    }
}

fn ask(mut stream: UnixStream, socket: &Path, answers: RobotAnswers) -> Result<UnixStream, LoanError> {
    let silent = answers == RobotAnswers::Silent;
    let hello = RequestBody::Hello {
        name: "rvac flash".to_owned(),
    };
    let requests = [(None, hello), (Some(NUMBER), RequestBody::BorrowLink { silent })];
    let answer = exchange(&mut stream, requests).map_err(|error| LoanError::NoDaemon {
        socket: socket.to_owned(),
        error,
    })?;
    match answer {
        Ok(()) => Ok(stream),
        Err(failure) => Err(LoanError::Refused(failure)),
    }
}

/// Sends the requests and waits for the answer to the numbered one.
fn exchange(
    stream: &mut UnixStream,
    requests: [(Option<u32>, RequestBody); 2],
) -> std::io::Result<Result<(), Failure>> {
    stream.set_read_timeout(Some(ANSWER_WAIT))?;
    for (id, body) in requests {
        let mut bytes = serde_json::to_vec(&Request { id, body })?;
        bytes.push(SEPARATOR);
        stream.write_all(&bytes)?;
    }
    let mut received = Vec::new();
    let mut chunk = [0; 4096];
    loop {
        while let Some(end) = received.iter().position(|byte| *byte == SEPARATOR) {
            let message: Vec<u8> = received.drain(..=end).collect();
            match serde_json::from_slice(message.get(..end).unwrap_or_default()) {
                Ok(Update::Done { id: NUMBER }) => return Ok(Ok(())),
                Ok(Update::Failed(failure)) if failure.id == Some(NUMBER) => return Ok(Err(failure)),
                _ => {}
            }
        }
        let count = stream.read(&mut chunk)?;
        if count == 0 || received.len() > MESSAGE_BYTES_MAX {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        received.extend_from_slice(chunk.get(..count).unwrap_or_default());
    }
}

/// The lock that the daemon holds while it has the device open: when it is ours, the daemon has let go. A device that does not exist
/// needs none: the programming port of the SR8730 works without it.
fn lock(device: &Path) -> Result<Option<File>, LoanError> {
    let failed = |error| LoanError::Device {
        device: device.to_owned(),
        error,
    };
    let file = match File::open(device) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        outcome => outcome.map_err(failed)?,
    };
    let deadline = Instant::now() + CLOSE_WAIT;
    while flock(&file, FlockOperation::NonBlockingLockExclusive).is_err() {
        if Instant::now() >= deadline {
            return Err(LoanError::InUse(device.to_owned()));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(Some(file))
}
