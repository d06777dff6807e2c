//! The Relax's trials, by what goes wrong. A name is that of the SR8730's trial where there is one.

use super::scene::RelaxScene::{self, ByHand, Cleaning, Creeping, Driving, Locked, Standing, Turning};
use super::testbed::RelaxTestbed;
use super::trial::{RelaxEvent, RelaxTrial, reconnect};
use crate::limits::{self, Limit};
use crate::trial::Expectation::{self, Lawful, Off, OffSaying, Says, SaysAfterReset};
use crate::trial::MotorGroup::{All, Cleaners, Wheels};
use home::{SensorFault, SensorId};
use rvac_channel::FaultRates;
use rvac_protocol::message::{Command, Inhibit, ResetCause};
use rvac_units::{AngularSpeed, Speed};
use stc90::board::{Motor, Signal};

/// A reverse that reaches S7's distance before its time, and the time in which it begins. A slower one is driven by pulses with
/// pauses on these coarse encoders, and S7's time of backing begins anew with each pause.
const REVERSE: Speed = Speed(-70_000);
const TURNS_BACK_MS: u64 = 500;
/// A session that is silent is over after this.
const SILENCE_MS: u64 = 2_300;
/// What the host has said has left its line after this: three `motor` and a `drive`.
const QUEUE_MS: u64 = 100;
/// What is typed has left the line after this.
const LINE_MS: u64 = 15;
/// Hand mode has ended after this.
const QUIET_MS: u64 = 10_300;
/// Between two resets of a loop: the robot has started.
const UP_MS: u64 = 1_500;
/// SJMP to itself, which stands behind `main` in every program of SDCC.
const LOOP: [u8; 2] = [0x80, 0xFE];

/// All of them.
#[must_use]
pub fn trials() -> Vec<RelaxTrial> {
    [
        link(),
        resets(),
        touch(),
        floor(),
        lift(),
        motors(),
        power(),
        arming(),
    ]
    .concat()
}

/// A fault and its name, where and how it happens, what must follow, and how soon.
const fn trial(
    (name, what): (&'static str, &'static str),
    (scene, event): (RelaxScene, RelaxEvent),
    expected: Expectation,
    limit: Limit,
) -> RelaxTrial {
    RelaxTrial {
        name,
        what,
        scene,
        event,
        expected,
        limit,
        watch_ms: 0,
        share: 1,
    }
}

impl RelaxTrial {
    const fn watched_for(self, watch_ms: u64) -> Self {
        Self { watch_ms, ..self }
    }

    /// Only one in so many moments, because it takes long.
    const fn shared_by(self, share: usize) -> Self {
        Self { share, ..self }
    }
}

fn hold(testbed: &mut RelaxTestbed, (signal, is_on): (Signal, bool), cycle: u64) -> u64 {
    testbed.pair.robot_mut().hold(signal, is_on, cycle);
    cycle
}

fn overload(testbed: &mut RelaxTestbed, motor: Motor, cycle: u64) -> u64 {
    hold(testbed, (Signal::OverCurrent(motor), true), cycle)
}

fn fault(testbed: &mut RelaxTestbed, sensor: SensorId, fault: SensorFault) -> u64 {
    testbed
        .pair
        .robot_mut()
        .world_mut()
        .set_fault(sensor, Some(fault));
    testbed.cycle()
}

fn link() -> Vec<RelaxTrial> {
    [silence(), packets()].concat()
}

fn silence() -> Vec<RelaxTrial> {
    let silent: RelaxEvent = |testbed, cycle| {
        testbed.pair.set_speaking(false);
        cycle
    };
    let cut: RelaxEvent = |testbed, cycle| {
        testbed.pair.robot_mut().cut_line(4_000);
        cycle
    };
    vec![
        trial(
            (
                "silence-wheels",
                "the host falls silent: wheels, leases of 120 ms",
            ),
            (Driving, silent),
            OffSaying(Wheels, Inhibit::LinkLost),
            limits::S1_SILENCE,
        ),
        trial(
            ("cable-cut-wheels", "the cable is cut: wheels, leases of 120 ms"),
            (Cleaning, cut),
            Off(Wheels),
            limits::S1_SILENCE,
        ),
        trial(
            (
                "cable-cut-cleaners",
                "the cable is cut: brush and suction, leases of 1 s",
            ),
            (Cleaning, cut),
            Off(Cleaners),
            limits::S1_CLEANERS,
        ),
    ]
}

