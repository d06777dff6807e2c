//! The host and the line to it.

use rvac_channel::FaultRates;
use rvac_protocol::message::{Command, Inhibit};

use super::flood;
use crate::limits;
use crate::scene::OperatingState::{Cleaning, Driving};
use crate::testbed::Testbed;
use crate::trial::Expectation::{Lawful, Off, OffSaying};
use crate::trial::{MotorGroup, Trial};

/// The host falls silent until its session is over; then somebody types motion and arms nothing.
fn type_without_a_host(testbed: &mut Testbed, _: u64) -> u64 {
    testbed.set_speaking(false);
    testbed.run(2_300);
    let from = testbed.robot().cycle();
    for _ in 0..10 {
        testbed.type_in(r#"{"c":"drive","v":0.1,"w":0,"ttl":500}"#);
        testbed.type_in(r#"{"c":"motor","motor":"vacuum","throttle":1,"ttl":500}"#);
        testbed.run(50);
    }
    from
}

pub(super) fn trials() -> Vec<Trial> {
    [silence(), packets()].concat()
}

fn silence() -> Vec<Trial> {
    vec![
        Trial::new(
            "silence-wheels",
            "the host falls silent: wheels, leases of 120 ms",
            Driving,
            |testbed, cycle| {
                testbed.set_speaking(false);
                cycle
            },
        )
        .expects(
            OffSaying(MotorGroup::Wheels, Inhibit::LinkLost),
            limits::S1_SILENCE,
        ),
        Trial::new(
            "cable-cut-cleaners",
            "the cable is cut: all motors, leases of 120 ms",
            Cleaning,
            |testbed, cycle| {
                testbed.robot_mut().cut_line(4_000);
                cycle
            },
        )
        .expects(Off(MotorGroup::All), limits::S1_SILENCE),
        Trial::new(
            "flood-wheels",
            "750,000 edges a second flood the receive pin: wheels",
            Driving,
            flood,
        )
        .expects(Off(MotorGroup::Wheels), limits::S1_SILENCE),
    ]
}

fn packets() -> Vec<Trial> {
    vec![
        Trial::new(
            "bit-errors",
            "one bit in a hundred is wrong for half a second: no breach",
            Cleaning,
            |testbed, cycle| {
                testbed.robot_mut().set_line_rates(FaultRates {
                    bit_error: 0.01,
                    ..FaultRates::NONE
                });
                cycle
            },
        )
        .expects(Lawful, limits::S2_NONE_ACTS)
        .watched_for(500),
        Trial::new(
            "typed-after-host",
            "motion is typed after the host has died: it never acts",
            Cleaning,
            type_without_a_host,
        )
        .expects(Off(MotorGroup::All), limits::S2_NONE_ACTS),
        Trial::new(
            "late-commands",
            "0.6 s of commands arrive late, all at once: no breach",
            Driving,
            |testbed, cycle| {
                testbed.robot_mut().hold_line(600);
                cycle
            },
        )
        .expects(Lawful, limits::S3_NONE_ACTS)
        .watched_for(1_000),
        Trial::new("stop", "the host says `stop`", Cleaning, |testbed, cycle| {
            testbed.drive(None);
            testbed.clean(rvac_units::Throttle::ZERO);
            testbed.say(Command::Stop);
            cycle
        })
        .expects(OffSaying(MotorGroup::All, Inhibit::Stopped), limits::STOP_OFF),
    ]
}
