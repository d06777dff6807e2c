//! Bumper, floor sensors and wheel drop.

use super::super::scene::RelaxScene::{Cleaning, Driving, Standing, Turning};
use super::super::testbed::RelaxTestbed;
use super::super::trial::{RelaxEvent, RelaxTrial};
use super::{hold, trial};
use crate::limits;
use crate::trial::Expectation::{Off, OffSaying, Says};
use crate::trial::MotorGroup::{All, Wheels};
use rvac_protocol::message::Inhibit;
use rvac_units::{AngularSpeed, Speed};
use stc90::board::HeldLine;

/// A reverse that reaches S7's distance before its time, and the time in which it begins. A slower one is driven by pulses with
/// pauses on these coarse encoders, and S7's time of backing begins anew with each pause.
const REVERSE: Speed = Speed(-70_000);
const TURNS_BACK_MS: u64 = 500;

pub(super) fn trials() -> Vec<RelaxTrial> {
    [touch(), floor(), lift()].concat()
}

/// A bumper is pressed, and the host backs off slowly. The time counts from the first push backward.
fn back_off_pressed(testbed: &mut RelaxTestbed, cycle: u64) -> u64 {
    hold(testbed, (HeldLine::BumperLeft, true), cycle);
    testbed.drive = None;
    testbed.run(200);
    testbed.drive = Some((REVERSE, AngularSpeed(0)));
    for _ in 0..TURNS_BACK_MS {
        testbed.tick();
        if testbed.pair.robot().wheels_driven() {
            break;
        }
    }
    testbed.cycle()
}

fn touch() -> Vec<RelaxTrial> {
    let stops = OffSaying(Wheels, Inhibit::Bumper);
    let left: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::BumperLeft, true), cycle);
    let right: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::BumperRight, true), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (HeldLine::BumperRight, true), cycle)
    };
    vec![
        trial(
            ("bumper-left", "bumper, left"),
            (Driving, left),
            stops,
            limits::S6_STOP,
        ),
        trial(
            ("bumper-right", "bumper, right"),
            (Driving, right),
            stops,
            limits::S6_STOP,
        ),
        trial(
            ("flood-bumper", "bumper, and nonsense fills the line"),
            (Driving, flooded),
            Off(Wheels),
            limits::S6_STOP,
        ),
        trial(
            ("bumper-held", "a bumper stays pressed; reported"),
            (Driving, left),
            Says(Inhibit::BumperStuck),
            limits::S7_HELD,
        )
        .shared_by(10),
        trial(
            (
                "bumper-held-backing",
                "a bumper stays pressed while the robot backs off; reported",
            ),
            (Driving, back_off_pressed),
            Says(Inhibit::BumperStuck),
            limits::S7_BACKING,
        )
        .shared_by(4),
    ]
}

fn floor() -> Vec<RelaxTrial> {
    let seen = OffSaying(Wheels, Inhibit::Cliff);
    let left: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::Floor(0), false), cycle);
    let middle: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::Floor(1), false), cycle);
    let right: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::Floor(3), false), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (HeldLine::Floor(2), false), cycle)
    };
    let blind: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::Floor(1), true), cycle);
    let dark: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::Lamp, false), cycle);
    vec![
        trial(
            ("cliff-left", "cliff, left"),
            (Driving, left),
            seen,
            limits::S8_STOP,
        ),
        trial(
            ("cliff-middle", "cliff, middle"),
            (Driving, middle),
            seen,
            limits::S8_STOP,
        ),
        trial(
            ("cliff-right-turning", "cliff, right, while it turns"),
            (Turning, right),
            seen,
            limits::S8_STOP,
        ),
        trial(
            ("flood-cliff", "cliff, and nonsense fills the line"),
            (Driving, flooded),
            Off(Wheels),
            limits::S8_STOP,
        ),
        trial(
            ("lamp-fails", "the lamp of all light sensors fails"),
            (Driving, dark),
            seen,
            limits::S8_STOP,
        ),
        trial(
            ("cliff-receiver-sticks-middle", "a floor receiver sticks at floor"),
            (Driving, blind),
            OffSaying(Wheels, Inhibit::CliffSensorFault),
            limits::S9_BLIND,
        ),
    ]
}

fn lift() -> Vec<RelaxTrial> {
    let hangs = OffSaying(All, Inhibit::WheelDrop);
    let drop: RelaxEvent = |testbed, cycle| hold(testbed, (HeldLine::WheelDrop, true), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (HeldLine::WheelDrop, true), cycle)
    };
    let wanted: RelaxEvent = |testbed, cycle| {
        hold(testbed, (HeldLine::WheelDrop, true), cycle);
        testbed.run(60);
        testbed.cleans = true;
        testbed.cycle()
    };
    vec![
        trial(
            ("wheel-drop", "a wheel hangs"),
            (Cleaning, drop),
            hangs,
            limits::S10_OFF,
        ),
        trial(
            ("flood-wheel-drop", "a wheel hangs, and nonsense fills the line"),
            (Cleaning, flooded),
            Off(All),
            limits::S10_OFF,
        ),
        trial(
            (
                "cleaners-lifted",
                "brush and suction are wanted while a wheel hangs",
            ),
            (Standing, wanted),
            Off(All),
            limits::S29_NEVER_START,
        )
        .watched_for(500),
    ]
}
