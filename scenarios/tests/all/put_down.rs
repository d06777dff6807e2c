//! A robot that people put down against furniture and walls, and send off from there.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use brain::command::StrategyName;
use brain::{BehaviorState, Brain};
use home::{Home, Pose};
use rvac_api::RequestBody;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household, Scene};
use scenarios::{generated, household, relax, scene, settings};

/// The body of the SR8730, metres.
const RADIUS_M: f64 = 0.175;
/// Directions of the nose from what is nearest, radians.
const OFF_RAD: [f64; 5] = [0.0, 0.7, -0.7, 1.2, -1.2];

/// Every nth place of a home at which the body all but touches something, with the nose against it.
fn places_against(home: &Home, every: usize) -> Vec<Pose> {
    let raster = (0..130).flat_map(|x| (0..130).map(move |y| (0.07 * f64::from(x), 0.07 * f64::from(y))));
    let beside = raster.filter(|&(x_m, y_m)| {
        let clear_m = home.clearance_m(x_m, y_m);
        clear_m > RADIUS_M + 0.001 && clear_m < RADIUS_M + 0.015
    });
    let against = |(place, (x_m, y_m)): (usize, (f64, f64))| {
        let nearest_rad = nearest_rad(home, x_m, y_m);
        let (sin, cos) = nearest_rad.sin_cos();
        Pose::new(
            x_m + 0.02 * cos,
            y_m + 0.02 * sin,
            nearest_rad + OFF_RAD[place % OFF_RAD.len()],
        )
    };
    beside.step_by(every).enumerate().map(against).collect()
}

/// Direction in which the clearance shrinks most.
fn nearest_rad(home: &Home, x_m: f64, y_m: f64) -> f64 {
    let clear_m = |rad: &f64| home.clearance_m(x_m + 0.05 * rad.cos(), y_m + 0.05 * rad.sin());
    let directions = (0..72).map(|step| TAU * f64::from(step) / 72.0);
    directions
        .min_by(|a, b| clear_m(a).total_cmp(&clear_m(b)))
        .unwrap_or_default()
}

fn state(household: &Household) -> (BehaviorState, &'static str) {
    let status = household.host().and_then(Host::brain).map(Brain::status);
    status.map_or((BehaviorState::Error, "no brain"), |status| {
        (status.state, status.reason.name())
    })
}

/// A household whose robot was carried to a place and sent off there.
fn carried_and_sent(scene: &Scene, knows_home: bool, strategy: StrategyName, place: Pose) -> Household {
    let mut household = household(scene, &settings(1, 0));
    if knows_home {
        household = household.with_known_map();
    }
    household.pass_ms(500);
    household.robot_mut().world_mut().lift();
    household.pass_ms(1_500);
    household.robot_mut().world_mut().put_down_at(place);
    household.pass_ms(1_500);
    let sent = start_cleaning(&mut household, strategy);
    assert!(sent, "{place:?}: the host finds the robot");
    household
}

fn check_all_come_free(name: &str, scene: &Scene, every: usize, strategy: StrategyName) {
    let places = places_against(scene.home(), every);
    assert!(places.len() >= 5, "{name}: {} places", places.len());
    for place in places {
        for knows_home in [false, true] {
            let mut household = carried_and_sent(scene, knows_home, strategy, place);
            household.pass_ms(40_000);
            let found = state(&household);
            assert_eq!(
                found.0,
                BehaviorState::Cleaning,
                "{name}, knows its home: {knows_home}, {place:?}: {found:?}"
            );
        }
    }
}

/// The rest in which a first run measures the gyro's bias must not begin against a wall: a bumper that is pressed for ten seconds counts as
/// stuck.
#[test]
fn a_robot_that_is_put_down_against_something_comes_free() {
    for home in ["furnished-room", "two-room-flat"] {
        check_all_come_free(home, &scene(home, "nominal"), 19, StrategyName::Systematic);
    }
    check_all_come_free("generated 9", &generated(9), 67, StrategyName::Systematic);
    check_all_come_free("Relax", &relax("two-room-flat"), 19, StrategyName::Bounce);
}

