//! Motors and encoders.

use home::{SensorFault, SensorId};
use pic32::board::Contact;
use rvac_protocol::message::Inhibit;

use super::{hold, read};
use crate::limits;
use crate::scene::OperatingState::{DeafBridges, Driving};
use crate::testbed::Testbed;
use crate::trial::Expectation::{Off, OffSaying, SaysBroken};
use crate::trial::{MotorGroup, Trial};

/// Channel of the converter (pinout.toml).
const CURRENT_LEFT: u8 = 14;

fn fault(testbed: &mut Testbed, sensor: SensorId, fault: SensorFault) -> u64 {
    testbed.robot_mut().world_mut().set_fault(sensor, Some(fault));
    testbed.robot().cycle()
}

pub(super) fn trials() -> Vec<Trial> {
    let stalls = OffSaying(MotorGroup::Wheels, Inhibit::WheelStall);
    // Which of the two rules names it first depends on how fast the wheel runs away.
    let lies = Off(MotorGroup::Wheels);
    vec![
        Trial::new(
            "wheel-over-current",
            "a wheel draws too much",
            Driving,
            |testbed, cycle| read(testbed, CURRENT_LEFT, 1_023, cycle),
        )
        .expects(stalls, limits::S11_OVER_CURRENT),
        Trial::new(
            "wheel-standstill",
            "a driven wheel stands still",
            Driving,
            |testbed, _| fault(testbed, SensorId::EncoderLeft, SensorFault::StuckAt(0)),
        )
        .expects(stalls, limits::S11_STANDSTILL),
        Trial::new(
            "bridges-deaf",
            "bridges go on after a bumper's brake; reported",
            DeafBridges,
            |testbed, cycle| hold(testbed, Contact::BumperLeft, cycle),
        )
        .expects(SaysBroken(Inhibit::Runaway), limits::S12_FOUND),
        Trial::new(
            "encoder-inverted-left",
            "an encoder counts backward, left",
            Driving,
            |testbed, _| fault(testbed, SensorId::EncoderLeft, SensorFault::Inverted),
        )
        .expects(lies, limits::S13_FOUND),
        Trial::new(
            "encoder-inverted-right",
            "an encoder counts backward, right",
            Driving,
            |testbed, _| fault(testbed, SensorId::EncoderRight, SensorFault::Inverted),
        )
        .expects(lies, limits::S13_FOUND),
    ]
}
