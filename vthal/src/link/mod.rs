//! The link to the robot, whatever it is made of: opened for ever, read and written by one task that turns it into events.

mod clocked;
mod line_marks;
mod moved;
mod network;
mod opening;
mod pair_driver;
mod shared_wire;

use std::future::poll_fn;
use std::io;
use std::pin::Pin;
use std::task::Poll;
use std::time::Duration;

use robot_link::LinkAddress;
use tokio::io::{AsyncReadExt, AsyncWrite};
use tokio::sync::mpsc::{Receiver, Sender};
use tokio::sync::watch;
use vthal_core::device::Opening;
use vthal_core::{LineHolder, LinkLoss};

use crate::event::{Event, LinkEvent};
use crate::serial_identity::BY_ID;

use line_marks::{LineMarks, Unmarked};
use moved::Moved;
use opening::open_to_robot;
pub(crate) use opening::{Link, LinkOpenError};

/// First pause after a failure to open; it doubles up to [`PAUSE_MAX`].
const PAUSE_MIN: Duration = Duration::from_millis(20);
/// Longest pause between two attempts to open.
const PAUSE_MAX: Duration = Duration::from_secs(2);
/// Bytes that wait for a link which does not take them, before newer ones stay in the queue.
const PENDING_MAX: usize = 4096;
/// More than one packet at full rate; a pseudo terminal hands out at most this much at once.
const READ_SIZE: usize = 4096;

/// The robot at the other end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RobotLine {
    /// Where it is; may appear later.
    pub address: LinkAddress,
    /// Rates that are tried in turn, bits per second; only a UART has them.
    pub rates_baud: Vec<u32>,
    /// What the make of the robot asks for before the first byte.
    pub opening: Opening,
}

/// For the task that serves the link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LineOrder {
    /// Bytes for the robot.
    Send(Vec<u8>),
    /// No robot answers: another rate.
    NextRate,
}

/// What comes to the task from the daemon's core.
#[derive(Debug)]
pub(crate) struct LineOrders {
    /// For the robot, in order.
    pub to_robot: Receiver<LineOrder>,
    /// Whose the link is: nobody but the daemon opens it while it is the daemon's.
    pub holder: watch::Receiver<LineHolder>,
}

impl LineOrders {
    /// Waits until the link is the daemon's, or a client's.
    async fn await_holder(&mut self, wanted: LineHolder) {
        if self.holder.wait_for(|holder| *holder == wanted).await.is_err() {
            // The daemon ends, and nobody lends a link any more.
            std::future::pending::<()>().await;
        }
    }
}

/// Serves the link until the daemon's event queue closes: opens it, passes bytes in both directions, and begins again when it is
/// lost. Each cause of an outage is reported once. While the link is lent to a client, it is closed.
pub(crate) async fn serve(robot: RobotLine, events: Sender<Event>, mut orders: LineOrders) {
    let mut rates = robot.rates_baud.iter().copied().cycle();
    let mut baud = rates.next().unwrap_or_default();
    let mut pause = PAUSE_MIN;
    let mut reported: Option<String> = None;
    let mut place = Moved::new(robot.address.clone(), BY_ID.into());
    loop {
        orders.await_holder(LineHolder::Daemon).await;
        let event = match open_to_robot((place.address(), robot.opening), baud).await {
            Ok(mut link) => {
                reported = None;
                place.opened();
                drain(&mut orders.to_robot);
                let opened = LinkEvent::Opened(link.abilities);
                if events.send(Event::Link(opened)).await.is_err() {
                    return;
                }
                let (end, read_any) = pass_bytes(&mut link, &events, &mut orders).await;
                if read_any {
                    pause = PAUSE_MIN;
                }
                Some(LinkEvent::Closed(match end {
                    LineEnd::Lost(reason) => reason,
                    LineEnd::NextRate => {
                        let silent = baud;
                        baud = rates.next().unwrap_or(silent);
                        LinkLoss::NoAnswer { baud: silent }
                    }
                }))
            }
            Err(error) => {
                place.look();
                // A cause that changes while the link is away is news.
                let text = error.to_string();
                let is_news = reported.as_ref() != Some(&text);
                is_news.then(|| {
                    reported = Some(text);
                    LinkEvent::Absent(error)
                })
            }
        };
        if let Some(event) = event
            && events.send(Event::Link(event)).await.is_err()
        {
            return;
        }
        tokio::time::sleep(pause).await;
        pause = (pause * 2).min(PAUSE_MAX);
    }
}

/// Bytes for a robot that was lost must not reach the next one.
fn drain(to_robot: &mut Receiver<LineOrder>) {
    while to_robot.try_recv().is_ok() {}
}

