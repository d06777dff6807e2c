//! Docks as they are in homes: the mains fail, contacts are dirty or dead, somebody takes the robot away.

use brain::command::StrategyName;
use brain::{BehaviorState, Brain};
use home::{DockContacts, Pose};
use rvac_api::RequestBody;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, off_the_dock, scene, settings};

/// Longest way home that ends without the dock, seconds.
const GIVES_UP_S: u64 = 6 * 60;

fn brain(household: &Household) -> &Brain {
    household.host().and_then(Host::brain).expect("a brain")
}

fn told(household: &Household) -> (BehaviorState, &'static str) {
    let status = brain(household).status();
    (status.state, status.reason.name())
}

/// A robot that waits on its dock for charge in the middle of a job.
fn recharging() -> Household {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.robot_mut().world_mut().set_battery_charge(0.2);
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    let waits = |household: &Household| told(household) == (BehaviorState::Docked, "recharging");
    assert!(
        household.pass_until(900, waits).is_some(),
        "{:?}",
        told(&household)
    );
    household.pass_ms(40_000);
    household
}

/// Gives how often the state was entered anew within so many milliseconds.
fn changes(household: &mut Household, ms: u64) -> usize {
    let mut changes = 0;
    let mut before = told(household);
    for _ in 0..ms / 100 {
        household.pass_ms(100);
        changes += usize::from(told(household) != before);
        before = told(household);
    }
    changes
}

#[test]
fn a_job_waits_through_a_power_cut_and_goes_on() {
    let mut household = recharging();
    let world = household.robot_mut().world_mut();
    world.set_dock_power(false);
    assert_eq!(changes(&mut household, 1_000), 0, "a second is nothing");
    household.robot_mut().world_mut().set_dock_power(true);
    assert_eq!(changes(&mut household, 30_000), 0);
    household.robot_mut().world_mut().set_dock_power(false);
    assert_eq!(changes(&mut household, 600_000), 1, "told once");
    assert_eq!(told(&household), (BehaviorState::Docked, "dock-power-lost"));
    household.robot_mut().world_mut().set_dock_power(true);
    household.robot_mut().world_mut().set_battery_charge(0.97);
    let goes_on = |household: &Household| told(household).0 == BehaviorState::Cleaning;
    assert!(
        household.pass_until(120, goes_on).is_some(),
        "{:?}",
        told(&household)
    );
    assert_eq!(household.robot().monitor().violations().len(), 0);
}

#[test]
fn a_robot_that_is_lifted_off_its_dock_says_so_and_goes_on_when_it_is_back() {
    let mut household = recharging();
    let there = household.robot().world().truth().pose;
    household.robot_mut().world_mut().lift();
    household.pass_ms(5_000);
    assert_eq!(told(&household), (BehaviorState::Paused, "lifted-off"));
    household.robot_mut().world_mut().put_down_at(there);
    household.pass_ms(5_000);
    assert_eq!(told(&household), (BehaviorState::Docked, "recharging"));
}

#[test]
fn a_person_who_sends_it_home_ends_the_job_that_waits() {
    let mut household = recharging();
    household.ask(RequestBody::Dock);
    household.robot_mut().world_mut().set_battery_charge(0.97);
    household.pass_ms(30_000);
    assert_eq!(told(&household), (BehaviorState::Docked, "command"));
}

/// Sends a robot home to a dock that something is wrong with; gives the seconds until it rests, and what it says.
fn sent_home(wear: impl Fn(&mut home::World)) -> (u64, BehaviorState, &'static str) {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(2, 0)).with_known_map();
    let before: Pose = off_the_dock(&scene);
    let world = household.robot_mut().world_mut();
    world.put_down_at(before);
    world.set_battery_charge(0.5);
    wear(world);
    household.pass_ms(4_000);
    household.ask(RequestBody::Dock);
    household.pass_ms(5_000);
    let rests = |household: &Household| {
        !matches!(
            told(household).0,
            BehaviorState::Docking | BehaviorState::Starting
        )
    };
    let seconds = household.pass_until(1_200, rests).unwrap_or(1_200);
    household.pass_ms(12_000);
    assert_eq!(household.robot().monitor().violations().len(), 0);
    let (state, reason) = told(&household);
    (seconds, state, reason)
}

#[test]
fn docking_ends_after_a_few_tries_and_says_why() {
    let dead = |world: &mut home::World| world.set_dock_contacts(DockContacts::Dead);
    let insulated = |world: &mut home::World| world.set_dock_contacts(DockContacts::Dirty(1.0));
    let (seconds, state, reason) = sent_home(dead);
    assert_eq!((state, reason), (BehaviorState::Idle, "dock-no-contact"));
    assert!(seconds < GIVES_UP_S, "{seconds} s");
    let (seconds, state, reason) = sent_home(insulated);
    assert_eq!((state, reason), (BehaviorState::Docked, "no-charge-current"));
    assert!(seconds < GIVES_UP_S, "{seconds} s");
}

#[test]
fn contacts_that_carry_no_current_now_and_then_are_tried_again() {
    let dirty = |world: &mut home::World| world.set_dock_contacts(DockContacts::Dirty(0.2));
    let (seconds, state, reason) = sent_home(dirty);
    assert_eq!((state, reason), (BehaviorState::Docked, "docked"));
    assert!(seconds < GIVES_UP_S, "{seconds} s");
}
