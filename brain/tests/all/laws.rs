//! What holds in every state, whatever is perceived and asked in whatever order.

use crate::script::{Stage, config};
use brain::observation::{Cliffs, Contacts};
use brain::{BehaviorState, Brain, Inhibits, JobCommand, Motion, Observation, Reason, StrategyName};
use proptest::prelude::*;

const INHIBITS: [&str; 10] = [
    "not-armed",
    "stopped",
    "button-stop",
    "link-lost",
    "docked",
    "wheel-drop",
    "not-moving",
    "cliff-sensor",
    "wheel-stall",
    "from-the-future",
];

fn command() -> impl Strategy<Value = JobCommand> {
    prop_oneof![
        Just(JobCommand::Clean {
            strategy: StrategyName::Bounce
        }),
        Just(JobCommand::Spot),
        Just(JobCommand::Pause),
        Just(JobCommand::Resume),
        Just(JobCommand::Stop),
        Just(JobCommand::Dock),
        Just(JobCommand::ManualEnd),
        Just(JobCommand::ClearError),
        (-1.0..1.0_f64, -3.0..3.0_f64, 0..400_000_u64, any::<bool>()).prop_map(
            |(speed_m_per_s, turn_rad_per_s, valid_until_us, cleaners)| JobCommand::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners
            }
        ),
    ]
}

/// Something perceived for a while, with commands at its beginning.
#[derive(Clone, Debug)]
struct Episode {
    contacts: (bool, bool),
    cliffs: (bool, bool, bool),
    wheel_drop: bool,
    link_up: bool,
    docked: bool,
    inhibits: Vec<&'static str>,
    beams: Vec<u8>,
    speed_share: f64,
    commands: Vec<JobCommand>,
    steps: u32,
}

fn episode() -> impl Strategy<Value = Episode> {
    let rarely = || prop::bool::weighted(0.12);
    let senses = (
        (rarely(), rarely()),
        (rarely(), rarely(), rarely()),
        rarely(),
        prop::bool::weighted(0.9),
        rarely(),
    );
    let rest = (
        prop::collection::vec(prop::sample::select(&INHIBITS[..]), 0..2),
        prop_oneof![Just(vec![0; 4]), prop::collection::vec(0..8_u8, 0..5)],
        prop_oneof![Just(1.0), Just(0.5), Just(0.0), Just(f64::NAN)],
        prop::collection::vec(command(), 0..3),
        1..250_u32,
    );
    (senses, rest).prop_map(|((contacts, cliffs, wheel_drop, link_up, docked), rest)| {
        let (inhibits, beams, speed_share, commands, steps) = rest;
        Episode {
            contacts,
            cliffs,
            wheel_drop,
            link_up,
            docked,
            inhibits,
            beams,
            speed_share,
            commands,
            steps,
        }
    })
}

fn perceive(observation: &mut Observation, episode: &Episode) {
    let (left, right) = episode.contacts;
    observation.contacts = Contacts { left, right };
    let (left, middle, right) = episode.cliffs;
    observation.cliffs = Cliffs { left, middle, right };
    observation.wheel_drop = episode.wheel_drop;
    observation.link_up = episode.link_up;
    observation.docked = episode.docked;
    observation.inhibits = Inhibits::from_names(episode.inhibits.iter().copied());
    observation.dock_beams.clone_from(&episode.beams);
    observation.speed_share = episode.speed_share;
}

