//! The serial line: opened for ever, read and written by one task that turns it into events.

use std::io;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::fs::{FlockOperation, Mode, OFlags, flock};
use serial2_tokio::{SerialPort, Settings};
use tokio::sync::mpsc::{Receiver, Sender};
use tokio::sync::watch;
use vthal_core::device::Opening;
use vthal_core::{LineHolder, LinkLoss};

use crate::event::{Event, SerialEvent};
use crate::serial_identity::{BY_ID, SerialIdentity, links};

/// First pause after a failure to open; it doubles up to [`PAUSE_MAX`].
const PAUSE_MIN: Duration = Duration::from_millis(20);
/// Longest pause between two attempts to open.
const PAUSE_MAX: Duration = Duration::from_secs(2);
/// Bytes that wait for a line which does not take them, before newer ones stay in the queue.
const PENDING_MAX: usize = 4096;
/// More than one packet at full rate; a pseudo terminal hands out at most this much at once.
const READ_SIZE: usize = 4096;

/// Which device and how fast.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SerialSettings {
    /// Path of the device; may appear later.
    pub path: PathBuf,
    /// Bits per second.
    pub baud: u32,
}

/// The line to the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RobotLine {
    /// Path of the device; may appear later.
    pub path: PathBuf,
    /// Rates that are tried in turn, bits per second.
    pub rates_baud: Vec<u32>,
    /// What the make of the robot asks for before the first byte.
    pub opening: Opening,
}

/// For the task that serves the line.
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
    /// Whose the line is: nobody but the daemon opens it while it is the daemon's.
    pub holder: watch::Receiver<LineHolder>,
}

impl LineOrders {
    /// Waits until the line is the daemon's, or a client's.
    async fn await_holder(&mut self, wanted: LineHolder) {
        if self.holder.wait_for(|holder| *holder == wanted).await.is_err() {
            // The daemon ends, and nobody lends a line any more.
            std::future::pending::<()>().await;
        }
    }
}

/// Serves the device until the daemon's event queue closes: opens it, passes bytes in both directions, and begins again when it is
/// lost. Each cause of an outage is reported once. While the line is lent to a client, it is closed.
pub(crate) async fn serve(robot: RobotLine, events: Sender<Event>, mut orders: LineOrders) {
    let mut rates = robot.rates_baud.iter().copied().cycle();
    let mut settings = SerialSettings {
        path: robot.path.clone(),
        baud: rates.next().unwrap_or_default(),
    };
    let mut pause = PAUSE_MIN;
    let mut reported: Option<String> = None;
    let mut identity = None;
    loop {
        orders.await_holder(LineHolder::Daemon).await;
        let event = match open_to_robot(&settings, robot.opening).await {
            Ok(line) => {
                reported = None;
                identity = SerialIdentity::of(&settings.path, Path::new(BY_ID)).or(identity);
                drain(&mut orders.to_robot);
                if events.send(Event::Serial(SerialEvent::Opened)).await.is_err() {
                    return;
                }
                let (end, read_any) = pass_bytes(&line.port, &events, &mut orders).await;
                if read_any {
                    pause = PAUSE_MIN;
                }
                Some(SerialEvent::Closed(match end {
                    LineEnd::Lost(reason) => reason,
                    LineEnd::NextRate => {
                        let baud = settings.baud;
                        settings.baud = rates.next().unwrap_or(baud);
                        LinkLoss::NoAnswer { baud }
                    }
                }))
            }
            Err(error) => {
                settings.path = path_now(&robot.path, identity.as_ref());
                // A cause that changes while the line is away is news.
                let text = error.to_string();
                let is_news = reported.as_ref() != Some(&text);
                is_news.then(|| {
                    reported = Some(text);
                    SerialEvent::Absent(error)
                })
            }
        };
        if let Some(event) = event
            && events.send(Event::Serial(event)).await.is_err()
        {
            return;
        }
        tokio::time::sleep(pause).await;
        pause = (pause * 2).min(PAUSE_MAX);
    }
}

/// Where the robot's adapter is: where it was configured, or under the name that it has now.
fn path_now(configured: &Path, identity: Option<&SerialIdentity>) -> PathBuf {
    let moved = identity.and_then(|identity| identity.elsewhere(configured));
    let Some(moved) = moved.filter(|_| !configured.exists()) else {
        return configured.to_owned();
    };
    tracing::warn!(
        part = "link",
        "{} is gone, and the same adapter is {} now: it is used there; set link.serial to its name in {BY_ID}, which does not change",
        configured.display(),
        moved.display()
    );
    moved
}

