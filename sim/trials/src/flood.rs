//! Edges that flood the receive pin of the real firmware, as a console at 1.5 Mbaud on the same wire makes them.

use pic32::board::CYCLES_PER_MS;
use rvac_units::{AngularSpeed, Speed};
use serde::Serialize;

use crate::limits;
use crate::scene::OperatingState;
use crate::testbed::{Fixture, Testbed, TestbedError};

/// Random bits at this rate have 750,000 edges a second.
const BAUD: u32 = 1_500_000;
/// cordlib's reaction times need a pass every 5 ms at least; a loop that sleeps makes one in a millisecond at most.
const STEPS_MIN_HZ: u32 = 400;
/// The host notices, asks again, and the robot has measured its rate.
const RECOVER_MS: u64 = 10_000;

/// What a flood did.
#[derive(Clone, Debug, Serialize)]
pub struct FloodResult {
    /// Number of the flood.
    pub seed: u64,
    /// How long it lasted.
    pub seconds: u64,
    /// From its beginning until the wheels were off.
    pub wheels_off_ms: u64,
    /// Main loop before it, and the slowest second during it.
    pub steps_before_hz: u32,
    /// As above.
    pub steps_hz: Option<u32>,
    /// Resets of the chip; the watchdog's are among them.
    pub resets: u32,
    /// Breaches that the monitor saw.
    pub violations: u32,
    /// From its end until the host drove the robot again; `None` = it did not.
    pub recovered_ms: Option<u64>,
}

impl FloodResult {
    /// Whether it is as it must be.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.wheels_off_ms <= u64::from(limits::S1_SILENCE.ms)
            && self.resets == 0
            && self.violations == 0
            && self.steps_hz.is_some_and(|hz| hz >= STEPS_MIN_HZ)
            && self.recovered_ms.is_some()
    }
}

/// Floods the receive pin of a robot that drives, at a phase that follows from `seed`.
///
/// # Errors
/// When the robot does not come to drive.
pub fn flood(fixture: &Fixture, seed: u64, seconds: u64) -> Result<FloodResult, TestbedError> {
    let phase = seed.wrapping_mul(7_919) % CYCLES_PER_MS;
    let mut testbed = OperatingState::Driving.set(fixture, seed, phase)?;
    testbed.run(seed % 100);
    let (resets, violations) = (testbed.robot().resets(), testbed.robot().monitor().count());
    let mut result = FloodResult {
        seed,
        seconds,
        wheels_off_ms: 0,
        steps_before_hz: testbed.steps_hz().unwrap_or(0),
        steps_hz: None,
        resets: 0,
        violations: 0,
        recovered_ms: None,
    };
    let cycle = testbed.robot().cycle() + phase;
    testbed
        .robot_mut()
        .flood_line(BAUD, cycle, (seconds * 1_000) as u32);
    for passed in 1..=seconds * 1_000 {
        testbed.tick();
        if testbed.robot().wheels_driven() {
            result.wheels_off_ms = passed;
        }
        // The first report after its beginning is of a second that lies partly before it.
        if let Some(hz) = testbed.steps_hz().filter(|_| passed > 2_000) {
            result.steps_hz = Some(result.steps_hz.map_or(hz, |least| least.min(hz)));
        }
    }
    result.recovered_ms = recover(&mut testbed);
    result.resets = testbed.robot().resets() - resets;
    result.violations = testbed.robot().monitor().count() - violations;
    Ok(result)
}

/// Milliseconds until the host has the robot driving again.
fn recover(testbed: &mut Testbed) -> Option<u64> {
    testbed.drive(None);
    for passed in 0..RECOVER_MS {
        if passed % 200 == 0 && testbed.is_connected() {
            testbed.arm();
            testbed.drive(Some((Speed(150_000), AngularSpeed(0))));
        }
        testbed.tick();
        if testbed.robot().wheels_driven() {
            return Some(passed);
        }
    }
    None
}
