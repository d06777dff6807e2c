//! What the robot tells about itself: the monitor compares it with what its sensors show.

use home::{SensorFault, SensorId};

use super::{fault, press};
use crate::limits;
use crate::scene::OperatingState::{Cleaning, Driving, Standing};
use crate::trial::Expectation::Lawful;
use crate::trial::Trial;

/// A proximity sensor beside the front.
const NEAR: u8 = 2;
/// The battery is told once a second, and must be told wrongly three times.
const WATCH_MS: u64 = 4_000;

pub(super) fn trials() -> Vec<Trial> {
    vec![
        Trial::new(
            "nothing-happens",
            "nothing happens for four seconds, and nothing false is told",
            Cleaning,
            |testbed, cycle| {
                testbed.run(1);
                cycle
            },
        )
        .expects(Lawful, limits::REPORTS_TOLD)
        .watched_for(WATCH_MS),
        Trial::new(
            "something-near",
            "something comes near, and is told at its own sensor",
            Driving,
            |testbed, _| fault(testbed, SensorId::Proximity(NEAR), SensorFault::StuckAt(255)),
        )
        .expects(Lawful, limits::REPORTS_TOLD)
        .watched_for(900),
        Trial::new(
            "button-named",
            "a button is pressed, and told by its number",
            Standing,
            |testbed, _| press(testbed),
        )
        .expects(Lawful, limits::REPORTS_TOLD)
        .watched_for(500),
    ]
}
