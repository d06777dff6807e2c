//! What the tests share: homes from text, drives, long steps.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use home::{Actuation, Bridge, Home, Noise, Pose, RobotModel, World};

pub(crate) const HEAD: &str = "format = \"librervac-home\"\nversion = 1\n";

pub(crate) fn sr8730() -> RobotModel {
    RobotModel::by_name("sr8730").expect("it comes with the project")
}

/// A home from the text of our own format, without its head.
pub(crate) fn home(body: &str) -> Arc<Home> {
    Arc::new(
        Home::from_floorplan("test", &format!("{HEAD}{body}"), &sr8730())
            .expect("the test drew a valid home"),
    )
}

/// An empty rectangular room with its lower left corner at the file's origin.
pub(crate) fn room(width_m: f64, height_m: f64) -> String {
    format!(
        "[[room]]\npolygon = [[0.0, 0.0], [{width_m}, 0.0], [{width_m}, {height_m}], [0.0, {height_m}]]\n"
    )
}

/// A pose given in the frame of the file.
pub(crate) fn at(home: &Home, x_m: f64, y_m: f64, heading_rad: f64) -> Pose {
    home.file_from_plan()
        .inverse()
        .then(Pose::new(x_m, y_m, heading_rad))
}

pub(crate) fn ideal(home: &Arc<Home>, start: Pose) -> World {
    World::new(home.clone(), &sr8730(), &Noise::ideal(), 1, Some(start))
}

pub(crate) fn drive(left: f64, right: f64) -> Actuation {
    let wheel = |pwm| Bridge { pwm, brake: true };
    Actuation {
        wheel_left: wheel(left),
        wheel_right: wheel(right),
        cliff_emitter: true,
        ..Actuation::default()
    }
}

pub(crate) fn steps(world: &mut World, milliseconds: u32, actuation: Actuation) {
    for _ in 0..milliseconds {
        world.step(&actuation);
    }
}

/// A file of this test binary.
pub(crate) fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).expect("the folder of test files takes them");
    path
}
