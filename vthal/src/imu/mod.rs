//! A gyro on the Linux board as the robot's heading sensor: an IMU of the kernel's Industrial I/O.
//!
//! A thread finds the sensor, adds up its rate about the robot's vertical axis, and sends the total as events. The
//! sensor's bias is not dealt with here: the brain learns it whenever the wheels rest.

mod device;
mod scan;
mod turn;

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tokio::sync::mpsc::Sender;
use tokio::sync::mpsc::error::TrySendError;

use crate::event::{Event, ReceiverGone};
use device::{Gyro, ImuError, Sample};
use turn::Turn;

/// Totals are sent at most this often: twice for each of the robot's reports.
const SEND_EVERY: Duration = Duration::from_millis(10);
/// Pause before a lost sensor is opened again.
const RETRY: Duration = Duration::from_secs(2);

/// Which sensor and how it is mounted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImuSettings {
    /// Name as the kernel gives it (`mpu6050`), or its number (`iio:device0`).
    pub device: String,
    /// The sensor's axis that points up.
    pub axis: Axis,
    /// Where the kernel's files are.
    pub roots: Roots,
}

/// An axis of the sensor that is the robot's vertical, up (turns are positive counter-clockwise) or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    letter: char,
    down: bool,
}

impl Axis {
    /// The axis with this name: `x`, `y`, `z`, or with a minus sign when it points down.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let (letter, down) = name.strip_prefix('-').map_or((name, false), |rest| (rest, true));
        match letter {
            "x" | "y" | "z" => Some(Self {
                letter: letter.chars().next()?,
                down,
            }),
            _ => None,
        }
    }

    const fn letter(self) -> char {
        self.letter
    }

    const fn sign(self) -> f64 {
        if self.down { -1.0 } else { 1.0 }
    }
}

/// Where the kernel's files are: `/sys` and `/dev`, or copies of them in a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Roots {
    sys: PathBuf,
    dev: PathBuf,
}

impl Default for Roots {
    fn default() -> Self {
        Self::new(Path::new("/sys"), Path::new("/dev"))
    }
}

impl Roots {
    /// Other places than the usual ones.
    #[must_use]
    pub fn new(sys: &Path, dev: &Path) -> Self {
        Self {
            sys: sys.to_owned(),
            dev: dev.to_owned(),
        }
    }

    fn devices(&self) -> PathBuf {
        self.sys.join("bus/iio/devices")
    }

    fn dev(&self) -> &Path {
        &self.dev
    }
}

/// From the sensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ImuEvent {
    /// The sensor is open; how it is read.
    Opened(&'static str),
    /// Total turned, microradians, wrapping.
    Turned(i32),
    /// The sensor is not there or was lost; each cause is reported once per outage, with what to do.
    Absent(String),
}

/// Starts the thread. It ends when the daemon's event queue closes.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(settings: ImuSettings, events: Sender<Event>) -> io::Result<()> {
    std::thread::Builder::new()
        .name("imu".to_owned())
        .spawn(move || serve(&settings, &events))
        .map(drop)
}

fn serve(settings: &ImuSettings, events: &Sender<Event>) {
    let mut turn = Turn::default();
    let mut reported = None;
    loop {
        match attend(settings, &mut turn, events, &mut reported) {
            Ok(ReceiverGone) => return,
            Err(error) if reported.as_ref() == Some(&error.to_string()) => {}
            Err(error) => {
                let text = error.to_string();
                reported = Some(text.clone());
                if events.blocking_send(Event::Imu(ImuEvent::Absent(text))).is_err() {
                    return;
                }
            }
        }
        turn.interrupt();
        // The thread has nothing else to do; a sensor that was pulled is not back sooner.
        std::thread::sleep(RETRY);
    }
}

fn attend(
    settings: &ImuSettings,
    turn: &mut Turn,
    events: &Sender<Event>,
    reported: &mut Option<String>,
) -> Result<ReceiverGone, ImuError> {
    let mut gyro = Gyro::open(settings)?;
    let start = Instant::now();
    let mut sent: Option<Instant> = None;
    loop {
        let mut total_urad = None;
        gyro.read(|sample| total_urad = Some(take(turn, sample, start)))?;
        if reported.take().is_some() || sent.is_none() {
            let opened = Event::Imu(ImuEvent::Opened(gyro.manner()));
            if events.blocking_send(opened).is_err() {
                return Ok(ReceiverGone);
            }
        }
        let due = sent.is_none_or(|sent| sent.elapsed() >= SEND_EVERY);
        let Some(total_urad) = total_urad.filter(|_| due) else {
            continue;
        };
        sent = Some(Instant::now());
        // Of totals only the newest counts: a loop that is busy gets the next one.
        let event = Event::Imu(ImuEvent::Turned(total_urad));
        if let Err(TrySendError::Closed(_)) = events.try_send(event) {
            return Ok(ReceiverGone);
        }
    }
}

fn take(turn: &mut Turn, sample: Sample, start: Instant) -> i32 {
    let arrived_ns = || i64::try_from(start.elapsed().as_nanos()).unwrap_or(i64::MAX);
    turn.take(sample.time_ns.unwrap_or_else(arrived_ns), sample.rate_rad_per_s)
}

#[cfg(test)]
mod tests;