/// Manual leases are relative in an episode.
fn at(now_us: u64, command: &JobCommand) -> JobCommand {
    match command.clone() {
        JobCommand::Manual {
            speed_m_per_s,
            turn_rad_per_s,
            valid_until_us,
            cleaners,
        } => JobCommand::Manual {
            speed_m_per_s,
            turn_rad_per_s,
            valid_until_us: now_us + valid_until_us,
            cleaners,
        },
        other => other,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// The laws of [`Stage::assert_lawful`] in every step, a known name for every state, and an end to every lease.
    #[test]
    fn every_story_is_lawful(episodes in prop::collection::vec(episode(), 1..20)) {
        let mut stage = Stage::new(config());
        for episode in &episodes {
            perceive(&mut stage.observation, episode);
            let now_us = stage.observation.time_us;
            let commands: Vec<JobCommand> = episode.commands.iter().map(|command| at(now_us, command)).collect();
            stage.step(&commands);
            for _ in 1..episode.steps {
                stage.step(&[]);
            }
            let status = stage.brain.status();
            prop_assert!(BehaviorState::ALL.contains(&status.state));
            prop_assert_eq!(Reason::from_name(status.reason.name()), Some(status.reason));
            let lease_over = episode.steps > 25;
            prop_assert!(!(lease_over && status.state == BehaviorState::Manual), "a lease outlived its end");
        }
    }

    /// Stop ends all motion in the step in which it is said, and nothing moves again by itself.
    #[test]
    fn stop_stops(episodes in prop::collection::vec(episode(), 1..8), last in episode()) {
        let mut stage = Stage::new(config());
        for episode in &episodes {
            perceive(&mut stage.observation, episode);
            let now_us = stage.observation.time_us;
            let commands: Vec<JobCommand> = episode.commands.iter().map(|command| at(now_us, command)).collect();
            stage.step(&commands);
            (1..episode.steps).for_each(|_| { stage.step(&[]); });
        }
        let stopped = stage.step(&[JobCommand::Stop]);
        prop_assert!(matches!(stopped.motion, Motion::Halt | Motion::Rest) && !stopped.cleaners);
        perceive(&mut stage.observation, &last);
        for _ in 0..300 {
            let actions = stage.step(&[]);
            prop_assert!(matches!(actions.motion, Motion::Halt | Motion::Rest) && !actions.cleaners);
        }
    }

    /// Equal seeds and equal stories give equal actions.
    #[test]
    fn the_same_story_is_told_twice(episodes in prop::collection::vec(episode(), 1..10)) {
        let mut stages = [Stage::new(config()), Stage::new(config())];
        for episode in &episodes {
            let tell = |stage: &mut Stage| {
                perceive(&mut stage.observation, episode);
                let now_us = stage.observation.time_us;
                let commands: Vec<JobCommand> = episode.commands.iter().map(|command| at(now_us, command)).collect();
                let first = stage.step(&commands);
                let rest: Vec<_> = (1..episode.steps).map(|_| stage.step(&[])).collect();
                (first, rest)
            };
            let [one, two] = &mut stages;
            let told = (tell(one), tell(two));
            // NaN speed shares never reach a motion, so equality is the right comparison.
            prop_assert_eq!(&told.0, &told.1);
        }
        prop_assert_eq!(stages[0].brain.checkpoint(), stages[1].brain.checkpoint());
    }
}

/// The ladder ends. A wedged robot whose bumper is pressed and released in every possible order over nine seconds, and
/// then left either way, waits for a person before long.
#[test]
fn every_order_of_contacts_on_a_wedged_robot_ends_in_stuck() {
    for right_too in [true, false] {
        check_every_order_of_contacts(right_too);
    }
}

fn check_every_order_of_contacts(right_too: bool) {
    const SLICES: u32 = 9;
    for order in 0..1_u32 << SLICES {
        let mut stage = working();
        for slice in 0..=SLICES {
            let pressed = order & (1 << slice.min(SLICES - 1)) != 0;
            stage.observation.contacts = Contacts {
                left: pressed,
                right: pressed && right_too,
            };
            for _ in 0..if slice < SLICES { 50 } else { 3000 } {
                step_wedged(&mut stage);
                if stage.brain.status().state == BehaviorState::Stuck {
                    break;
                }
            }
        }
        let status = stage.brain.status();
        assert_eq!(status.state, BehaviorState::Stuck, "order {order:b}: {status:?}");
    }
}

/// A robot in the middle of a job.
fn working() -> Stage {
    let mut stage = Stage::new(config());
    stage.observation.link_up = true;
    stage.step(&[JobCommand::Clean {
        strategy: StrategyName::Bounce,
    }]);
    while stage.brain.status().state != BehaviorState::Cleaning {
        stage.step(&[]);
    }
    stage
}

/// A step in which the wheels turn nothing.
fn step_wedged(stage: &mut Stage) {
    let (left_m, right_m) = (stage.observation.travel_left_m, stage.observation.travel_right_m);
    stage.step(&[]);
    (stage.observation.travel_left_m, stage.observation.travel_right_m) = (left_m, right_m);
}

/// A checkpoint carries pose, map, figures and job over a restart, and the job goes on.
#[test]
fn a_restored_brain_goes_on() {
    let mut stage = working();
    for _ in 0..500 {
        stage.step(&[]);
    }
    stage.observation.contacts.left = true;
    for _ in 0..25 {
        stage.step(&[]);
    }
    stage.observation.contacts.left = false;
    let checkpoint = stage.brain.checkpoint();
    assert!(
        (0.02..0.15).contains(&checkpoint.backed_m),
        "{}",
        checkpoint.backed_m
    );
    assert!(
        checkpoint
            .job
            .as_ref()
            .is_some_and(|job| job.running && job.figures.path_m > 2.0),
        "{:?}",
        checkpoint.job
    );
    let mut second = Stage::new(config());
    second.brain = Brain::new(config(), 99);
    second.brain.restore(&checkpoint);
    assert_eq!(second.brain.map().swept_m2(), stage.brain.map().swept_m2());
    assert_eq!(second.brain.checkpoint().backed_m, checkpoint.backed_m);
    second.observation.link_up = true;
    second.step(&[]);
    assert_eq!(second.brain.status().state, BehaviorState::Starting);
    assert_eq!(second.brain.status().reason, Reason::Restored);
    let gap_m = second
        .brain
        .pose()
        .position()
        .distance_m(stage.brain.pose().position());
    assert!(gap_m < 1e-9, "{gap_m}");
    for _ in 0..200 {
        second.step(&[]);
    }
    assert_eq!(second.brain.status().state, BehaviorState::Cleaning);
    assert!(second.brain.job().path_m > checkpoint.job.map_or(0.0, |job| job.figures.path_m));
}

/// Cursors: the parts since a cursor, put together, are the snapshot.
#[test]
fn deltas_add_up_to_the_map() {
    let mut stage = working();
    let mut cursor = stage.brain.map().cursor();
    let snapshot = stage.brain.map().snapshot();
    let (mut swept, mut path) = (snapshot.swept.to_vec(), snapshot.path.to_vec());
    for _ in 0..20 {
        (0..25).for_each(|_| {
            stage.step(&[]);
        });
        let delta = stage.brain.map().since(cursor).expect("the same map");
        swept.extend_from_slice(delta.swept);
        path.extend_from_slice(delta.path);
        cursor = stage.brain.map().cursor();
    }
    let snapshot = stage.brain.map().snapshot();
    assert_eq!(
        (swept.as_slice(), path.as_slice()),
        (snapshot.swept, snapshot.path)
    );
    assert!(snapshot.swept.len() > 1000 && snapshot.path.len() > 80);
    stage.step(&[JobCommand::Stop]);
    stage.step(&[JobCommand::Spot]);
    assert_eq!(stage.brain.map().since(cursor), None, "a new job has a new map");
}