/// The dock's contacts stay silent then, and the nose may touch the dock.
#[test]
fn a_robot_that_is_set_on_its_dock_the_wrong_way_round_or_beside_it_sets_out() {
    let ways = [
        ("wrong way round", Pose::new(0.0, 0.0, PI)),
        ("across, to the left", Pose::new(0.0, 0.0, FRAC_PI_2)),
        ("across, to the right", Pose::new(0.0, 0.0, -FRAC_PI_2)),
        ("beside it, left", Pose::new(0.0, 0.35, 0.0)),
        ("beside it, right", Pose::new(0.0, -0.35, 0.0)),
        ("askew", Pose::new(0.02, 0.08, 0.3)),
        ("a little off", Pose::new(-0.03, 0.0, 0.0)),
    ];
    for home in ["furnished-room", "two-room-flat"] {
        let scene = scene(home, "nominal");
        for (way, off) in ways {
            let place = scene.home().start().then(off);
            for knows_home in [false, true] {
                let mut household = carried_and_sent(&scene, knows_home, StrategyName::Systematic, place);
                household.pass_ms(60_000);
                let found = state(&household);
                let way_m = household.robot().world().truth().path_m;
                assert!(
                    found.0 == BehaviorState::Cleaning && way_m > 0.5,
                    "{home}, {way}, knows its home: {knows_home}: {found:?} after {way_m:.2} m"
                );
            }
        }
    }
}

/// Nothing behind it is known, and it has backed as far as it may. What one bumper touches is left by a turn on the spot all the same.
#[test]
fn a_robot_that_may_not_back_turns_away_from_what_one_bumper_touches() {
    let scene = scene("two-room-flat", "nominal");
    let beside = places_against(scene.home(), 9)
        .into_iter()
        .enumerate()
        .filter(|(place, _)| place % OFF_RAD.len() >= 3);
    let mut tried = 0;
    for (_, place) in beside {
        let mut household = household(&scene, &settings(1, 0));
        household.pass_ms(500);
        household.robot_mut().world_mut().turn_wheels(Some([-0.1, -0.1]));
        household.pass_ms(3_000);
        household.robot_mut().world_mut().turn_wheels(None);
        household.robot_mut().world_mut().put_down_at(place);
        household.pass_ms(1_000);
        let before = household.robot().world().truth().pose;
        start_cleaning(&mut household, StrategyName::Systematic);
        let turned = household.pass_until(10, |household| {
            let now = household.robot().world().truth().pose;
            (now.heading_rad - before.heading_rad).abs() > 0.15
        });
        assert!(turned.is_some(), "{place:?}: {:?}", state(&household));
        tried += 1;
    }
    assert!(tried >= 4, "{tried} places");
}

/// A robot that rests is disarmed: what turns its wheels is a hand then, and no fault of its electronics.
#[test]
fn a_paused_robot_may_be_pushed_about_and_leaned_against_a_wall() {
    let scene = scene("two-room-flat", "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.pass_ms(500);
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.pass_ms(60_000);
    household.ask(RequestBody::Pause);
    household.pass_ms(4_000);
    for rims_m_per_s in [[-0.2, -0.2], [-0.15, 0.15], [0.2, 0.2]] {
        let world = household.robot_mut().world_mut();
        world.turn_wheels(Some(rims_m_per_s));
        household.pass_ms(2_000);
    }
    household.robot_mut().world_mut().turn_wheels(None);
    assert_eq!(state(&household), (BehaviorState::Paused, "command"));
    let against = places_against(scene.home(), 19)[0];
    household.robot_mut().world_mut().put_down_at(against);
    household.pass_ms(30_000);
    assert_eq!(state(&household), (BehaviorState::Paused, "command"));
    household.ask(RequestBody::Resume);
    household.pass_ms(15_000);
    assert_eq!(state(&household).0, BehaviorState::Cleaning);
}