/// Why bytes pass no longer.
enum LineEnd {
    /// The link is lost.
    Lost(LinkLoss),
    /// It is to be opened at another rate.
    NextRate,
}

async fn pass_bytes(link: &mut Link, events: &Sender<Event>, orders: &mut LineOrders) -> (LineEnd, bool) {
    let mut buffer = [0; READ_SIZE];
    let mut outgoing = Outgoing::default();
    let mut read_any = false;
    let LineOrders { to_robot, holder } = orders;
    let has_rates = link.has_rates;
    let mut marks = link.marks;
    let (mut reader, mut writer) = tokio::io::split(&mut link.stream);
    let end = 'passing: loop {
        tokio::select! {
            Ok(_) = holder.wait_for(|holder| *holder == LineHolder::Client) => break LineEnd::Lost(LinkLoss::Lent),
            read = reader.read(&mut buffer) => match read {
                Ok(0) => break LineEnd::Lost(LinkLoss::HungUp),
                Ok(count) => {
                    read_any = true;
                    for event in received(&mut marks, buffer.get(..count).unwrap_or_default()) {
                        if events.send(Event::Link(event)).await.is_err() {
                            break 'passing LineEnd::Lost(LinkLoss::HungUp);
                        }
                    }
                }
                Err(error) => break loss_of(&error),
            },
            pushed = outgoing.push(&mut writer), if outgoing.has_work() => if let Err(error) = pushed {
                break loss_of(&error);
            },
            Some(order) = to_robot.recv(), if outgoing.has_room() => match order {
                LineOrder::Send(bytes) => outgoing.pending.extend_from_slice(&bytes),
                LineOrder::NextRate if has_rates => break LineEnd::NextRate,
                // Nothing to try: the one who has the rate is at the other end of the cable.
                LineOrder::NextRate => {}
            },
        }
    };
    (link.said_why(end), read_any)
}

/// What a piece that was read says: bytes, and that some of them had errors.
fn received(marks: &mut Option<LineMarks>, piece: &[u8]) -> impl Iterator<Item = LinkEvent> {
    let Unmarked { bytes, errors } = match marks {
        Some(marks) => marks.take_out(piece),
        None => Unmarked {
            bytes: piece.to_vec(),
            errors: 0,
        },
    };
    let bytes = (!bytes.is_empty()).then_some(LinkEvent::Bytes(bytes));
    let errors = (errors > 0).then_some(LinkEvent::FramingErrors(errors));
    bytes.into_iter().chain(errors)
}

impl Link {
    /// A link that something of ours serves ends with what that has met.
    fn said_why(&self, end: LineEnd) -> LineEnd {
        match (end, self.complaint.as_ref().and_then(|told| told.get())) {
            (LineEnd::Lost(LinkLoss::HungUp), Some(complaint)) => {
                LineEnd::Lost(LinkLoss::Failed(complaint.clone()))
            }
            (end, _) => end,
        }
    }
}

/// Bytes on their way into a link.
#[derive(Debug, Default)]
struct Outgoing {
    pending: Vec<u8>,
    /// An encrypted stream keeps bytes back until it is flushed.
    unflushed: bool,
}

impl Outgoing {
    fn has_work(&self) -> bool {
        !self.pending.is_empty() || self.unflushed
    }

    fn has_room(&self) -> bool {
        self.pending.len() < PENDING_MAX
    }

    /// Writes some, or flushes what was written. Nothing is lost or sent twice when this is dropped half-way.
    async fn push(&mut self, writer: &mut (impl AsyncWrite + Unpin)) -> io::Result<()> {
        poll_fn(|context| {
            if !self.pending.is_empty() {
                match Pin::new(&mut *writer).poll_write(context, &self.pending) {
                    Poll::Ready(Ok(count)) => {
                        self.pending.drain(..count);
                        self.unflushed = true;
                        return Poll::Ready(Ok(()));
                    }
                    Poll::Ready(Err(error)) => return Poll::Ready(Err(error)),
                    Poll::Pending => {}
                }
            }
            if self.unflushed {
                let flushed = Pin::new(&mut *writer).poll_flush(context);
                self.unflushed = flushed.is_pending();
                return flushed;
            }
            Poll::Pending
        })
        .await
    }
}

/// A pseudo terminal whose other end closes gives EIO, an adapter that is pulled ENXIO or ENODEV; a network ends in other ways.
fn loss_of(error: &io::Error) -> LineEnd {
    LineEnd::Lost(
        match error.raw_os_error().map(rustix::io::Errno::from_raw_os_error) {
            Some(rustix::io::Errno::IO | rustix::io::Errno::NXIO | rustix::io::Errno::NODEV) => {
                LinkLoss::HungUp
            }
            _ => LinkLoss::Failed(error.to_string()),
        },
    )
}

#[cfg(test)]
mod tests;
