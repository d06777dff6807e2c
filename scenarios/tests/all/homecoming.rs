//! A robot that was started somewhere in a home that it does not know, and not on its dock: where it goes when all is swept.

use brain::BehaviorState;
use brain::command::StrategyName;
use home::BeamStrengths;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, off_the_dock, scene, settings};

/// Longest job and way home, seconds.
const DONE_S: u64 = 60 * 60;

/// A robot that is put down off its dock before it has seen anything.
fn put_down(seed: u64) -> Household {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(seed, 0));
    household
        .robot_mut()
        .world_mut()
        .put_down_at(off_the_dock(&scene));
    household
}

/// Cleans until the robot rests; its state then.
fn cleaned(household: &mut Household) -> BehaviorState {
    assert!(start_cleaning(household, StrategyName::Systematic));
    let state = |household: &Household| household.host().and_then(Host::state);
    let rests = |household: &Household| {
        household.job_is_over()
            && matches!(
                state(household),
                Some(BehaviorState::Idle | BehaviorState::Docked)
            )
    };
    assert!(
        household.pass_until(DONE_S, rests).is_some(),
        "not done in an hour"
    );
    assert_eq!(household.robot().monitor().violations().len(), 0);
    state(household).expect("it has a host")
}

#[test]
fn it_goes_to_the_dock_whose_beams_it_has_heard() {
    for seed in [1, 2, 3] {
        let mut household = put_down(seed);
        assert_eq!(cleaned(&mut household), BehaviorState::Docked, "seed {seed}");
        let brain = household.host().and_then(Host::brain).expect("a brain");
        assert!(brain.map().dock().is_some(), "it knows its dock from now on");
    }
}

#[test]
fn it_stays_where_it_is_when_no_dock_was_heard() {
    let mut household = put_down(1);
    household.robot_mut().world_mut().set_dock_beams(BeamStrengths {
        lost: 1.0,
        ..BeamStrengths::default()
    });
    assert_eq!(cleaned(&mut household), BehaviorState::Idle);
}
