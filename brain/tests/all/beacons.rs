//! A robot whose wheels alone tell its heading, and what it takes on when it hears radio beacons.

use crate::plane::beams::{RING_DEG, Sight, sensors_at};
use crate::plane::{Room, STEP_S, World, config};
use brain::observation::{BeaconRange, BeaconSignal};
use brain::{Brain, BrainConfig, JobCommand, JobRefusal, Point2, Pose2, StrategyName};

const SYSTEMATIC: JobCommand = JobCommand::Clean {
    strategy: StrategyName::Systematic,
};
/// Beyond the walls of the room.
const BEACONS: [(f64, f64); 4] = [(-0.5, -0.4), (4.6, -0.5), (4.5, 3.6), (-0.4, 3.5)];
/// Steps between two distances.
const TURN_STEPS: u64 = 3;

/// A robot without a gyro in a room of 4 m by 3 m with beacons at its corners.
struct Listener {
    world: World,
    brain: Brain,
    steps: u64,
    /// Beacons that speak; the others are silent.
    speaking: u16,
    /// Kind and reason of each decision, and the step.
    decisions: Vec<(&'static str, &'static str, u64)>,
}

impl Listener {
    fn new(speaking: u16) -> Self {
        let sight = Sight::of(sensors_at(&RING_DEG));
        let start = Pose2 {
            x_m: 1.0,
            y_m: 1.0,
            heading_rad: 0.4,
        };
        let mut world = World::new(Room::empty((4.0, 3.0)), start);
        world.observation.gyro_heading_rad = None;
        world.observation.proximity = vec![0.0; sight.layout.proximity.sensors().len()];
        let config = BrainConfig {
            sensors: sight.layout,
            ..config()
        };
        world.sight = Some(sight);
        Self {
            world,
            brain: Brain::new(config, 7),
            steps: 0,
            speaking,
            decisions: Vec::new(),
        }
    }

    /// One that was asked to clean in lanes, and hears four beacons.
    fn cleaning() -> Self {
        let mut listener = Self::new(4);
        listener.pass_s(0.1);
        listener.step(&[SYSTEMATIC]);
        listener
    }

    fn hear(&mut self) {
        self.steps += 1;
        let seen = &mut self.world.observation;
        seen.beacons_in_range = self.speaking as u8;
        seen.beacons.clear();
        let turn = self.steps / TURN_STEPS % BEACONS.len() as u64;
        if self.steps.is_multiple_of(TURN_STEPS) && turn < u64::from(self.speaking) {
            let (x_m, y_m) = BEACONS[turn as usize];
            // Wrong by up to a decimetre, from one to the next.
            let off_m = 0.1 * (0.7 * self.steps as f64).sin();
            seen.beacons.push(BeaconSignal::Range(BeaconRange {
                beacon: turn as u16,
                range_m: self.world.pose.position().distance_m(Point2 { x_m, y_m }) + off_m,
                sigma_m: 0.1,
            }));
        }
    }

    fn step(&mut self, commands: &[JobCommand]) {
        self.hear();
        let commands: Vec<_> = commands.iter().cloned().map(Into::into).collect();
        let actions = self.brain.step(&self.world.observation, &commands);
        self.world.step(&actions);
        let new = actions.decisions.iter();
        self.decisions
            .extend(new.map(|one| (one.kind.name(), one.cause.name(), self.steps)));
    }

    fn pass_s(&mut self, seconds: f64) {
        for _ in 0..(seconds / STEP_S) as u32 {
            self.step(&[]);
        }
    }

    /// Step of the first decision of this kind for this reason.
    fn decided(&self, what: &str, reason: &str) -> Option<u64> {
        let is_it = |one: &&(&str, &str, u64)| one.0 == what && one.1 == reason;
        self.decisions.iter().find(is_it).map(|one| one.2)
    }
}

#[test]
fn lanes_are_refused_until_three_beacons_are_heard() {
    for heard in 0..=2 {
        let mut listener = Listener::new(heard);
        listener.pass_s(2.0);
        assert_eq!(
            listener.brain.admit(&SYSTEMATIC),
            Err(JobRefusal::NoHeading),
            "{heard}"
        );
        listener.step(&[SYSTEMATIC]);
        assert!(listener.decided("refuse", "no-heading").is_some(), "{heard}");
    }
    let mut listener = Listener::new(3);
    listener.pass_s(0.1);
    assert_eq!(listener.brain.admit(&SYSTEMATIC), Ok(()));
    listener.step(&[SYSTEMATIC]);
    assert_eq!(listener.decided("refuse", "no-heading"), None);
    assert_eq!(
        listener.decided("keep-no-map", "no-heading"),
        None,
        "it will keep one"
    );
}

#[test]
fn it_drives_until_beacons_tell_its_heading_and_then_in_lanes() {
    let mut listener = Listener::cleaning();
    listener.pass_s(400.0);
    let looked = listener
        .decided("find-heading", "beacons-heard")
        .expect("it looks");
    let found = listener
        .decided("heading-found", "beacons-heard")
        .expect("it finds");
    let lap = listener
        .decided("lap", "no-map")
        .expect("it begins as in any new home");
    assert!(looked < found && found <= lap, "{looked} {found} {lap}");
    assert!(listener.world.covered() > 0.8, "{}", listener.world.covered());
    assert_eq!(listener.world.violations, Vec::<String>::new());
}

#[test]
fn one_beacon_that_falls_silent_ends_nothing() {
    let mut listener = Listener::cleaning();
    listener.pass_s(150.0);
    assert!(listener.decided("heading-found", "beacons-heard").is_some());
    listener.speaking = 3;
    let before = listener.decisions.len();
    listener.pass_s(60.0);
    let later = listener.decisions.split_off(before);
    let lost = ["find-heading", "clean-by-statistics", "state-idle"];
    assert!(
        !later
            .iter()
            .any(|one| lost.contains(&one.0) && one.1 != "finished"),
        "{later:?}"
    );
}

#[test]
fn where_all_beacons_fall_silent_it_goes_on_by_statistics_and_says_why() {
    let mut listener = Listener::cleaning();
    listener.pass_s(10.0);
    assert_eq!(
        listener.decided("heading-found", "beacons-heard"),
        None,
        "too soon"
    );
    listener.speaking = 0;
    listener.pass_s(300.0);
    assert!(
        listener
            .decided("clean-by-statistics", "beacons-silent")
            .is_some(),
        "{:?}",
        listener.decisions
    );
    assert_eq!(listener.decided("state-idle", "no-heading"), None);
    assert!(listener.world.covered() > 0.5, "{}", listener.world.covered());
    listener.speaking = 4;
    listener.pass_s(200.0);
    assert!(
        listener.decided("heading-found", "beacons-heard").is_some(),
        "they are back"
    );
    assert_eq!(listener.world.violations, Vec::<String>::new());
}
