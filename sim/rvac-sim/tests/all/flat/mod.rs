//! The two-room flat, and a robot in it with its map.

use brain::command::StrategyName;
use home::Pose;
use robot::RobotSettings;
use rvac_sim::{CalibrationChoice, GyroFitted, Host, Household, Scene, SceneSettings};
use vthal_core::CoreConfig;

const HOME: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../homes/two-room-flat.toml");

/// The flat with nominal noise.
pub(crate) fn scene() -> Scene {
    Scene::load(&SceneSettings {
        home: HOME.into(),
        robot: "sr8730".to_owned(),
        noise: "nominal".to_owned(),
        firmware: None,
        record: CalibrationChoice::Complete,
        gyro: GyroFitted::Placeholder,
    })
    .unwrap()
}

/// A robot three seconds after its start, on the dock where no place is given, that has the map and keeps its log.
pub(crate) fn household(scene: &Scene, start: Option<Pose>, seed: u64) -> Household {
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let robot = scene.robot_at(start, seed, &settings);
    let config = CoreConfig {
        sensors: scene.sensors(),
        ..Host::config(seed, StrategyName::Systematic)
    };
    let mut host = Host::start(0, config);
    host.keep_log();
    let mut household = Household::new(robot, host).with_known_map();
    household.pass_ms(3_000);
    household
}
