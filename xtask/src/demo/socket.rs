//! A client of the sockets of the daemon and of the simulator: JSON objects that end with 0x1F.

use anyhow::Context;
use rvac_api::{Request, SEPARATOR};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;

/// The sending half.
#[derive(Debug)]
pub(crate) struct Socket {
    stream: UnixStream,
}

impl Socket {
    /// Connects; each message that arrives is given to `act` in a thread of its own until the other side closes.
    pub(crate) fn open(path: &Path, act: impl FnMut(Value) + Send + 'static) -> anyhow::Result<Self> {
        let stream =
            UnixStream::connect(path).with_context(|| format!("cannot connect to {}", path.display()))?;
        let incoming = stream.try_clone()?;
        std::thread::spawn(move || receive(incoming, act));
        Ok(Self { stream })
    }

    /// Sends a request to the daemon.
    pub(crate) fn ask(&mut self, request: &Request) -> anyhow::Result<()> {
        self.send(&serde_json::to_value(request)?)
    }

    /// Sends a message.
    pub(crate) fn send(&mut self, message: &Value) -> anyhow::Result<()> {
        let mut bytes = serde_json::to_vec(message)?;
        bytes.push(SEPARATOR);
        self.stream
            .write_all(&bytes)
            .context("the other side closed the socket")
    }
}

fn receive(stream: UnixStream, mut act: impl FnMut(Value)) {
    for packet in BufReader::new(stream).split(SEPARATOR) {
        let Ok(packet) = packet else { return };
        if let Ok(message) = serde_json::from_slice(&packet) {
            act(message);
        }
    }
}
