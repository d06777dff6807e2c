//! A robot that is shut in, on paper: it ends by itself, whatever the place is like, and comes free when there is a way out.

use crate::plane;
use crate::plane::{Rectangle, Room, World, config};
use brain::mapping::CellKnowledge;
use brain::{BehaviorState, Brain, JobCommand, Motion, Pose2, Reason, StrategyName};
use proptest::prelude::*;

/// Longest time in a pen: patience of four minutes, eight rungs of 75 s at most, 45 s of the task after each, and as much again
/// for what holds the robot in it.
const LONGEST_S: u32 = 2 * (240 + 8 * (75 + 45));

fn at(x_m: f64, y_m: f64, heading_rad: f64) -> Pose2 {
    Pose2 {
        x_m,
        y_m,
        heading_rad,
    }
}

const CLEAN: JobCommand = JobCommand::Clean {
    strategy: StrategyName::Bounce,
};

/// Runs second by second until something is so; the second in which it was.
fn seconds_until(
    world: &mut World,
    brain: &mut Brain,
    (longest_s, mut is_so): (u32, impl FnMut(&World, &Brain) -> bool),
) -> Option<u32> {
    plane::run(world, brain, Some(CLEAN), 1.0);
    (1..longest_s).find(|_| {
        plane::run(world, brain, None, 1.0);
        is_so(world, brain)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "campaign: many rooms drawn at random; cargo xtask test --all"]
    fn a_robot_that_is_shut_in_says_so_and_stops(
        (width_m, depth_m) in (0.4..1.15_f64, 0.4..1.9_f64),
        heading_rad in -3.1..3.1_f64,
        seed in 0..1000_u64,
        leg in prop::option::of((0.0..1.0_f64, 0.0..1.0_f64)),
    ) {
        let mut room = Room::empty((width_m, depth_m));
        if let Some((x, y)) = leg {
            // A leg beside the middle, where the robot begins.
            let (x_m, y_m) = (x * (width_m - 0.03), y * (depth_m - 0.03));
            let clear_m = (x_m - 0.5 * width_m).hypot(y_m - 0.5 * depth_m);
            if clear_m > 0.25 {
                room = room.with(&[Rectangle::new((x_m, y_m), (x_m + 0.03, y_m + 0.03))]);
            }
        }
        let mut world = World::new(room, at(0.5 * width_m, 0.5 * depth_m, heading_rad));
        let mut brain = Brain::new(config(), seed);
        let ends = |_: &World, brain: &Brain| brain.status().state == BehaviorState::Stuck;
        let end_s = seconds_until(&mut world, &mut brain, (LONGEST_S, ends));
        prop_assert!(end_s.is_some(), "{:?}", brain.status());
        let named = [Reason::ShutIn, Reason::BoxedIn, Reason::ContactHeld, Reason::NotMoving];
        prop_assert!(named.contains(&brain.status().reason), "{:?}", brain.status());
        prop_assert!(world.violations.is_empty(), "{:?}", world.violations);
        plane::run(&mut world, &mut brain, None, 1.0);
        let actions = brain.step(&world.observation, &[]);
        prop_assert!(matches!(actions.motion, Motion::Halt | Motion::Rest), "{:?}", actions.motion);
    }
}

#[test]
fn a_way_out_that_is_hardly_wider_than_the_robot_is_found_and_the_place_is_shut_for_the_job() {
    // A cell of 1.2 m in the corner of a room, with a gap of 42 cm.
    let walls = [
        Rectangle::new((1.2, 0.0), (1.25, 0.5)),
        Rectangle::new((1.2, 0.92), (1.25, 1.25)),
        Rectangle::new((0.0, 1.2), (1.2, 1.25)),
    ];
    let mut out = 0;
    for seed in 0..6 {
        let room = Room::empty((5.0, 4.0)).with(&walls);
        let mut world = World::new(room, at(0.4, 0.6, 2.0));
        let mut brain = Brain::new(config(), seed);
        let is_out = |world: &World, _: &Brain| world.pose.x_m > 1.5 || world.pose.y_m > 1.5;
        let out_s = seconds_until(&mut world, &mut brain, (LONGEST_S, is_out));
        // Whoever does not find out says so, in the same time.
        let has_given_up = brain.status().reason == Reason::ShutIn;
        assert!(
            out_s.is_some() || has_given_up,
            "seed {seed}: {:?}",
            brain.status()
        );
        out += u32::from(out_s.is_some());
        plane::run(&mut world, &mut brain, None, 60.0);
        let shut = |brain: &Brain| {
            let values = brain.map().knowledge().values();
            values.iter().filter(|cell| **cell == CellKnowledge::NoGo).count()
        };
        plane::run(&mut world, &mut brain, Some(JobCommand::Stop), 1.0);
        plane::run(&mut world, &mut brain, Some(CLEAN), 1.0);
        assert_eq!(shut(&brain), 0, "a new job may go everywhere");
    }
    assert!(out >= 5, "{out} of 6");
}
