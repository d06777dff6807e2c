//! A client of the daemon's socket, with deadlines.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use rvac_api::{SEPARATOR, Update};

/// A connected client.
#[derive(Debug)]
pub struct Client {
    pub stream: UnixStream,
    incoming: Vec<u8>,
}

impl Client {
    /// Connects.
    pub fn connect(socket: &Path) -> io::Result<Self> {
        Ok(Self {
            stream: UnixStream::connect(socket)?,
            incoming: Vec::new(),
        })
    }

    /// Connects and follows topics, for example `["status","log"]`.
    pub fn watching(socket: &Path, topics: &str) -> io::Result<Self> {
        let mut client = Self::connect(socket)?;
        client.send(&format!(r#"{{"c":"watch","topics":{topics}}}"#))?;
        Ok(client)
    }

    /// Sends one message.
    pub fn send(&mut self, message: &str) -> io::Result<()> {
        let mut bytes = message.as_bytes().to_vec();
        bytes.push(SEPARATOR);
        self.stream.write_all(&bytes)
    }

    /// The next message as text; `None` when the deadline is over or the daemon hung up.
    pub fn next(&mut self, deadline: Instant) -> io::Result<Option<String>> {
        loop {
            if let Some(end) = self.incoming.iter().position(|byte| *byte == SEPARATOR) {
                let packet: Vec<u8> = self.incoming.drain(..=end).collect();
                let text = packet.get(..end).unwrap_or_default();
                return Ok(Some(String::from_utf8_lossy(text).into_owned()));
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            self.stream
                .set_read_timeout(Some(left.max(Duration::from_millis(1))))?;
            let mut bytes = [0; 16 << 10];
            match self.stream.read(&mut bytes) {
                Ok(0) => return Ok(None),
                Ok(count) => self
                    .incoming
                    .extend_from_slice(bytes.get(..count).unwrap_or_default()),
                Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                }
                Err(error) if error.kind() == io::ErrorKind::ConnectionReset => return Ok(None),
                Err(error) => return Err(error),
            }
        }
    }

    /// Presses Stop, and gives after what time that was answered.
    ///
    /// # Errors
    /// It was not answered in so much time, or the daemon hung up.
    pub fn press_stop(&mut self, id: u32, patience: Duration) -> io::Result<Duration> {
        let pressed = Instant::now();
        self.send(&format!(r#"{{"c":"stop","id":{id}}}"#))?;
        let is_done = |update: &Update| matches!(update, Update::Done { id: done } if *done == id);
        let done = self.wait_for(pressed + patience, is_done)?;
        done.map(|_| pressed.elapsed())
            .ok_or_else(|| io::Error::other(format!("stop {id} was not answered")))
    }

    /// Reads until a message fits; `None` when the deadline is over first.
    pub fn wait_for(
        &mut self,
        deadline: Instant,
        mut fits: impl FnMut(&Update) -> bool,
    ) -> io::Result<Option<Update>> {
        while let Some(text) = self.next(deadline)? {
            if let Ok(update) = serde_json::from_str::<Update>(&text)
                && fits(&update)
            {
                return Ok(Some(update));
            }
        }
        Ok(None)
    }
}
