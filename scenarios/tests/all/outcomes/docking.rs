//! The way home: with a map and without, after the robot was carried elsewhere, and for charge.

use brain::Brain;
use brain::command::StrategyName;
use home::BeamStrengths;
use rvac_api::RequestBody;
use rvac_sim::{Host, Household};
use scenarios::{JOB_S, Table, Watched, generated_with, is_home, scene};

/// Longest way home, seconds.
const HOME_S: u64 = 15 * 60;
/// Longest charge, seconds.
const CHARGE_S: u64 = 4 * 60 * 60;

fn send_home(watched: &mut Watched) {
    watched.start(RequestBody::Dock);
    watched.come_home(HOME_S);
}

#[test]
fn ways_home() {
    let mut table = Table::of_outcomes("ways-home", "sent home from somewhere");
    for seed in [1, 2] {
        let mut watched = Watched::somewhere(&scene("two-room-flat", "nominal"), seed).knowing_home();
        send_home(&mut watched);
        table.row(&format!("two-room-flat nominal, map, seed {seed}"), &watched);

        let mut watched = Watched::somewhere(&scene("two-room-flat", "bad"), seed);
        send_home(&mut watched);
        table.row(&format!("two-room-flat bad, no map, seed {seed}"), &watched);

        let mut watched = Watched::somewhere(&generated_with(14, "bad"), seed).knowing_home();
        let world = watched.household_mut().robot_mut().world_mut();
        world.set_dock_beams(BeamStrengths::POOR);
        world.push_dock(0.05, 0.05);
        send_home(&mut watched);
        table.row(
            &format!("generated:14 bad, map, pushed dock, seed {seed}"),
            &watched,
        );

        let mut watched = Watched::somewhere(&generated_with(14, "nominal"), seed);
        send_home(&mut watched);
        table.row(&format!("generated:14 nominal, no map, seed {seed}"), &watched);
    }
    table.compare();
}

#[test]
fn carried_elsewhere() {
    let mut table = Table::of_outcomes("carried", "carried elsewhere in the middle of systematic");
    for (seed, home, noise) in [(1, "two-room-flat", "nominal"), (2, "furnished-room", "bad")] {
        let what = |text: &str| format!("{home} {noise}, {text}");
        let scene = scene(home, noise);

        let mut watched = Watched::new(&scene, seed).knowing_home();
        watched.clean(Some(StrategyName::Systematic));
        watched.pass_s(90);
        watched.carry(seed);
        send_home(&mut watched);
        table.row(&what("map, sent home"), &watched);

        let mut watched = Watched::new(&scene, seed).knowing_home();
        watched.clean(Some(StrategyName::Systematic));
        watched.pass_s(120);
        watched.carry(seed + 10);
        watched.household_mut().ask(RequestBody::Resume);
        watched.finish(HOME_S);
        table.row(&what("map, goes on"), &watched);

        let mut watched = Watched::new(&scene, seed);
        watched.clean(Some(StrategyName::Systematic));
        watched.pass_s(240);
        watched.carry(seed + 20);
        watched.household_mut().ask(RequestBody::Resume);
        watched.finish(HOME_S);
        table.row(&what("first run, goes on"), &watched);
    }
    table.compare();
}

#[test]
fn carried_elsewhere_among_beacons() {
    let mut table = Table::of_outcomes(
        "carried-beacons",
        "systematic with a perfect map, carried elsewhere after 120 s, seed 6",
    );
    for is_by_strength in [false, true] {
        let scene = scene("two-room-flat", "nominal");
        let beacons = scene.beacons(6, 4);
        let beacons = if is_by_strength {
            beacons.by_strength()
        } else {
            beacons
        };
        let watched = Watched::new(&scene, 6).changed(|household| household.with_beacons(beacons));
        let mut watched = watched.knowing_home();
        watched.clean(Some(StrategyName::Systematic));
        watched.pass_s(120);
        watched.carry(6);
        watched.household_mut().ask(RequestBody::Resume);
        watched.finish(HOME_S);
        let told = if is_by_strength { "strengths" } else { "ranges" };
        table.row(&format!("two-room-flat nominal, {told}"), &watched);
    }
    table.compare();
}

fn awaits_charge(household: &Household) -> bool {
    let brain = household.host().and_then(Host::brain);
    brain.is_some_and(Brain::awaits_charge) && is_home(household)
}

/// A job in the middle of which the pack is charged in its own time.
fn charged(table: &mut Table, what: &str, mut watched: Watched) {
    let world = watched.household_mut().robot_mut().world_mut();
    world.set_battery_charge(0.22);
    watched.clean(Some(StrategyName::Systematic));
    watched.pass_until(HOME_S, awaits_charge);
    table.row(&format!("{what}, on the dock for charge"), &watched);
    watched.pass_until(CHARGE_S, |household| !is_home(household));
    table.row(&format!("{what}, charged"), &watched);
    watched.finish(JOB_S);
    table.row(&format!("{what}, at the end"), &watched);
}

#[test]
fn one_charge_is_not_enough() {
    let mut table = Table::of_outcomes("recharge", "systematic with a low battery, seed 3");
    let watched = Watched::new(&scene("two-room-flat", "nominal"), 3).knowing_home();
    charged(&mut table, "two-room-flat nominal, map", watched);
    table.compare();
}

#[test]
#[ignore = "takes long: for a change that shall not change any behaviour"]
fn one_charge_is_not_enough_for_a_first_run() {
    let mut table = Table::of_outcomes("long-recharge", "systematic with a low battery, seed 3");
    let watched = Watched::new(&scene("two-room-flat", "nominal"), 3);
    charged(&mut table, "two-room-flat nominal, first run", watched);
    table.compare();
}
