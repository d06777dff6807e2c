//! The robot of a scene: the firmware built for this machine on simulated pins, or the robot's own binary in an
//! emulated chip. All other modules use only this interface.

use home::{RobotModel, World};
use monitor::Monitor;
use pic32::board::EmulatedRobot;
use robot::{FaultRates, Relax, SimulatedRobot};
use rvac_protocol::message::ResetCause;
use stc90::board::EmulatedRelax;

/// A robot of either make.
#[derive(Debug)]
pub enum Robot {
    /// cordlib as a part of this program, on the SR8730's simulated pins.
    HostBuilt(Box<SimulatedRobot>),
    /// cordlib as a part of this program, on the simulated pins of a Relax.
    HostBuiltRelax(Box<SimulatedRobot<Relax>>),
    /// A firmware image in the SR8730's emulated microcontroller.
    Emulated(Box<EmulatedRobot>),
    /// A firmware image in the Relax's emulated microcontroller.
    EmulatedRelax(Box<EmulatedRelax>),
}

/// Does the same with whichever robot it is.
macro_rules! each {
    ($robot:expr, $inner:ident => $action:expr) => {
        match $robot {
            Robot::HostBuilt($inner) => $action,
            Robot::HostBuiltRelax($inner) => $action,
            Robot::Emulated($inner) => $action,
            Robot::EmulatedRelax($inner) => $action,
        }
    };
}

impl Robot {
    /// Hands bytes to the host's serial driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        each!(self, robot => robot.send(bytes))
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn line_room(&self) -> usize {
        each!(self, robot => robot.line_room())
    }

    /// Advances one millisecond. What reaches the host's receiver is appended to `to_host`.
    pub fn tick(&mut self, to_host: &mut Vec<u8>) {
        each!(self, robot => robot.tick(to_host));
    }

    /// Resets the microcontroller.
    pub fn reset(&mut self, cause: ResetCause) {
        each!(self, robot => robot.reset(cause));
    }

    /// Sets the rates of faults on the line, in both directions.
    pub fn set_line_rates(&mut self, rates: FaultRates) {
        each!(self, robot => robot.set_line_rates(rates));
    }

    /// Both directions of the line pause for `ms`.
    pub fn hold_line(&mut self, ms: u32) {
        each!(self, robot => robot.hold_line(ms));
    }

    /// The cable is out for `ms`.
    pub fn cut_line(&mut self, ms: u32) {
        each!(self, robot => robot.cut_line(ms));
    }

    /// The host died: what its driver still held is gone.
    pub fn host_died(&mut self) {
        each!(self, robot => robot.host_died());
    }

    /// The home around the robot.
    #[must_use]
    pub const fn world(&self) -> &World {
        each!(self, robot => robot.world())
    }

    /// The home around the robot, to lift it, press buttons and break sensors.
    pub const fn world_mut(&mut self) -> &mut World {
        each!(self, robot => robot.world_mut())
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        each!(self, robot => robot.model())
    }

    /// The judge.
    #[must_use]
    pub const fn monitor(&self) -> &Monitor {
        each!(self, robot => robot.monitor())
    }

    /// Simulated milliseconds.
    #[must_use]
    pub const fn now_ms(&self) -> u64 {
        each!(self, robot => robot.now_ms())
    }

    /// Resets since the robot was switched on.
    #[must_use]
    pub const fn resets(&self) -> u32 {
        each!(self, robot => robot.resets())
    }

    /// Whether a wheel is driven now.
    #[must_use]
    pub fn wheels_driven(&self) -> bool {
        each!(self, robot => robot.wheels_driven())
    }

    /// A hash of everything that happened: every byte on the wire and the true pose ten times a second.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        each!(self, robot => robot.state_hash())
    }
}
