//! Resets, a program that hangs, motors, encoders and the battery.

use super::super::scene::RelaxScene::{Cleaning, Creeping, Driving, Standing};
use super::super::testbed::RelaxTestbed;
use super::super::trial::{RelaxEvent, RelaxTrial};
use super::{hold, trial};
use crate::limits;
use crate::trial::Expectation::{Off, OffSaying, Says, SaysAfterReset};
use crate::trial::MotorGroup::{All, Cleaners, Wheels};
use home::{SensorFault, SensorId};
use rvac_protocol::message::{Inhibit, ResetCause};
use stc90::board::{HeldLine, Motor};

/// Between two resets of a loop: the robot has started.
const UP_MS: u64 = 1_500;
/// SJMP to itself, which stands behind `main` in every program of SDCC.
const LOOP: [u8; 2] = [0x80, 0xFE];

pub(super) fn trials() -> Vec<RelaxTrial> {
    [resets(), motors(), power()].concat()
}

fn overload(testbed: &mut RelaxTestbed, motor: Motor, cycle: u64) -> u64 {
    hold(testbed, (HeldLine::OverCurrent(motor), true), cycle)
}

fn fault(testbed: &mut RelaxTestbed, sensor: SensorId, fault: SensorFault) -> u64 {
    testbed
        .pair
        .robot_mut()
        .world_mut()
        .set_fault(sensor, Some(fault));
    testbed.cycle()
}

fn reset(testbed: &mut RelaxTestbed, cause: ResetCause) -> u64 {
    let at = testbed.cycle();
    testbed.pair.robot_mut().reset(cause);
    at
}

/// The program counter lands in an endless loop; interrupts go on.
fn hang(testbed: &mut RelaxTestbed, _: u64) -> u64 {
    let at = testbed.cycle();
    let cpu = testbed.pair.robot_mut().machine_mut().cpu_mut();
    let places = 0..=u16::MAX >> 1;
    let found = places
        .into_iter()
        .find(|at| [cpu.code().byte(*at), cpu.code().byte(at + 1)] == LOOP);
    if let Some(place) = found {
        cpu.set_pc(place);
    }
    at
}

fn resets() -> Vec<RelaxTrial> {
    let thrice: RelaxEvent = |testbed, _| {
        for _ in 0..2 {
            reset(testbed, ResetCause::Watchdog);
            testbed.run(UP_MS);
        }
        let at = reset(testbed, ResetCause::Watchdog);
        testbed.drive = None;
        at
    };
    let still = OffSaying(All, Inhibit::NotArmed);
    vec![
        trial(
            ("reset-pin", "reset at the pin RST"),
            (Cleaning, |testbed, _| reset(testbed, ResetCause::External)),
            Off(All),
            limits::S4_OFF,
        ),
        trial(
            ("brown-out", "the power fails for a moment"),
            (Cleaning, |testbed, _| reset(testbed, ResetCause::BrownOut)),
            Off(All),
            limits::S4_OFF,
        ),
        trial(
            (
                "reset-then-still",
                "after a reset the host drives on without arming",
            ),
            (Driving, |testbed, _| reset(testbed, ResetCause::Watchdog)),
            still,
            limits::S4_OFF,
        )
        .watched_for(4_000)
        .shared_by(4),
        trial(
            ("three-resets", "the third reset in a minute; reported"),
            (Standing, thrice),
            SaysAfterReset(Inhibit::ResetLoop),
            limits::S4_OFF,
        )
        .shared_by(4),
        trial(
            ("loop-with-interrupts", "the program loops, interrupts go on"),
            (Cleaning, hang),
            Off(All),
            limits::S5_RESET,
        ),
    ]
}

fn motors() -> Vec<RelaxTrial> {
    let stalls = OffSaying(Wheels, Inhibit::WheelStall);
    let draws_left: RelaxEvent = |testbed, cycle| overload(testbed, Motor::WheelLeft, cycle);
    let draws_right: RelaxEvent = |testbed, cycle| overload(testbed, Motor::WheelRight, cycle);
    let draws_brush: RelaxEvent = |testbed, cycle| overload(testbed, Motor::Brush, cycle);
    let draws_suction: RelaxEvent = |testbed, cycle| overload(testbed, Motor::Suction, cycle);
    let blocked = OffSaying(Cleaners, Inhibit::BrushStall);
    let lost: RelaxEvent = |testbed, _| fault(testbed, SensorId::EncoderLeft, SensorFault::StuckAt(0));
    vec![
        trial(
            ("wheel-over-current", "the left wheel draws too much"),
            (Driving, draws_left),
            stalls,
            limits::S11_OVER_CURRENT,
        ),
        trial(
            ("wheel-over-current-right", "the right wheel draws too much"),
            (Driving, draws_right),
            stalls,
            limits::S11_OVER_CURRENT,
        ),
        trial(
            ("brush-over-current", "the main brush draws too much"),
            (Cleaning, draws_brush),
            blocked,
            limits::S11_OVER_CURRENT,
        ),
        trial(
            ("suction-over-current", "suction or side brush draw too much"),
            (Cleaning, draws_suction),
            blocked,
            limits::S11_OVER_CURRENT,
        ),
        trial(
            ("wheel-standstill", "a driven wheel stands still"),
            (Driving, lost),
            stalls,
            limits::S11_STANDSTILL,
        ),
        trial(
            ("encoder-lost-slow", "an encoder is lost while the robot creeps"),
            (Creeping, lost),
            Off(Wheels),
            limits::S13_FOUND,
        ),
    ]
}

fn power() -> Vec<RelaxTrial> {
    vec![
        trial(
            ("pack-low", "the line `battery OK` complains; reported"),
            (Standing, |testbed, cycle| {
                hold(testbed, (HeldLine::BatteryOk, false), cycle)
            }),
            Says(Inhibit::BatteryLow),
            limits::S16_LOW,
        )
        .shared_by(10),
    ]
}
