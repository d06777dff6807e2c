//! Everything that can wake the daemon.

use robot_link::Abilities;
use rvac_api::Run;
use tokio::net::UnixStream;
use tokio::sync::OwnedSemaphorePermit;
use vthal_core::schedule::ZoneReading;
use vthal_core::{ClientId, LinkLoss};

use crate::archive_desk::ArchiveAnswer;
use crate::board::BoardEvent;
use crate::calibration_thread::CalibrationEvent;
use crate::checkpoint_thread::{FloorAnswer, MapAnswer, MixAnswer};
use crate::imu::ImuEvent;
use crate::link::LinkOpenError;
use crate::radio::RadioEvent;
use crate::run_thread::RunAnswer;

/// Why a thread or task that sends events ends: the daemon receives none any more.
pub(crate) struct ReceiverGone;

/// The closed set of causes.
#[derive(Debug)]
pub(crate) enum Event {
    /// From the link to the robot.
    Link(LinkEvent),
    /// From the calibration of the robot.
    Calibration(CalibrationEvent),
    /// A client connected.
    Connected(UnixStream),
    /// A client sent bytes, of one request at most. The next ones wait until this event is gone.
    ClientBytes(ClientId, Vec<u8>, OwnedSemaphorePermit),
    /// A client's socket takes bytes again.
    ClientWritable(ClientId),
    /// A client has said its last word and may listen still.
    ClientSilent(ClientId),
    /// A client is gone.
    ClientClosed(ClientId),
    /// From the gyro of the Linux board.
    Imu(ImuEvent),
    /// From the buttons of the Linux board.
    Board(BoardEvent),
    /// From the radio of the Linux board.
    Radio(RadioEvent),
    /// The system's time zone has changed.
    Zone(ZoneReading),
    /// What came of an order for the kept maps.
    Maps(MapAnswer),
    /// What came of an order for the floors.
    Floors(Box<FloorAnswer>),
    /// What came of an order for an archive of floors.
    Archive(Box<ArchiveAnswer>),
    /// What came of an order for the kept control mixes.
    Mixes(MixAnswer),
    /// What a client asked of the kept runs.
    Runs(RunAnswer),
    /// The record of the run with this number is on the disk, or a sentence says why it is not.
    RunKept(u64, Result<Box<Run>, String>),
    /// The recording of a run, by its number since the daemon's start, has this file name.
    RecordingOpened(u32, String),
    /// Loads of motors are on the disk, or a sentence says why they are not.
    Health(u64, Result<(), String>),
    /// What robots have learnt is on the disk, or a sentence says why it is not.
    Learnt(u64, Result<(), String>),
    /// Schedules are on the disk, or a sentence says why they are not.
    Schedules(u64, Result<(), String>),
    /// The core asked to be called now.
    Wake,
    /// systemd wants a sign of life.
    WatchdogDue,
    /// The daemon is ordered to end, by the named signal.
    Terminate(&'static str),
}

/// From the link to the robot.
#[derive(Debug)]
pub(crate) enum LinkEvent {
    /// It is open, and can this.
    Opened(Abilities),
    /// It cannot be opened; reported once per outage.
    Absent(LinkOpenError),
    /// Bytes of the robot.
    Bytes(Vec<u8>),
    /// So many of the bytes just told came with a framing or parity error, or were a break.
    FramingErrors(u32),
    /// It is lost.
    Closed(LinkLoss),
}
