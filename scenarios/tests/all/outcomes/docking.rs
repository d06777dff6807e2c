//! The way home: with a map and without, after the robot was carried elsewhere, and for charge.

use brain::BehaviorState;
use brain::command::StrategyName;
use home::DockBeams;
use rvac_api::RequestBody;
use rvac_sim::{Host, Household};
use scenarios::{JOB_S, Table, Watched, generated_with, scene};

/// Longest way home, seconds.
const HOME_S: u64 = 15 * 60;
/// How many times as fast as in truth the pack fills.
const FILLS: f64 = 20.0;

fn is_home(household: &Household) -> bool {
    household.host().and_then(Host::state) == Some(BehaviorState::Docked)
}

fn send_home(watched: &mut Watched) {
    watched.start(RequestBody::Dock);
    watched.pass_until(HOME_S, is_home);
    watched.pass_s(30);
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
        world.set_dock_beams(DockBeams::POOR);
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
fn one_charge_is_not_enough() {
    let mut table = Table::of_outcomes(
        "recharge",
        "systematic with a low battery, a pack that fills 20 times as fast",
    );
    for (what, is_known, charge) in [("first run", false, 0.25), ("known home", true, 0.22)] {
        let mut watched = Watched::new(&scene("two-room-flat", "nominal"), 3);
        if is_known {
            watched = watched.knowing_home();
        }
        let world = watched.household_mut().robot_mut().world_mut();
        world.set_battery_charge(charge);
        world.set_charging_speed(FILLS);
        watched.clean(Some(StrategyName::Systematic));
        watched.pass_until(HOME_S, |household| {
            household
                .host()
                .and_then(Host::brain)
                .is_some_and(brain::Brain::awaits_charge)
                && is_home(household)
        });
        table.row(&format!("{what}, on the dock for charge"), &watched);
        watched.finish(JOB_S);
        table.row(&format!("{what}, at the end"), &watched);
    }
    table.compare();
}
