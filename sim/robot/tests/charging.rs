//! The robot on its dock, and a sample of the campaign of charges. `cargo run --release -p robot --example charges -- --seeds
//! 0..10000` runs all of it.

use std::sync::Arc;

use home::{Home, Noise, RobotModel, World};
use robot::charging::{ChargeTally, ChargeTrial, Conditions};
use robot::{ChargeSwitch, RobotSettings, SimulatedRobot};
use rvac_protocol::message::{ChargeEnd, Inhibit};

const HOME: &str = "format = \"librervac-home\"\nversion = 1\n\
    [[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]\n\
    [dock]\nposition = [0.0, 2.0]\nheading-deg = 0.0\n";

fn on_the_dock(charge: f64) -> SimulatedRobot {
    let model = RobotModel::by_name("sr8730").expect("it comes with the project");
    let home = Arc::new(Home::from_floorplan("test", HOME, &model).expect("a valid home"));
    let start = home.start();
    let mut world = World::new(home, &model, &Noise::nominal(), 1, Some(start));
    world.set_battery_charge(charge);
    SimulatedRobot::new(&model, world, &RobotSettings::default())
}

fn run(robot: &mut SimulatedRobot, milliseconds: u32) {
    let mut said = Vec::new();
    for _ in 0..milliseconds {
        robot.tick(&mut said);
        said.clear();
    }
}

#[test]
fn a_robot_that_comes_to_its_dock_is_charged_to_the_full_and_not_beyond() {
    let mut robot = on_the_dock(0.78);
    assert!(robot.world().truth().docked);
    run(&mut robot, 60_000);
    assert!(
        robot.world().truth().battery_a > 0.7,
        "{}",
        robot.world().truth().battery_a
    );
    run(&mut robot, 50 * 60_000);
    let truth = *robot.world().truth();
    assert!(truth.battery_charge > 0.97, "{}", truth.battery_charge);
    assert!(
        truth.battery_a < 0.3,
        "the full current has ended: {} A",
        truth.battery_a
    );
    assert!(truth.battery_hottest_c < 45.0);
    assert_eq!(robot.monitor().count(), 0, "{:?}", robot.monitor().violations());
}

#[test]
fn a_full_robot_is_left_alone() {
    let mut robot = on_the_dock(0.97);
    run(&mut robot, 120_000);
    assert!(robot.world().truth().battery_a <= 0.0);
    assert!(robot.inhibits().contains(Inhibit::Docked));
}

#[test]
fn a_robot_leaves_a_dock_whose_current_does_not_end() {
    let mut robot = on_the_dock(0.5);
    run(&mut robot, 60_000);
    robot.set_charge_switch(ChargeSwitch::Shorted);
    run(&mut robot, 20_000);
    assert!(!robot.world().truth().docked, "it stays off the contacts");
    assert!(robot.inhibits().contains(Inhibit::ChargerShorted));
    assert!(!robot.wheels_driven());
    let away = robot.world().truth().pose;
    run(&mut robot, 30_000);
    assert_eq!(robot.world().truth().pose, away, "and it stays where it is");
    assert_eq!(robot.monitor().count(), 0, "{:?}", robot.monitor().violations());
}

#[test]
#[ignore = "campaign: many charges drawn at random; cargo xtask test --all"]
fn a_sample_of_charges_over_packs_weather_and_trouble() {
    let mut tally = ChargeTally::default();
    for seed in 0..40 {
        let healthy = Conditions::drawn(seed).is_healthy();
        tally.add(&ChargeTrial::Everything.run(seed), healthy);
    }
    assert!(tally.healthy >= 15, "{tally:?}");
    assert_eq!(
        (tally.healthy_short, tally.too_hot, tally.violations),
        (0, 0, 0),
        "{tally:?}"
    );
    assert!(tally.hottest.0 < 55.0 && tally.longest.0 <= 3.6, "{tally:?}");
}

#[test]
fn a_thermistor_that_freezes_before_the_pack_warms_up_is_found_in_time() {
    // A worn pack that was full when only the drop of its voltage could still end the charge.
    let mut tally = ChargeTally::default();
    tally.add(&ChargeTrial::Everything.run(1_439), false);
    assert_eq!(
        tally.ends.keys().copied().collect::<Vec<_>>(),
        ["thermistor-frozen"]
    );
    assert_eq!((tally.too_hot, tally.violations), (0, 0));
    assert!(tally.hottest.0 < 45.0, "{}", tally.hottest.0);
}

#[test]
#[ignore = "campaign: many charges drawn at random; cargo xtask test --all"]
fn no_stop_alone_lets_a_cell_reach_55_degrees_or_a_charge_go_on_for_ever() {
    let stops = [
        ChargeEnd::TemperatureSlope,
        ChargeEnd::NegativeDeltaV,
        ChargeEnd::ZeroDeltaV,
        ChargeEnd::TemperatureRise,
        ChargeEnd::Hot,
        ChargeEnd::Voltage,
        ChargeEnd::Charge,
        ChargeEnd::Time,
    ];
    for stop in stops {
        for seed in 0..2 {
            let outcome = ChargeTrial::Only(stop).run(seed);
            assert!(
                outcome.hottest_c < 55.0 && outcome.violations == 0,
                "{stop:?}: {outcome:?}"
            );
            assert!(outcome.end.is_none_or(|end| end == stop), "{stop:?}: {outcome:?}");
        }
    }
}
