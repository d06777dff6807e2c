//! An ordinary robot at the far end of the line, for those who test a link.

use rvac_protocol::message::{BinaryKinds, Capabilities, Description, Limits, MotorGaps, Name, ResetCause};
use rvac_protocol::session::{RobotIdentity, RobotSession};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

/// A robot that no host has greeted: without parts, as large and as fast as an SR8730, just switched on for the first
/// time.
#[must_use]
pub fn switched_on(now: Tick) -> RobotSession {
    let identity = RobotIdentity {
        device: Name::new(),
        firmware: Name::new(),
        boot_count: 1,
        reset_cause: ResetCause::PowerOn,
        session_seed: 1,
        binary: BinaryKinds::ALL,
        description: Description {
            capabilities: Capabilities::default(),
            limits: Limits {
                speed_max: Speed(350_000),
                turn_max: AngularSpeed(1_500_000),
                track: Length(230_000),
                count_nm: 100_000,
                radius: Length(175_000),
                swath: Length(300_000),
            },
            motors: MotorGaps::default(),
        },
    };
    RobotSession::new(identity, now)
}
