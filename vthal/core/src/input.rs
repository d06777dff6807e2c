//! Everything that can happen to the core.

use brain::StoredMap;
use brain::observation::BeaconSignal;
use rvac_api::{DaemonLoad, Failure, LogLevel, Request, Run};

use crate::schedule::ZoneReading;
use crate::{FloorTask, KeptFloor};

/// A connected client, numbered by the shell; numbers are never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClientId(pub u64);

/// The closed set of causes.
#[derive(Clone, Debug, PartialEq)]
pub enum Input<'a> {
    /// The link is open; the core starts the handshake.
    LinkOpened,
    /// Bytes came from the robot.
    LinkBytes(&'a [u8]),
    /// The serial port says that so many of the bytes just told had a framing or parity error, or were a break.
    FramingErrors(u32),
    /// The link is gone.
    LinkClosed {
        /// Why, for the log.
        reason: LinkLoss,
    },
    /// The gyro on the Linux board has turned this far since it was opened.
    BoardHeading {
        /// Microradians counter-clockwise, wrapping.
        heading_urad: i32,
    },
    /// Which buttons of the Linux board are down has changed.
    BoardButtons {
        /// Those that are down, button 0 in bit 0.
        down: u8,
    },
    /// A radio on the Linux board measured how far a beacon is, or how strongly it is received.
    Beacon(BeaconSignal),
    /// The shell has warned or complained of something in its own log: clients read it too.
    Told {
        /// How grave.
        level: LogLevel,
        /// The sentence.
        text: String,
    },
    /// A client connected.
    ClientConnected(ClientId),
    /// A client asks for something.
    Client {
        /// Who.
        client: ClientId,
        /// What.
        request: Request,
    },
    /// The shell cannot do what a client asks for; the core informs the client and the log.
    Refused {
        /// Who.
        client: ClientId,
        /// Why.
        failure: Failure,
    },
    /// A version of the map of the home was read from the disk and is the newest there now, as
    /// [`crate::MapOrder::Restore`] asked.
    MapRestored {
        /// Floor that it is of.
        floor: u16,
        /// Number that was asked for, for the log.
        number: u64,
        /// The map.
        home: StoredMap,
    },
    /// The floors that are kept after a [`crate::FloorOrder`] was carried out.
    FloorsKept {
        /// What was done.
        task: FloorTask,
        /// All floors.
        floors: Vec<KeptFloor>,
        /// The new floor, if there is one.
        made: Option<u16>,
    },
    /// Floors of an archive are kept beside those that there were.
    FloorsTakenIn {
        /// All floors.
        floors: Vec<KeptFloor>,
        /// Numbers of those that came with the archive.
        taken: Vec<u16>,
    },
    /// The clock on the wall, seconds since 1970 (UTC), at least once a second. It may have been set forward or back.
    WallClock {
        /// What it shows.
        utc_s: i64,
    },
    /// What the daemon takes of its computer, at least once a second.
    Load(DaemonLoad),
    /// What the system says of its time zone, before the first clock and when it has changed. Until then schedules are in UTC.
    SystemZone(ZoneReading),
    /// The schedules of [`crate::Outputs::schedules`] are on the disk, or are not.
    SchedulesKept {
        /// Number of the order.
        number: u64,
        /// Or a sentence with the reason why not.
        result: Result<(), String>,
    },
    /// The loads of [`crate::Outputs::health`] are on the disk, or are not.
    HealthKept {
        /// Number of the order.
        number: u64,
        /// Or a sentence with the reason why not.
        result: Result<(), String>,
    },
    /// What robots have learnt, of [`crate::Outputs::learnt`], is on the disk, or is not.
    LearntKept {
        /// Number of the order.
        number: u64,
        /// Or a sentence with the reason why not.
        result: Result<(), String>,
    },
    /// A client will ask for nothing more, but may listen; a driver's seat it held is empty and the wheels stop.
    ClientSilent(ClientId),
    /// The record of [`crate::Outputs::run`] is on the disk, or is not.
    RunKept {
        /// Number of the run.
        number: u64,
        /// What is kept, or a sentence that says why it is not.
        result: Result<Box<Run>, String>,
    },
    /// The recording of a run has a file.
    RecordingOpened {
        /// Number of the run since the daemon's start, as in [`crate::RunStart`].
        run: u32,
        /// The file's name.
        name: String,
    },
    /// The procedure of [`crate::Outputs::calibration_orders`] has ended, and the robot stands.
    CalibrationOver,
    /// A client is gone; a driver's seat it held is empty and the wheels stop.
    ClientGone(ClientId),
    /// The time that [`crate::Core::next_wake_us`] named has come. Too early or too often does no harm.
    Wake,
    /// The daemon is about to end: the wheels are stopped. It may close the link once [`crate::Core::stands_still`].
    Shutdown,
}

/// Why the link is gone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkLoss {
    /// The other end hung up or the adapter was pulled.
    HungUp,
    /// No robot answers at this rate, as [`crate::Outputs::next_rate`] said.
    NoAnswer {
        /// Bits per second.
        baud: u32,
    },
    /// It is lent to a client, as [`crate::Outputs::line_holder`] said.
    Lent,
    /// Reading or writing failed.
    Failed(String),
}
