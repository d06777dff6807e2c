//! When the link of a robot begins, to the millisecond. Whatever changes a byte at the start of a session shifts the moments of all
//! reports after it, and the run becomes another draw of the same distribution. A test that judges the robot rather than one draw passes
//! in every phase.

use rvac_sim::run::RunSettings;
use rvac_sim::{Household, Scene};

/// The variable of the environment that sets the phase of all scenarios. It is 0 without it, and the tables of outcomes hold for that one
/// alone.
const VARIABLE: &str = "SCENARIO_PHASE";

/// The phase of this run of the tests, milliseconds.
///
/// # Panics
/// When the variable holds no number.
fn phase_ms() -> u32 {
    let text = std::env::var(VARIABLE).unwrap_or_default();
    if text.is_empty() {
        return 0;
    }
    text.parse()
        .unwrap_or_else(|_| panic!("{VARIABLE} is a number of milliseconds, for example 3, and not `{text}`"))
}

/// The same household, whose link begins so late as the phase says.
#[must_use]
pub fn in_phase(mut household: Household) -> Household {
    household.robot_mut().hold_line(phase_ms());
    household
}

/// A household whose robot was just switched on.
#[must_use]
pub fn household(scene: &Scene, settings: &RunSettings) -> Household {
    in_phase(rvac_sim::run::household(scene, settings))
}