/// Opens the device and wakes the robot at its other end, if it needs that.
async fn open_to_robot(settings: &SerialSettings, opening: Opening) -> Result<Line, OpenError> {
    let line = open(settings)?;
    wake(&line.port, opening).await.map_err(|error| OpenError::Open {
        path: settings.path.clone(),
        error,
    })?;
    Ok(line)
}

async fn wake(port: &SerialPort, opening: Opening) -> io::Result<()> {
    if opening.wake_pulse_ms > 0 {
        // An asserted line is low at the plug.
        port.set_rts(true)?;
        tokio::time::sleep(Duration::from_millis(opening.wake_pulse_ms.into())).await;
        port.set_rts(false)?;
    }
    if opening.settle_ms > 0 {
        tokio::time::sleep(Duration::from_millis(opening.settle_ms.into())).await;
    }
    Ok(())
}

/// Bytes for a robot that was lost must not reach the next one.
fn drain(to_robot: &mut Receiver<LineOrder>) {
    while to_robot.try_recv().is_ok() {}
}

/// An open line. The lock is advisory and dies with the process, however that ends; it has a handle of its own because the
/// port keeps its only one.
pub(crate) struct Line {
    /// Reads and writes.
    pub port: SerialPort,
    _lock: OwnedFd,
}

/// Locks the device against a second daemon, then sets raw mode at the configured rate.
pub(crate) fn open(settings: &SerialSettings) -> Result<Line, OpenError> {
    let path = settings.path.as_path();
    let refused = |error: io::Error| OpenError::Open {
        path: path.to_owned(),
        error,
    };
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let lock = rustix::fs::open(path, flags, Mode::empty()).map_err(|error| refused(error.into()))?;
    flock(&lock, FlockOperation::NonBlockingLockExclusive).map_err(|_| OpenError::InUse(path.to_owned()))?;
    let port = SerialPort::open(path, |mut line: Settings| {
        line.set_raw();
        line.set_baud_rate(settings.baud)?;
        Ok(line)
    })
    .map_err(refused)?;
    Ok(Line { port, _lock: lock })
}

/// Why the device is not open.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OpenError {
    /// The system refuses.
    #[error("cannot open the serial device {}: {error}; waiting for it{}", .path.display(), others(.path))]
    Open {
        /// The device.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// Another program has locked it.
    #[error("the serial device {} is locked by another program; waiting for it", .0.display())]
    InUse(PathBuf),
}

/// Names the adapters that there are, for whoever configured another one.
fn others(path: &Path) -> String {
    let links = if path.exists() {
        Vec::new()
    } else {
        links(Path::new(BY_ID))
    };
    let names: Vec<String> = links.iter().map(|link| link.display().to_string()).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(" (there is: {})", names.join(", "))
    }
}

/// Why bytes pass no longer.
enum LineEnd {
    /// The line is lost.
    Lost(LinkLoss),
    /// It is to be opened at another rate.
    NextRate,
}

async fn pass_bytes(port: &SerialPort, events: &Sender<Event>, orders: &mut LineOrders) -> (LineEnd, bool) {
    let mut buffer = [0; READ_SIZE];
    let mut pending = Vec::new();
    let mut read_any = false;
    let LineOrders { to_robot, holder } = orders;
    loop {
        tokio::select! {
            Ok(_) = holder.wait_for(|holder| *holder == LineHolder::Client) => {
                return (LineEnd::Lost(LinkLoss::Lent), read_any);
            }
            read = port.read(&mut buffer) => match read {
                Ok(0) => return (LineEnd::Lost(LinkLoss::HungUp), read_any),
                Ok(count) => {
                    read_any = true;
                    let bytes = buffer.get(..count).unwrap_or_default().to_vec();
                    if events.send(Event::Serial(SerialEvent::Bytes(bytes))).await.is_err() {
                        return (LineEnd::Lost(LinkLoss::HungUp), read_any);
                    }
                }
                Err(error) => return (loss_of(&error), read_any),
            },
            written = port.write(&pending), if !pending.is_empty() => match written {
                Ok(count) => { pending.drain(..count); }
                Err(error) => return (loss_of(&error), read_any),
            },
            Some(order) = to_robot.recv(), if pending.len() < PENDING_MAX => match order {
                LineOrder::Send(bytes) => pending.extend_from_slice(&bytes),
                LineOrder::NextRate => return (LineEnd::NextRate, read_any),
            },
        }
    }
}

/// A pseudo terminal whose other end closes gives EIO, an adapter that is pulled ENXIO or ENODEV.
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
