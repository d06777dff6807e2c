//! The host, the line to it, and who may move the robot.

use super::super::scene::RelaxScene::{ByHand, Cleaning, Driving, Locked};
use super::super::testbed::RelaxTestbed;
use super::super::trial::{RelaxEvent, RelaxTrial, reconnect};
use super::trial;
use crate::limits;
use crate::trial::Expectation::{Lawful, Off, OffSaying};
use crate::trial::MotorGroup::{All, Cleaners, Wheels};
use rvac_channel::FaultRates;
use rvac_protocol::message::{Command, Inhibit};
use rvac_units::{AngularSpeed, Speed};

/// A session that is silent is over after this.
const SILENCE_MS: u64 = 2_300;
/// What the host has said has left its line after this: three `motor` and a `drive`.
const QUEUE_MS: u64 = 100;
/// What is typed has left the line after this.
const LINE_MS: u64 = 15;
/// Hand mode has ended after this.
const QUIET_MS: u64 = 10_300;

pub(super) fn trials() -> Vec<RelaxTrial> {
    [silence(), packets(), arming()].concat()
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
