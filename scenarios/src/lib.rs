//! Whole-system tests: firmware, wire, daemon core and brain in a simulated home, on a virtual clock. The tests are in
//! `tests/`; here is what they share.
#![forbid(unsafe_code)]

mod draws;
mod phase;
mod table;
mod watched;

use std::path::PathBuf;

use brain::Brain;
use brain::command::StrategyName;
use home::Pose;
use rvac_sim::run::{RunSettings, start_cleaning};
use rvac_sim::{CalibrationChoice, GyroFitted, Host, Household, Scene, SceneSettings};

pub use draws::{Bounds, Draws};
pub use phase::{household, in_phase};
pub use table::Table;
pub use watched::{JOB_S, Watched, free_place, is_home, recorded, usual};

/// The project's own homes.
pub const HOMES: [&str; 3] = ["furnished-room", "stairs", "two-room-flat"];

/// One of the project's homes with this noise.
///
/// # Panics
/// When it cannot be loaded.
#[must_use]
pub fn scene(home: &str, noise: &str) -> Scene {
    scene_of(project_home(home), noise)
}

/// One of the project's homes with a simulated Relax, as it is sold: it measures no currents and has no gyro.
///
/// # Panics
/// When it cannot be loaded.
#[must_use]
pub fn relax(home: &str) -> Scene {
    scene_with("relax", project_home(home), "nominal")
}

/// A place beside the dock of a home, from which the robot neither touches it nor looks at it.
#[must_use]
pub fn off_the_dock(scene: &Scene) -> Pose {
    scene.home().start().then(Pose::new(-0.6, 0.0, 2.0))
}

/// The generated home of this number with nominal noise.
///
/// # Panics
/// When there is none.
#[must_use]
pub fn generated(number: u32) -> Scene {
    generated_with(number, "nominal")
}

/// The generated home of this number with this noise.
///
/// # Panics
/// When there is none.
#[must_use]
pub fn generated_with(number: u32, noise: &str) -> Scene {
    scene_of(PathBuf::from(format!("generated:{number}")), noise)
}

/// The same with people who walk about in it, stand in the way and leave.
///
/// # Panics
/// When there is none.
#[must_use]
pub fn peopled(number: u32) -> Scene {
    scene_of(PathBuf::from(format!("generated:{number}+people")), "nominal")
}

/// The home that this file holds, with nominal noise.
///
/// # Panics
/// When it cannot be loaded.
#[must_use]
pub fn scene_in(file: PathBuf) -> Scene {
    scene_of(file, "nominal")
}

fn project_home(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../homes/{name}.toml"))
}

fn scene_of(home: PathBuf, noise: &str) -> Scene {
    scene_with("sr8730", home, noise)
}

fn scene_with(robot: &str, home: PathBuf, noise: &str) -> Scene {
    Scene::load(&SceneSettings {
        home,
        robot: robot.to_owned(),
        noise: noise.to_owned(),
        firmware: None,
        record: CalibrationChoice::Complete,
        gyro: GyroFitted::default(),
    })
    .expect("the project's homes suit the project's robot")
}

/// A run of so many milliseconds.
#[must_use]
pub fn settings(seed: u64, duration_ms: u64) -> RunSettings {
    RunSettings {
        strategy: StrategyName::Bounce,
        pattern: None,
        seed,
        duration_ms,
    }
}

/// A household that was asked to clean a moment ago.
///
/// # Panics
/// When the host does not find the robot.
#[must_use]
pub fn cleaning(scene: &Scene, seed: u64) -> Household {
    let mut household = household(scene, &settings(seed, 0));
    assert!(
        start_cleaning(&mut household, StrategyName::Bounce),
        "the host finds the robot"
    );
    household
}

/// The brain of the host.
///
/// # Panics
/// When no host lives, or it has found no robot yet.
#[must_use]
pub fn brain(household: &Household) -> &Brain {
    household.host().and_then(Host::brain).expect("a brain")
}

/// Whether a line of the log contains this; the log is kept from [`Host::keep_log`] on.
#[must_use]
pub fn says(household: &Household, what: &str) -> bool {
    let log = household.host().map_or(&[][..], Host::log);
    log.iter().any(|entry| entry.text.contains(what))
}
