//! When the link of a robot begins. Whatever changes a byte at the start of a session shifts the moments of all reports after it, and
//! the run becomes another draw of the same distribution. A test that judges the robot rather than one draw passes in every phase.

use rvac_sim::run::RunSettings;
use rvac_sim::{Household, Scene};

/// The variable of the environment that sets the phase of all scenarios: a number from 0. The tables of outcomes hold for 0 alone, which
/// it is without the variable.
const VARIABLE: &str = "SCENARIO_PHASE";
/// Milliseconds of a phase. Pauses of the handshake swallow less than 39 ms; from there on each makes another draw.
const PHASE_MS: u32 = 41;

/// The phase of this run of the tests.
///
/// # Panics
/// When the variable holds no such number.
fn phase() -> u32 {
    let text = std::env::var(VARIABLE).unwrap_or_else(|_| "0".to_owned());
    let phase = text.parse::<u8>();
    phase.map_or_else(
        |_| panic!("{VARIABLE} is a number from 0 to 255, for example 3, and not `{text}`"),
        u32::from,
    )
}

/// The same household, whose link begins as late as the phase says.
#[must_use]
pub fn in_phase(mut household: Household) -> Household {
    household.robot_mut().hold_line(PHASE_MS * phase());
    household
}

/// A household whose robot was just switched on.
#[must_use]
pub fn household(scene: &Scene, settings: &RunSettings) -> Household {
    in_phase(rvac_sim::run::household(scene, settings))
}
