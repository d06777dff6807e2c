//! Two homes as floors of one, on a virtual clock: a robot that is put down finds out where it is, one that is carried to the
//! other floor goes on there, and on a third one that nobody has mapped it asks.

use brain::StoredMap;
use brain::command::StrategyName;
use home::Pose;
use robot::RobotSettings;
use rvac_api::{FloorsView, RequestBody};
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, in_phase, off_the_dock, scene, settings};
use vthal_core::{CoreConfig, KeptFloor};

/// The floors 1 and 2.
const FLOORS: [&str; 2] = ["furnished-room", "two-room-flat"];
const MINUTE_MS: u64 = 60_000;

/// The map of a home as its robot knows it, whose origin is where the robot starts.
fn map_of(name: &str) -> StoredMap {
    let mut household = household(&scene(name, "nominal"), &settings(1, 0)).with_known_map();
    household.pass_ms(3_000);
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.map().stored()
}

/// A robot at a place of a home, or on its dock, whose host keeps the maps of both floors.
fn put_down(name: &str, place: Option<Pose>) -> Household {
    let scene = scene(name, "nominal");
    let robot = scene.robot_at(place, 5, &RobotSettings::default());
    let floors = (1..).zip(FLOORS).map(|(number, name)| KeptFloor {
        home: Some(map_of(name)),
        ..KeptFloor::new(number)
    });
    let config = CoreConfig {
        sensors: scene.sensors(),
        floors: floors.collect(),
        ..Host::config(5, StrategyName::Systematic)
    };
    in_phase(Household::new(robot, Host::start(0, config)))
}

fn floors(household: &Household) -> FloorsView {
    household.host().map(Host::floors).unwrap_or_default()
}

/// Lets it clean until it knows its floor or asks for it; at most so many minutes.
fn until_told(household: &mut Household, minutes: u64) -> FloorsView {
    household.pass_until(minutes * 60, |household| {
        let view = floors(household);
        view.here.is_some() || view.question.is_some()
    });
    floors(household)
}

/// How far the believed place is from the true one in the map of a home.
fn off_m(household: &Household, name: &str) -> f64 {
    let start = scene(name, "nominal").home().start();
    let truth = start.inverse().then(household.robot().world().truth().pose);
    let believed = household.host().map(Host::pose).unwrap_or_default();
    Pose::new(believed.x, believed.y, believed.heading).distance_m(truth)
}

fn middle_of(name: &str) -> Pose {
    off_the_dock(&scene(name, "nominal"))
}

#[test]
fn a_robot_that_is_put_down_knows_its_floor_and_place_after_some_way_and_goes_on_there() {
    for (number, name) in (1..).zip(FLOORS) {
        let mut household = put_down(name, Some(middle_of(name)));
        start_cleaning(&mut household, StrategyName::Systematic);
        let view = until_told(&mut household, 10);
        assert_eq!((view.here, view.question), (Some(number), None), "{name}");
        assert!(off_m(&household, name) < 0.25, "{} m", off_m(&household, name));
        household.pass_ms(MINUTE_MS);
        assert_eq!(
            household.host().map(|host| host.status().state).as_deref(),
            Some("cleaning")
        );
        assert!(off_m(&household, name) < 0.25, "{} m", off_m(&household, name));
    }
}

#[test]
fn on_a_floor_that_nobody_has_mapped_it_asks_and_what_it_drew_becomes_the_new_floor() {
    let mut household = put_down("stairs", Some(middle_of("stairs")));
    start_cleaning(&mut household, StrategyName::Systematic);
    let view = until_told(&mut household, 15);
    assert_eq!(view.here, None);
    assert_eq!(view.question.expect("is asked").reason, "floor-unknown");
    household.ask(RequestBody::NewFloor {
        name: Some("Stairs".to_owned()),
    });
    let view = floors(&household);
    assert_eq!((view.here, view.sought, view.question), (Some(3), false, None));
    let drawn_m2 = |household: &Household| {
        household
            .host()
            .and_then(Host::brain)
            .map_or(0.0, |brain| brain.map().free_m2())
    };
    assert!(drawn_m2(&household) > 2.0, "{} m2", drawn_m2(&household));
    assert_eq!(
        household.host().map(|host| host.status().state).as_deref(),
        Some("cleaning")
    );
}

#[test]
fn a_robot_that_is_carried_to_the_other_floor_while_it_works_goes_on_there() {
    let mut first = put_down(FLOORS[0], None);
    first.pass_ms(5_000);
    first.ask(RequestBody::ChooseFloor { floor: 1 });
    start_cleaning(&mut first, StrategyName::Systematic);
    assert_eq!(until_told(&mut first, 10).here, Some(1));
    first.pass_ms(MINUTE_MS);
    first.robot_mut().world_mut().lift();
    first.pass_ms(3_000);
    let mut second = put_down(FLOORS[1], Some(middle_of(FLOORS[1])));
    second.kill_host();
    second.robot_mut().world_mut().lift();
    second.pass_ms(first.robot().now_ms() + 1_000);
    second.revive_host(first.kill_host().expect("lives"));
    second.pass_ms(3_000);
    second.robot_mut().world_mut().put_down_at(middle_of(FLOORS[1]));
    second.pass_ms(3_000);
    second.ask(RequestBody::Resume);
    let mut seconds = 0;
    while floors(&second).here != Some(2) && seconds < 900 {
        second.pass_ms(1_000);
        seconds += 1;
    }
    assert_eq!(floors(&second).here, Some(2));
    assert!(
        off_m(&second, FLOORS[1]) < 0.25,
        "{} m",
        off_m(&second, FLOORS[1])
    );
}
