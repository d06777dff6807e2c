//! Clients that only count telemetry packets.

use std::io::Read;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use anyhow::bail;
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use vthal_bench::Client;

/// What marks a telemetry packet, in both relays' output.
const MARK: &[u8] = b"state";
/// Within so many of its first bytes a telemetry packet has its mark.
const HEAD: usize = 80;

/// One client.
pub(crate) struct Reader {
    stream: UnixStream,
    /// Telemetry packets that came.
    pub(crate) packets: u64,
    /// The head of the packet that is coming.
    part: Vec<u8>,
}

impl Reader {
    /// Connects and sends `request`, if any.
    pub(crate) fn connect(socket: &Path, request: Option<&str>) -> anyhow::Result<Self> {
        let mut client = Client::connect(socket)?;
        if let Some(request) = request {
            client.send(request)?;
        }
        client.stream.set_nonblocking(true)?;
        Ok(Self {
            stream: client.stream,
            packets: 0,
            part: Vec::new(),
        })
    }

    fn read(&mut self) -> anyhow::Result<()> {
        let mut bytes = [0; 64 << 10];
        match self.stream.read(&mut bytes) {
            Ok(0) => bail!("the relay hung up"),
            Ok(count) => self.count(bytes.get(..count).unwrap_or_default()),
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    fn count(&mut self, bytes: &[u8]) {
        for piece in bytes.split_inclusive(|byte| *byte == rvac_api::SEPARATOR) {
            let room = HEAD.saturating_sub(self.part.len());
            self.part.extend(piece.iter().take(room));
            if piece.ends_with(&[rvac_api::SEPARATOR]) {
                self.packets += u64::from(self.part.windows(MARK.len()).any(|window| window == MARK));
                self.part.clear();
            }
        }
    }
}

/// Reads whatever comes within `pause`, from whomever; gives whether anything came.
pub(crate) fn read_ready(readers: &mut [&mut Reader], pause: Duration) -> anyhow::Result<bool> {
    let timeout = Timespec::try_from(pause).unwrap_or_default();
    let ready: Vec<bool> = {
        let mut polled: Vec<PollFd<'_>> = readers
            .iter()
            .map(|reader| PollFd::new(&reader.stream, PollFlags::IN))
            .collect();
        poll(&mut polled, Some(&timeout))?;
        polled.iter().map(|polled| !polled.revents().is_empty()).collect()
    };
    for (reader, _) in readers.iter_mut().zip(&ready).filter(|(_, ready)| **ready) {
        reader.read()?;
    }
    Ok(ready.contains(&true))
}
