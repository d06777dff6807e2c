//! Motors and encoders.

use home::{SensorFault, SensorId};
use pic32::board::Contact;
use rvac_protocol::message::{Command, Inhibit, Motor, MotorCommand, Sequence};
use rvac_units::{Throttle, Tick};

use super::{fault, hold};
use crate::limits;
use crate::scene::OperatingState::{DeafBridges, Driving, Standing};
use crate::testbed::Testbed;
use crate::trial::Expectation::{Lawful, OffSaying, SaysBroken};
use crate::trial::{MotorGroup, Trial};

/// More than any wheel draws, mA.
const TOO_MUCH_MA: i32 = 4_000;

/// One wheel alone is asked for, and as long as a lease lasts.
fn turn_one_wheel(testbed: &mut Testbed, _: u64) -> u64 {
    let command = MotorCommand {
        motor: Motor::WheelLeft,
        throttle: Throttle::saturating_from_millionths(400_000),
        lease_ms: 300,
        sequence: Sequence(0),
        seen_tick: Tick(testbed.robot().now_ms() as u32),
    };
    testbed.say(Command::Motor(command));
    testbed.robot().cycle()
}

/// Suction alone is asked for.
fn suck(testbed: &mut Testbed, _: u64) -> u64 {
    let command = MotorCommand {
        motor: Motor::Vacuum,
        throttle: Throttle::saturating_from_millionths(800_000),
        lease_ms: 300,
        sequence: Sequence(0),
        seen_tick: Tick(testbed.robot().now_ms() as u32),
    };
    testbed.say(Command::Motor(command));
    testbed.robot().cycle()
}

fn alone() -> Vec<Trial> {
    vec![
        Trial::new(
            "one-wheel",
            "one wheel alone is asked for: no other motor turns",
            Standing,
            turn_one_wheel,
        )
        .expects(Lawful, limits::S1_SILENCE)
        .watched_for(600),
        Trial::new(
            "suction-alone",
            "suction alone is asked for: no other motor turns",
            Standing,
            suck,
        )
        .expects(Lawful, limits::S1_CLEANERS)
        .watched_for(600),
    ]
}

pub(super) fn trials() -> Vec<Trial> {
    [alone(), load()].concat()
}

fn load() -> Vec<Trial> {
    let stalls = OffSaying(MotorGroup::Wheels, Inhibit::WheelStall);
    let lies = OffSaying(MotorGroup::Wheels, Inhibit::EncoderFault);
    vec![
        Trial::new(
            "wheel-over-current",
            "a wheel draws too much",
            Driving,
            |testbed, _| {
                fault(
                    testbed,
                    SensorId::WheelLeftCurrent,
                    SensorFault::StuckAt(TOO_MUCH_MA),
                )
            },
        )
        .expects(stalls, limits::S11_OVER_CURRENT)
        .watched_for(1_200),
        Trial::new(
            "wheel-over-current-right",
            "the right wheel draws too much",
            Driving,
            |testbed, _| {
                fault(
                    testbed,
                    SensorId::WheelRightCurrent,
                    SensorFault::StuckAt(TOO_MUCH_MA),
                )
            },
        )
        .expects(stalls, limits::S11_OVER_CURRENT)
        .watched_for(1_200),
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
