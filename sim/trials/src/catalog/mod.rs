//! All trials, by what goes wrong. Their names stand in protocol/rules.toml.

mod arming;
mod contacts;
mod hardware;
mod link;
mod motors;
mod power;
mod reports;

use home::{SensorFault, SensorId};
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
        reports::trials(),
    ]
    .concat()
}

fn hold(testbed: &mut Testbed, contact: Contact, cycle: u64) -> u64 {
    testbed.robot_mut().hold_contact(contact, Hold::On, cycle);
    cycle
}

fn fault(testbed: &mut Testbed, sensor: SensorId, fault: SensorFault) -> u64 {
    testbed.robot_mut().world_mut().set_fault(sensor, Some(fault));
    testbed.robot().cycle()
}

/// One button of several.
const BUTTON: u8 = 1;

/// A person presses it: both the line of all buttons and its own level on the ladder show that.
fn press(testbed: &mut Testbed) -> u64 {
    fault(testbed, SensorId::Button(BUTTON), SensorFault::StuckAt(1))
}

/// Another sender on the wire to the robot, from this cycle on: 750,000 edges a second, for longer than a trial looks.
fn flood(testbed: &mut Testbed, cycle: u64) -> u64 {
    testbed.robot_mut().flood_line(1_500_000, cycle, 1_000);
    cycle
}
