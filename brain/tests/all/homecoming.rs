//! The way to the dock of a known home when somebody stands in the only door.

use crate::orders::{START, flat, known, zone};
use crate::plane::beams::{RING_DEG, Sight, sensors_at};
use crate::plane::{Rectangle, World, config, run};
use brain::mapping::DockLocation;
use brain::{BehaviorState, Brain, BrainConfig, CleaningOrder, HomePart, JobCommand, Pose2};

/// In the other room, at its far wall.
const DOCK: Pose2 = Pose2 {
    x_m: 5.8,
    y_m: 2.0,
    heading_rad: 0.0,
};
/// Two feet in the door: no body fits past them.
const FEET: Rectangle = Rectangle {
    low: (2.95, 1.75),
    high: (3.15, 2.15),
};
/// Four blocked ways, two waits and a search between them take less.
const GIVEN_UP_S: u32 = 600;

struct Homecoming {
    world: World,
    brain: Brain,
    empty: Vec<Rectangle>,
}

impl Homecoming {
    /// A robot that was sent home from the first room while somebody stands in the door.
    fn begun() -> Self {
        let room = flat();
        let empty = room.furniture.clone();
        let dock = Pose2 {
            x_m: DOCK.x_m - START.x_m,
            y_m: DOCK.y_m - START.y_m,
            ..DOCK
        };
        let map = known(&room).with_dock_location(DockLocation::converged(dock));
        let eyes = Sight::of(sensors_at(&RING_DEG));
        let seeing = BrainConfig {
            sensors: eyes.layout,
            ..config()
        };
        let mut way = Self {
            brain: Brain::with_map(seeing, 1, &map),
            world: World::new(room, DOCK),
            empty,
        };
        way.world.sight = Some(eyes);
        way.world.observation.docked = true;
        run(&mut way.world, &mut way.brain, None, 1.0);
        way.world.observation.docked = false;
        let there = HomePart::Zone(zone((0.4, 0.4), (2.4, 3.6)));
        let order = CleaningOrder::new(vec![there], 1).expect("a part");
        let clean = JobCommand::CleanParts { order };
        run(&mut way.world, &mut way.brain, Some(clean), 1.0);
        assert!(way.until(120, |way| way.world.pose.x_m < 1.5), "it works there");
        way.world.room.furniture.push(FEET);
        run(&mut way.world, &mut way.brain, Some(JobCommand::Dock), 10.0);
        way
    }

    /// Until something is so; whether it was within the time.
    fn until(&mut self, longest_s: u32, is_so: impl Fn(&Self) -> bool) -> bool {
        (0..longest_s).any(|_| {
            run(&mut self.world, &mut self.brain, None, 1.0);
            is_so(self)
        })
    }

    fn has_given_up(&self) -> bool {
        self.brain.status().state == BehaviorState::Idle
    }

    fn is_before_dock(&self) -> bool {
        self.world.pose.position().distance_m(DOCK.position()) < 1.5
    }
}

#[test]
fn it_waits_until_who_stands_in_the_door_has_left_and_goes_through() {
    for stays_s in [20, 60, 90] {
        let mut way = Homecoming::begun();
        assert!(!way.until(stays_s, Homecoming::has_given_up), "{stays_s} s");
        way.world.room.furniture = way.empty.clone();
        let ends = |way: &Homecoming| way.is_before_dock() || way.has_given_up();
        assert!(way.until(GIVEN_UP_S, ends), "{stays_s} s");
        assert!(
            way.is_before_dock(),
            "{stays_s} s: {:?} at {:?}",
            way.brain.status(),
            way.world.pose
        );
        assert_eq!(way.world.violations, Vec::<String>::new());
    }
}
