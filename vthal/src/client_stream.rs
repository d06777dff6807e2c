//! A client's socket, which wakes the daemon only for bytes that it can read or write.
//!
//! tokio's own stream asks the system for news of both directions. Each client that reads would wake the daemon then
//! ("there is room again"): fifty times a second for every client, and in the middle of serving the next one.

use std::io::{self, IoSlice, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use tokio::io::Interest;
use tokio::io::unix::AsyncFd;

/// Pause between two checks whether a client that has closed its sending side is still there.
const CLOSED_LOOKS_EVERY: Duration = Duration::from_millis(100);
/// Looks at such a client: three seconds are time for the slowest answer, one that waits for an SD card, and a script that follows
/// something comes to an end.
const CLOSED_LOOKS_MAX: u32 = 30;

/// A connected socket that does not block.
#[derive(Debug)]
pub(crate) struct ClientStream(AsyncFd<UnixStream>);

impl ClientStream {
    /// Takes over a socket that was just accepted.
    ///
    /// # Errors
    /// When the system has no room to watch it.
    pub(crate) fn new(accepted: tokio::net::UnixStream) -> io::Result<Self> {
        watch(accepted.into_std()?, Interest::READABLE).map(Self)
    }

    /// Waits for bytes and takes what fits into `buffer`; 0 when the client hung up.
    ///
    /// # Errors
    /// Those of the system.
    pub(crate) async fn read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0
            .async_io(Interest::READABLE, |mut stream| stream.read(buffer))
            .await
    }

    /// Waits, for a limited time, until the client has gone and no bytes can be written.
    pub(crate) async fn closed(&self) {
        for _ in 0..CLOSED_LOOKS_MAX {
            if self.is_closed() {
                return;
            }
            tokio::time::sleep(CLOSED_LOOKS_EVERY).await;
        }
    }

    /// The system reports HUP only when both directions are closed; polling one direction would not distinguish them.
    fn is_closed(&self) -> bool {
        let mut handle = [PollFd::new(self.0.get_ref(), PollFlags::empty())];
        match poll(&mut handle, Some(&Timespec::default())) {
            Ok(_) => handle
                .iter()
                .any(|handle| handle.revents().intersects(PollFlags::HUP | PollFlags::ERR)),
            Err(rustix::io::Errno::INTR) => false,
            Err(_) => true,
        }
    }

    /// Writes what the socket takes at once.
    ///
    /// # Errors
    /// `WouldBlock` when there is nothing, and the errors of the system.
    pub(crate) fn try_write(&self, slices: &[IoSlice<'_>]) -> io::Result<usize> {
        self.0.get_ref().write_vectored(slices)
    }

    /// Waits until the socket takes bytes again: a second handle is watched for just as long.
    ///
    /// # Errors
    /// When the system has no second handle or no room to watch it.
    pub(crate) async fn writable(&self) -> io::Result<()> {
        let handle = self.0.get_ref().try_clone()?;
        watch(handle, Interest::WRITABLE)?.writable().await.map(drop)
    }
}

#[expect(
    deprecated,
    reason = "its successor is unsafe for types that may change their handle; a UnixStream owns one and keeps it"
)]
fn watch(stream: UnixStream, interest: Interest) -> io::Result<AsyncFd<UnixStream>> {
    AsyncFd::with_interest(stream, interest)
}
