//! Return to the dock in a simulated home.

use crate::flat;
use crate::flat::scene;
use brain::BehaviorState;
use home::{BeamStrengths, Pose};
use rvac_api::RequestBody;
use rvac_sim::{Host, Household, Scene};

/// Asks for the dock; the seconds until the robot reports that it is on it.
fn seconds_home(household: &mut Household, longest_s: u64) -> Option<u64> {
    household.ask(RequestBody::Dock);
    household.pass_until(longest_s, |household| {
        household.host().and_then(Host::state) == Some(BehaviorState::Docked)
    })
}

/// A metre and a half in front of the dock, and beside it.
fn before_the_dock(scene: &Scene, aside_m: f64, heading_rad: f64) -> Pose {
    let dock = scene.home().dock().unwrap();
    let (x_m, y_m) = dock.point(1.5, aside_m);
    Pose::new(x_m, y_m, heading_rad)
}

#[test]
fn it_comes_home_through_poor_beams_to_a_dock_that_was_pushed() {
    let scene = scene();
    for (seed, heading_rad) in [(1, 0.0), (2, 2.0), (3, -2.5)] {
        let mut household = flat::household(&scene, Some(before_the_dock(&scene, 0.3, heading_rad)), seed);
        let world = household.robot_mut().world_mut();
        world.set_dock_beams(BeamStrengths::POOR);
        world.push_dock(0.05, 0.05);
        let seconds = seconds_home(&mut household, 240);
        assert!(
            seconds.is_some(),
            "seed {seed}: {:?}",
            household.host().unwrap().status()
        );
        assert!(household.robot().world().truth().docked);
        assert_eq!(household.robot().monitor().violations().len(), 0);
    }
}

#[test]
fn every_phase_of_the_way_home_is_a_decision_with_a_reason() {
    let scene = scene();
    let mut household = flat::household(&scene, Some(before_the_dock(&scene, 0.0, 0.5)), 4);
    household.host_mut().unwrap().keep_log();
    assert!(seconds_home(&mut household, 120).is_some());
    let log: Vec<&str> = household
        .host()
        .unwrap()
        .log()
        .iter()
        .map(|entry| entry.text.as_str())
        .collect();
    for wanted in [
        "dock-travel (dock-known)",
        "approach (dock-known)",
        "state-docked (docked)",
    ] {
        assert!(
            log.iter().any(|text| text.starts_with(wanted)),
            "{wanted} in {log:?}"
        );
    }
}

#[test]
fn a_stop_ends_the_way_home_at_once() {
    let scene = scene();
    let mut household = flat::household(&scene, Some(before_the_dock(&scene, 0.0, 0.5)), 5);
    household.ask(RequestBody::Dock);
    household.pass_ms(6_000);
    assert!(household.robot().wheels_driven());
    household.ask(RequestBody::Stop);
    household.pass_ms(500);
    assert!(!household.robot().wheels_driven());
    assert_eq!(household.host().and_then(Host::state), Some(BehaviorState::Idle));
}