fn packets() -> Vec<RelaxTrial> {
    let noisy: RelaxEvent = |testbed, cycle| {
        testbed.pair.robot_mut().set_line_rates(FaultRates {
            bit_error: 0.01,
            ..FaultRates::NONE
        });
        cycle
    };
    let late: RelaxEvent = |testbed, cycle| {
        testbed.pair.robot_mut().hold_line(600);
        cycle
    };
    let stopped = OffSaying(All, Inhibit::Stopped);
    vec![
        trial(
            (
                "bit-errors",
                "one bit in a hundred is wrong for half a second: no breach",
            ),
            (Cleaning, noisy),
            Lawful,
            limits::S2_NONE_ACTS,
        )
        .watched_for(500),
        trial(
            (
                "typed-after-host",
                "motion is typed after the host has died: it never acts",
            ),
            (Cleaning, type_without_a_host),
            Off(All),
            limits::S2_NONE_ACTS,
        )
        .shared_by(4),
        trial(
            (
                "late-commands",
                "0.6 s of commands arrive late, all at once: no breach",
            ),
            (Driving, late),
            Lawful,
            limits::S3_NONE_ACTS,
        )
        .watched_for(1_000),
        trial(
            ("stop", "the host says `stop`"),
            (Cleaning, say_stop),
            stopped,
            limits::STOP_OFF,
        ),
    ]
}

/// The host has nothing else on the line, and leases still run.
fn say_stop(testbed: &mut RelaxTestbed, _: u64) -> u64 {
    testbed.cleans = false;
    testbed.drive = None;
    testbed.run(QUEUE_MS);
    testbed.pair.say(Command::Stop);
    testbed.cycle()
}

/// The host falls silent until its session is over; then somebody types motion and arms nothing.
fn type_without_a_host(testbed: &mut RelaxTestbed, _: u64) -> u64 {
    testbed.pair.set_speaking(false);
    testbed.run(SILENCE_MS);
    let from = testbed.cycle();
    for _ in 0..10 {
        testbed.pair.type_in(r#"{"c":"drive","v":0.1,"w":0,"ttl":500}"#);
        testbed
            .pair
            .type_in(r#"{"c":"motor","motor":"vacuum","throttle":1,"ttl":500}"#);
        testbed.run(50);
    }
    from
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

/// A bumper is pressed, and the host backs off slowly. The time counts from the first push backward.
fn back_off_pressed(testbed: &mut RelaxTestbed, cycle: u64) -> u64 {
    hold(testbed, (Signal::BumperLeft, true), cycle);
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
    let left: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::BumperLeft, true), cycle);
    let right: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::BumperRight, true), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (Signal::BumperRight, true), cycle)
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
    let left: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::Floor(0), false), cycle);
    let middle: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::Floor(1), false), cycle);
    let right: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::Floor(3), false), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (Signal::Floor(2), false), cycle)
    };
    let blind: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::Floor(1), true), cycle);
    let dark: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::Lamp, false), cycle);
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
    let drop: RelaxEvent = |testbed, cycle| hold(testbed, (Signal::WheelDrop, true), cycle);
    let flooded: RelaxEvent = |testbed, cycle| {
        testbed.is_flooded = true;
        hold(testbed, (Signal::WheelDrop, true), cycle)
    };
    let wanted: RelaxEvent = |testbed, cycle| {
        hold(testbed, (Signal::WheelDrop, true), cycle);
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
                hold(testbed, (Signal::BatteryOk, false), cycle)
            }),
            Says(Inhibit::BatteryLow),
            limits::S16_LOW,
        )
        .shared_by(10),
    ]
}

fn arming() -> Vec<RelaxTrial> {
    let want: RelaxEvent = |testbed, cycle| {
        testbed.drive = Some((Speed(150_000), AngularSpeed(0)));
        testbed.cleans = true;
        cycle
    };
    let stop_typing: RelaxEvent = |testbed, _| {
        testbed.typed = None;
        testbed.run(LINE_MS);
        testbed.cycle()
    };
    let drive_later: RelaxEvent = |testbed, _| {
        testbed.typed = None;
        testbed.run(QUIET_MS);
        testbed.typed = Some(r#"{"c":"drive","v":0.05,"w":0,"ttl":500}"#);
        testbed.cycle()
    };
    let host_comes: RelaxEvent = |testbed, _| {
        testbed.pair.set_speaking(true);
        reconnect(testbed)
    };
    vec![
        trial(
            (
                "not-armed",
                "a host that has not armed wants everything: it never acts",
            ),
            (Locked, want),
            Off(All),
            limits::ARMING_NONE_ACTS,
        )
        .watched_for(500),
        trial(
            (
                "hand-stops-typing",
                "a person drives by typing with leases of 1 s, and stops",
            ),
            (ByHand, stop_typing),
            Off(All),
            limits::ARMING_HAND_LEASE,
        ),
        trial(
            (
                "hand-disarms",
                "a person types motion again 10.3 s later, without arming: it never acts",
            ),
            (ByHand, drive_later),
            Off(All),
            limits::ARMING_NONE_ACTS,
        )
        .watched_for(500)
        .shared_by(10),
        trial(
            (
                "session-over-hand",
                "a host opens a session while a person drives by typing",
            ),
            (ByHand, host_comes),
            Off(All),
            limits::ARMING_SESSION,
        )
        .watched_for(500)
        .shared_by(4),
    ]
}
