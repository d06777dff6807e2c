//! Sensors on the robot's Linux board besides the daemon: a gyro and a radio, if fitted.

use home::{Beacons, BoardGyro};

use crate::{Host, Robot};

/// Milliseconds between two totals of the gyro, as the daemon's own reader sends them.
const GYRO_MS: u64 = 10;

/// The sensors of the Linux board.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinuxBoard {
    pub(crate) gyro: Option<BoardGyro>,
    /// The gyro turns with the robot and says nothing.
    pub(crate) gyro_is_silent: bool,
    pub(crate) beacons: Option<Beacons>,
}

impl LinuxBoard {
    /// Advances one millisecond and passes the sensors' readings to the host.
    pub(crate) fn pass_ms(&mut self, robot: &Robot, host: &mut Host, now_us: u64) {
        let (pose, now_ms) = (robot.world().truth().pose, robot.now_ms());
        if let Some(gyro) = &mut self.gyro {
            gyro.step(pose.heading_rad);
            if now_ms.is_multiple_of(GYRO_MS) && !self.gyro_is_silent {
                host.board_heading(now_us, gyro.total_urad());
            }
        }
        if let Some(beacons) = &mut self.beacons
            && let Some((beacon, measured)) = beacons.step(robot.world().home(), pose)
        {
            host.beacon(now_us, beacon, measured);
        }
    }
}
