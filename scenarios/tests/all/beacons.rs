//! Radio beacons on a virtual clock. A flat of two rooms is alike to a robot, turned by half a turn: what it sees cannot tell them
//! apart after somebody has carried it, and how strongly it receives beacons can. And a robot that has no gyro keeps its place by
//! how far beacons are.

use std::sync::Arc;

use brain::PoseEstimate;
use brain::command::StrategyName;
use home::{Home, Noise, Pose, RobotModel};
use robot::RobotSettings;
use rvac_api::RequestBody;
use rvac_sim::run::{core_config, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use scenarios::{cleaning, in_phase, relax};

const SEED: u64 = 6;
const MINUTE_MS: u64 = 60_000;
/// Longest wait for a robot to know its place, seconds.
const WAIT_S: u64 = 300;
/// Beacons at the edges of the flat.
const BEACONS: usize = 4;
/// Two rooms of 3 m by 3.4 m with a door in the middle of the wall between them.
const TWINS: &str = "format = \"librervac-home\"\nversion = 1\nname = \"Twins\"\n\
    [[room]]\npolygon = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.4], [0.0, 3.4]]\n\
    [[room]]\npolygon = [[3.1, 0.0], [6.1, 0.0], [6.1, 3.4], [3.1, 3.4]]\n\
    [[wall]]\nfrom = [3.05, 0.0]\nto = [3.05, 3.4]\nthickness-m = 0.1\n\
    [[door]]\nfrom = [3.05, 1.25]\nto = [3.05, 2.15]\nstate = \"open\"\n";

fn twins() -> Scene {
    let model = RobotModel::by_name("sr8730").expect("the project's robot");
    let home = Home::from_floorplan("twins", TWINS, &model).expect("a plan");
    Scene::new(Arc::new(home), model, Noise::nominal())
}

fn household(scene: &Scene) -> Household {
    let settings = RobotSettings {
        seed: SEED,
        ..RobotSettings::default()
    };
    let config = core_config(scene, SEED, StrategyName::Systematic);
    in_phase(Household::new(
        scene.robot(SEED, &settings),
        Host::start(0, config),
    ))
    .with_known_map()
}

/// Lets it clean both rooms, carries it to a place of the second one, and waits until it says that it knows its place; gives by how
/// much that is wrong, metres.
fn off_after_lifting_m(scene: &Scene, mut household: Household) -> Option<f64> {
    start_cleaning(&mut household, StrategyName::Systematic);
    household.pass_ms(6 * MINUTE_MS);
    household.robot_mut().world_mut().lift();
    household.pass_ms(3_000);
    household
        .robot_mut()
        .world_mut()
        .put_down_at(Pose::new(4.9, 0.8, 2.5));
    household.pass_ms(3_000);
    household.ask(RequestBody::Resume);
    household.pass_ms(1_000);
    household.pass_until(WAIT_S, |household| !estimate(household).lost)?;
    Some(off_m(scene, &household))
}

fn estimate(household: &Household) -> PoseEstimate {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.estimate()
}

/// By how much the robot is wrong about its place, metres.
fn off_m(scene: &Scene, household: &Household) -> f64 {
    let truth = household.robot().world().truth().pose;
    let in_map = scene.home().start().inverse().then(truth);
    let pose = estimate(household).pose;
    Pose::new(pose.x_m, pose.y_m, pose.heading_rad).distance_m(in_map)
}

#[test]
fn strengths_of_beacons_tell_rooms_apart_that_look_the_same() {
    let scene = twins();
    let by_sight = off_after_lifting_m(&scene, household(&scene));
    assert!(
        by_sight.is_none_or(|off_m| off_m > 1.0),
        "it may not have known: {by_sight:?}"
    );
    let beacons = scene.beacons(SEED, BEACONS).by_strength();
    let by_strength = off_after_lifting_m(&scene, household(&scene).with_beacons(beacons));
    assert!(by_strength.is_some_and(|off_m| off_m < 0.25), "{by_strength:?}");
}

/// Drivings by chance, and how long each takes.
const DRIVINGS: [u64; 4] = [1, 2, 3, 4];
const DRIVEN_MS: u64 = 6 * MINUTE_MS;
/// How often its place is compared with the true one.
const LOOK_MS: u64 = 1_000;
/// Metres by which a place by beacons is off in the last minute, at most; by wheels alone it is off by more in one of these drivings.
const OFF_MAX_M: f64 = 1.0;

/// By how much a Relax that bounces about is wrong about its place, metres: the median of the last minute.
fn off_in_the_last_minute_m(scene: &Scene, seed: u64, beacons: usize) -> f64 {
    let mut household = cleaning(scene, seed).with_beacons(scene.beacons(seed, beacons));
    household.pass_ms(DRIVEN_MS - MINUTE_MS);
    let mut all_off_m: Vec<f64> = (0..MINUTE_MS / LOOK_MS)
        .map(|_| {
            household.pass_ms(LOOK_MS);
            off_m(scene, &household)
        })
        .collect();
    all_off_m.sort_by(f64::total_cmp);
    all_off_m[all_off_m.len() / 2]
}

#[test]
fn a_relax_without_gyro_keeps_its_place_by_how_far_beacons_are() {
    let scene = relax("two-room-flat");
    let worst_m = |beacons| {
        let all_off_m = DRIVINGS.map(|seed| off_in_the_last_minute_m(&scene, seed, beacons));
        all_off_m.into_iter().fold(0.0, f64::max)
    };
    let (heard_m, alone_m) = (worst_m(BEACONS), worst_m(0));
    assert!(
        heard_m < OFF_MAX_M && alone_m > OFF_MAX_M,
        "{heard_m} m off, {alone_m} m without beacons"
    );
}
