//! A robot that was put down askew: the map's axes are its own, and the walls are not along them.
#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use brain::command::StrategyName;
use home::Pose;
use robot::RobotSettings;
use rvac_sim::run::start_cleaning;
use rvac_sim::{GyroFitted, Host, Household, Record, Scene, SceneSettings};
use vthal_core::CoreConfig;

const HOME: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../homes/two-room-flat.toml");
/// Some 1.6 times the least time that the flat takes.
const WORK_MS: u64 = 560_000;
/// Lanes that are not along the walls sweep 0.06 less in that time (0.886 instead of 0.947 at 0.3 rad).
const LESS: f64 = 0.055;

/// Mean share that robots sweep of the known flat which began turned by so much.
fn covered(turned_rad: f64) -> f64 {
    let scene = Scene::load(&SceneSettings {
        home: HOME.into(),
        robot: "sr8730".to_owned(),
        noise: "nominal".to_owned(),
        firmware: None,
        record: Record::Complete,
        gyro: GyroFitted::Placeholder,
    })
    .unwrap();
    let dock = scene.home().dock().unwrap();
    let (x_m, y_m) = dock.point(1.0, 0.3);
    let seeds = 1..=3_u64;
    let sum: f64 = seeds
        .clone()
        .map(|seed| {
            let settings = RobotSettings {
                seed,
                ..RobotSettings::default()
            };
            let start = Pose::new(x_m, y_m, dock.heading_rad + turned_rad);
            let robot = scene.robot_at(Some(start), seed, &settings);
            let config = CoreConfig {
                sensors: scene.sensors(),
                ..Host::config(seed, StrategyName::Systematic)
            };
            let mut household = Household::new(robot, Host::start(0, config)).with_known_map();
            household.pass_ms(3_000);
            start_cleaning(&mut household, StrategyName::Systematic);
            household.pass_ms(WORK_MS);
            household.report().covered
        })
        .sum();
    sum / seeds.count() as f64
}

#[test]
fn it_sweeps_as_much_as_one_that_was_put_down_along_the_walls() {
    let along = covered(0.0);
    for turned_rad in [0.3, 0.7] {
        let askew = covered(turned_rad);
        assert!(
            askew > along - LESS,
            "{turned_rad}: {askew}, along the walls {along}"
        );
    }
}
