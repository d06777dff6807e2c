//! A make of robot: what one folder provides.

use core::fmt;

use brain::Inhibit;

use super::{
    CleanerDrive, CommandError, Description, DeviceEvent, LeaveDock, Level, Light, LinkQuality, Tone,
};
use crate::Direction;

/// One robot of some make, at the end of its line. It does no input and output and has no clock: bytes come in, bytes and
/// events go out, time is an argument. [`super::Supervisor`] stands before it and asks only for what the description
/// offers.
pub trait Device: fmt::Debug + Send {
    /// The line has just been opened, for the first time or again: whoever is at its other end must be greeted anew.
    fn open(&mut self, io: &mut DeviceIo<'_>);

    /// What it is and can do, once it has reported that since the line was opened.
    fn description(&self) -> Option<&Description>;

    /// Whether it is described and listens.
    fn is_attached(&self) -> bool;

    /// How good the link is, and what has come over it.
    fn link_quality(&self) -> LinkQuality;

    /// Takes bytes from the robot.
    fn receive(&mut self, bytes: &[u8], io: &mut DeviceIo<'_>);

    /// Lets time pass: asks for reports where the robot sends none by itself, keeps it awake, repeats what was lost.
    fn poll(&mut self, io: &mut DeviceIo<'_>);

    /// When [`Device::poll`] has something to do at the latest.
    fn next_wake_us(&self, now_us: u64) -> u64;

    /// Takes control of what `level` means. Called before the first command; [`CommandError::Busy`] while the robot
    /// changes its mode, then it is called again.
    ///
    /// # Errors
    /// Why the robot cannot be controlled.
    fn acquire(&mut self, level: Level, io: &mut DeviceIo<'_>) -> Result<(), CommandError>;

    /// Releases the robot: its wheels stop, it may sleep and charge. May be called at any time and more than once, also
    /// before anything is known of the robot: a daemon that has crashed may have left it in any mode.
    fn release(&mut self, io: &mut DeviceIo<'_>);

    /// Drives, or stands still with both numbers 0. Repeated every 30 ms while it holds; what the robot knows already need
    /// not be sent again.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn drive(&mut self, drive: Drive, io: &mut DeviceIo<'_>) -> Result<(), CommandError>;

    /// Stops everything at once, in any state.
    fn stop(&mut self, io: &mut DeviceIo<'_>);

    /// Runs or stops brushes and suction, as far as the robot has them.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn cleaners(&mut self, drive: CleanerDrive, io: &mut DeviceIo<'_>) -> Result<(), CommandError>;

    /// Allows motion after a start or a stop. Most robots know no such thing.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn arm(&mut self, leave_dock: LeaveDock, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let _ = (leave_dock, io);
        Ok(())
    }

    /// Clears a latched inhibit that the robot itself has reported.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn clear(&mut self, inhibit: Inhibit, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let _ = (inhibit, io);
        Err(CommandError::Absent)
    }

    /// Plays a tone.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn tone(&mut self, tone: Tone, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let _ = (tone, io);
        Err(CommandError::Absent)
    }

    /// Sets a light.
    ///
    /// # Errors
    /// Why nothing was sent.
    fn light(&mut self, light: Light, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let _ = (light, io);
        Err(CommandError::Absent)
    }

    /// Sends what an expert typed.
    ///
    /// # Errors
    /// [`CommandError::Syntax`] if it is no command of the robot, else why nothing was sent.
    fn raw(&mut self, text: &str, io: &mut DeviceIo<'_>) -> Result<(), CommandError>;

    /// Appends the packets that `bytes` on the line complete, as text for people and recordings. Gets the bytes of a
    /// direction in order while a client watches.
    fn tap(&mut self, direction: Direction, bytes: &[u8], packets: &mut Vec<(Direction, String)>);
}

/// Where a device's bytes and events go, and when.
#[derive(Debug)]
pub struct DeviceIo<'a> {
    /// Host time in microseconds.
    pub now_us: u64,
    /// Bytes for the robot.
    pub link: &'a mut Vec<u8>,
    /// Events of the robot.
    pub events: &'a mut Vec<DeviceEvent>,
}

/// A command to the wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Forward speed, m/s.
    pub speed_m_per_s: f64,
    /// Turn rate, rad/s, counter-clockwise positive.
    pub turn_rad_per_s: f64,
}

impl Drive {
    /// Standing still under control.
    pub const STAND: Self = Self {
        speed_m_per_s: 0.0,
        turn_rad_per_s: 0.0,
    };

    /// Speeds of the rims of the left and the right wheel, m/s.
    #[must_use]
    pub fn rims_m_per_s(self, track_m: f64) -> [f64; 2] {
        let turn_m_per_s = 0.5 * track_m * self.turn_rad_per_s;
        [
            self.speed_m_per_s - turn_m_per_s,
            self.speed_m_per_s + turn_m_per_s,
        ]
    }
}

/// A make of robot, as data for whoever opens the line, and how one robot of it begins.
#[derive(Clone, Copy, Debug)]
pub struct Make {
    /// Its name.
    pub name: &'static str,
    /// How the line is opened.
    pub opening: Opening,
    /// A robot of which nothing is known yet.
    pub connect: fn() -> Box<dyn Device>,
}

/// How the line to a robot is opened. What is said over it then is the business of [`Device::open`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opening {
    /// Rates in bits per second, the likeliest first. Unless the configuration names one, each is tried in turn until a robot
    /// answers.
    pub rates_baud: &'static [u32],
    /// A robot at the right rate has described itself after so long.
    pub answer_within_ms: u16,
    /// The line RTS is low for so long, to wake the robot; 0 = it needs no waking.
    pub wake_pulse_ms: u16,
    /// Pause before the first byte.
    pub settle_ms: u16,
}
