//! Who may move the robot.

use rvac_units::{AngularSpeed, Speed, Throttle};

use crate::limits;
use crate::scene::OperatingState::{ByHand, Locked};
use crate::testbed::Testbed;
use crate::trial::Expectation::Off;
use crate::trial::{MotorGroup, Trial};

/// What is typed has left the line after this.
const LINE_MS: u64 = 5;
/// Hand mode has ended after this, and the millisecond clocks of both sides agree on it.
const QUIET_MS: u64 = 10_300;
/// A host finds its robot within this.
const OPENS_MS: u64 = 5_000;

/// The person stops typing.
fn stop_typing(testbed: &mut Testbed, _: u64) -> u64 {
    testbed.keep_typing(None);
    testbed.run(LINE_MS);
    testbed.robot().cycle()
}

/// The person comes back later and drives without arming.
fn drive_later(testbed: &mut Testbed, _: u64) -> u64 {
    testbed.keep_typing(None);
    testbed.run(QUIET_MS);
    testbed.keep_typing(Some(r#"{"c":"drive","v":0.05,"w":0,"ttl":500}"#));
    testbed.robot().cycle()
}

/// A host comes while the person goes on typing.
fn host_comes(testbed: &mut Testbed, _: u64) -> u64 {
    testbed.set_speaking(true);
    for _ in 0..OPENS_MS {
        testbed.tick();
        if testbed.is_connected() {
            break;
        }
    }
    testbed.robot().cycle()
}

pub(super) fn trials() -> Vec<Trial> {
    vec![
        Trial::new(
            "not-armed",
            "a host that has not armed wants everything: it never acts",
            Locked,
            |testbed, cycle| {
                testbed.drive(Some((Speed(150_000), AngularSpeed(0))));
                testbed.clean(Throttle::saturating_from_millionths(800_000));
                cycle
            },
        )
        .expects(Off(MotorGroup::All), limits::ARMING_NONE_ACTS)
        .watched_for(500),
        Trial::new(
            "hand-stops-typing",
            "a person drives by typing with leases of 1 s, and stops",
            ByHand,
            stop_typing,
        )
        .expects(Off(MotorGroup::All), limits::ARMING_HAND_LEASE),
        Trial::new(
            "hand-disarms",
            "a person types motion again 10.3 s later, without arming: it never acts",
            ByHand,
            drive_later,
        )
        .expects(Off(MotorGroup::All), limits::ARMING_NONE_ACTS)
        .watched_for(500),
        Trial::new(
            "session-over-hand",
            "a host opens a session while a person drives by typing",
            ByHand,
            host_comes,
        )
        .expects(Off(MotorGroup::All), limits::ARMING_SESSION)
        .watched_for(500),
    ]
}
