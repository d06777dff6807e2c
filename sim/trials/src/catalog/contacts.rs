//! Bumper, wheel drops, buttons and cliff sensors.

use home::{SensorFault, SensorId};
use pic32::board::Contact;
use rvac_protocol::message::Inhibit;
use rvac_units::{AngularSpeed, Speed, Throttle};

use super::{fault, flood, hold, press};
use crate::limits;
use crate::scene::OperatingState::{Cleaning, Driving, Standing, Turning};
use crate::testbed::Testbed;
use crate::trial::Expectation::{Off, OffSaying, Says};
use crate::trial::{MotorGroup, Trial};

/// Numbers of the cliff sensors, from the left.
const LEFT: u8 = 0;
const MIDDLE: u8 = 1;
const RIGHT: u8 = 2;
/// Light on a receiver above a drop, of 255, and of one that is stuck in the middle of its range.
const DROP: i32 = 8;
const STUCK: i32 = 150;
/// By then a report tells which sensor it is, and the monitor compares.
const TOLD_MS: u64 = 300;
/// A reverse slow enough to stay within S7's distance for its whole time, µm/s, and the time in which it begins.
const SLOW_REVERSE: Speed = Speed(-40_000);
const TURNS_BACK_MS: u64 = 500;

/// A bumper is pressed, and the host backs off slowly. The time counts from the first push backward.
fn back_off_pressed(testbed: &mut Testbed, cycle: u64) -> u64 {
    hold(testbed, Contact::BumperLeft, cycle);
    testbed.drive(None);
    testbed.run(200);
    testbed.drive(Some((SLOW_REVERSE, AngularSpeed(0))));
    for _ in 0..TURNS_BACK_MS {
        testbed.tick();
        if testbed.robot().wheels_driven() {
            break;
        }
    }
    testbed.robot().cycle()
}

pub(super) fn trials() -> Vec<Trial> {
    [touch(), floor(), hands()].concat()
}

fn touch() -> Vec<Trial> {
    let stops = OffSaying(MotorGroup::Wheels, Inhibit::Bumper);
    vec![
        Trial::new("bumper-left", "bumper, left", Driving, |testbed, cycle| {
            hold(testbed, Contact::BumperLeft, cycle)
        })
        .expects(stops, limits::S6_STOP),
        Trial::new(
            "bumper-right",
            "bumper, right (polled)",
            Driving,
            |testbed, cycle| hold(testbed, Contact::BumperRight, cycle),
        )
        .expects(stops, limits::S6_STOP),
        Trial::new(
            "flood-bumper",
            "bumper, and edges flood the receive pin",
            Driving,
            |testbed, cycle| {
                flood(testbed, cycle);
                hold(testbed, Contact::BumperRight, cycle)
            },
        )
        .expects(Off(MotorGroup::Wheels), limits::S6_STOP),
        Trial::new(
            "bumper-held",
            "a bumper stays pressed; reported",
            Driving,
            |testbed, cycle| hold(testbed, Contact::BumperLeft, cycle),
        )
        .expects(Says(Inhibit::BumperStuck), limits::S7_HELD),
        Trial::new(
            "bumper-held-backing",
            "a bumper stays pressed while the robot backs off; reported",
            Driving,
            back_off_pressed,
        )
        .expects(Says(Inhibit::BumperStuck), limits::S7_BACKING),
    ]
}

fn floor() -> Vec<Trial> {
    let seen = OffSaying(MotorGroup::Wheels, Inhibit::Cliff);
    vec![
        Trial::new("cliff-left", "cliff, left", Driving, |testbed, _| {
            fault(testbed, SensorId::Cliff(LEFT), SensorFault::StuckAt(DROP))
        })
        .expects(seen, limits::S8_STOP)
        .watched_for(TOLD_MS),
        Trial::new("cliff-middle", "cliff, middle", Driving, |testbed, _| {
            fault(testbed, SensorId::Cliff(MIDDLE), SensorFault::StuckAt(DROP))
        })
        .expects(seen, limits::S8_STOP),
        Trial::new(
            "cliff-right-turning",
            "cliff, right, while it turns",
            Turning,
            |testbed, _| fault(testbed, SensorId::Cliff(RIGHT), SensorFault::StuckAt(DROP)),
        )
        .expects(seen, limits::S8_STOP),
        Trial::new(
            "flood-cliff",
            "cliff, and edges flood the receive pin",
            Driving,
            |testbed, cycle| {
                flood(testbed, cycle);
                fault(testbed, SensorId::Cliff(MIDDLE), SensorFault::StuckAt(DROP))
            },
        )
        .expects(Off(MotorGroup::Wheels), limits::S8_STOP),
        Trial::new(
            "cliff-receiver-sticks-middle",
            "a cliff receiver sticks, middle",
            Driving,
            |testbed, _| fault(testbed, SensorId::Cliff(MIDDLE), SensorFault::StuckAt(STUCK)),
        )
        .expects(Off(MotorGroup::Wheels), limits::S9_BLIND),
        Trial::new(
            "cliff-receiver-sticks-left",
            "a cliff receiver sticks, left, while it turns",
            Turning,
            |testbed, _| fault(testbed, SensorId::Cliff(LEFT), SensorFault::StuckAt(STUCK)),
        )
        .expects(Off(MotorGroup::Wheels), limits::S9_BLIND),
    ]
}

fn hands() -> Vec<Trial> {
    let hangs = OffSaying(MotorGroup::All, Inhibit::WheelDrop);
    vec![
        Trial::new(
            "wheel-drop-left",
            "left wheel hangs",
            Cleaning,
            |testbed, cycle| hold(testbed, Contact::WheelDropLeft, cycle),
        )
        .expects(hangs, limits::S10_OFF),
        Trial::new(
            "wheel-drop-right",
            "right wheel hangs",
            Cleaning,
            |testbed, cycle| hold(testbed, Contact::WheelDropRight, cycle),
        )
        .expects(hangs, limits::S10_OFF),
        Trial::new(
            "flood-wheel-drop",
            "a wheel hangs, and edges flood the receive pin",
            Cleaning,
            |testbed, cycle| {
                flood(testbed, cycle);
                hold(testbed, Contact::WheelDropLeft, cycle)
            },
        )
        .expects(Off(MotorGroup::All), limits::S10_OFF),
        Trial::new("button", "button", Cleaning, |testbed, _| press(testbed))
            .expects(OffSaying(MotorGroup::All, Inhibit::ButtonStop), limits::S28_STOP),
        Trial::new(
            "flood-button",
            "button, and edges flood the receive pin",
            Cleaning,
            |testbed, cycle| {
                flood(testbed, cycle);
                press(testbed)
            },
        )
        .expects(Off(MotorGroup::All), limits::S28_STOP),
        Trial::new(
            "cleaners-lifted",
            "brushes and suction are wanted while a wheel hangs",
            Standing,
            |testbed, cycle| {
                hold(testbed, Contact::WheelDropLeft, cycle);
                testbed.run(60);
                testbed.clean(Throttle::saturating_from_millionths(800_000));
                testbed.robot().cycle()
            },
        )
        .expects(Off(MotorGroup::All), limits::S29_NEVER_START)
        .watched_for(500),
    ]
}
