//! All trials, by what goes wrong. Their names stand in protocol/rules.toml.

mod arming;
mod contacts;
mod hardware;
mod link;
mod motors;
mod power;

use pic32::board::{Contact, Hold};

use crate::testbed::Testbed;
use crate::trial::Trial;

/// All of them.
#[must_use]
pub fn trials() -> Vec<Trial> {
    [
        link::trials(),
        hardware::trials(),
        contacts::trials(),
        motors::trials(),
        power::trials(),
        arming::trials(),
    ]
    .concat()
}

fn hold(testbed: &mut Testbed, contact: Contact, cycle: u64) -> u64 {
    testbed.robot_mut().hold_contact(contact, Hold::On, cycle);
    cycle
}

fn read(testbed: &mut Testbed, channel: u8, counts: u16, cycle: u64) -> u64 {
    testbed
        .robot_mut()
        .hold_analog(channel, counts, (cycle, u64::MAX));
    cycle
}

/// Another sender on the wire to the robot, from this cycle on: 750,000 edges a second, for longer than a trial looks.
fn flood(testbed: &mut Testbed, cycle: u64) -> u64 {
    testbed.robot_mut().flood_line(1_500_000, cycle, 1_000);
    cycle
}
