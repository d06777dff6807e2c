//! A person moves the dock and marks its position on the map by eye, so with an error of some decimetres and degrees.

use crate::flat;
use crate::flat::scene;
use brain::command::StrategyName;
use brain::{BehaviorState, Brain, Pose2};
use home::{Pcg, Pose, wrap_angle};
use rvac_api::RequestBody;
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household, Scene};

/// Where the file of the home puts the dock: the simulator's plan has a margin around it.
const DOCK_IN_FILE: (f64, f64) = (0.0, 2.1);
/// Walls of both rooms with floor before them, as in the file, in metres and degrees.
const WALLS: [(f64, f64, f64); 4] = [
    (6.6, 0.0, 90.0),
    (3.65, 0.0, 90.0),
    (0.0, 0.75, 0.0),
    (8.0, 2.9, 180.0),
];
/// How far a person points beside it at most, metres and radians.
const POINTED_M: f64 = 0.3;
const POINTED_RAD: f64 = 0.35;
/// Errors of the learned dock above these count as a wrong position, metres and radians.
const WRONG_M: f64 = 0.2;
const WRONG_RAD: f64 = 0.25;
const STREAM: u64 = 91;

/// A robot in a known home, and where the dock is carried.
struct Move {
    household: Household,
    map_from_plan: Pose,
    random: Pcg,
}

impl Move {
    fn new(scene: &Scene, seed: u64, start: Option<Pose>) -> Self {
        let household = flat::household(scene, start, seed);
        let truth = household.robot().world().truth().pose;
        let believed = household.host().unwrap().pose();
        let believed = Pose::new(believed.x, believed.y, believed.heading);
        Self {
            household,
            map_from_plan: believed.then(truth.inverse()),
            random: Pcg::new(seed, STREAM),
        }
    }

    fn brain(&self) -> &Brain {
        self.household.host().unwrap().brain().unwrap()
    }

    /// Somebody carries the dock to a wall.
    fn carry_dock(&mut self, seed: u64) {
        let (x_m, y_m, degrees) = WALLS[seed as usize % WALLS.len()];
        let world = self.household.robot_mut().world_mut();
        let before = world.home().dock().unwrap();
        let (margin_x_m, margin_y_m) = (before.x_m - DOCK_IN_FILE.0, before.y_m - DOCK_IN_FILE.1);
        world.put_dock(Pose::new(
            x_m + margin_x_m,
            y_m + margin_y_m,
            degrees.to_radians(),
        ));
    }

    /// The true pose of a robot on the dock, in the robot's map.
    fn docked(&self) -> Pose {
        let docked = self.household.robot().world().docked_pose().unwrap();
        self.map_from_plan.then(docked)
    }

    /// Says where it is, by eye.
    fn point_at_dock(&mut self) {
        let docked = self.docked();
        let mut off = |most: f64| most * self.random.symmetric();
        let (x, y, turn) = (off(POINTED_M), off(POINTED_M), off(POINTED_RAD));
        self.household.ask(RequestBody::MoveDock {
            x: docked.x_m + x,
            y: docked.y_m + y,
            heading: wrap_angle(docked.heading_rad + turn),
        });
        self.household.pass_ms(500);
        assert!(
            self.brain().map().dock_location().is_reported(),
            "{}",
            self.story()
        );
    }

    /// Asks for the dock and waits until the robot is on it.
    fn dock(&mut self) -> bool {
        self.household.ask(RequestBody::Dock);
        let docks = self.household.pass_until(1_200, |household| {
            let state = household.host().and_then(Host::state);
            state == Some(BehaviorState::Docked) && household.robot().world().truth().docked
        });
        self.household.pass_ms(1_000);
        docks.is_some()
    }

    /// What the robot has said.
    fn story(&self) -> String {
        let log = self.household.host().unwrap().log().iter();
        let told: Vec<String> = log
            .map(|entry| format!("{:.1} {}", entry.t, entry.text))
            .collect();
        told.join("\n")
    }

    /// Error of the dock's measured pose, metres and radians; `None` while the robot has only the reported
    /// one.
    fn felt_off(&self) -> Option<(f64, f64)> {
        let place = self.brain().map().dock_location();
        let Pose2 {
            x_m,
            y_m,
            heading_rad,
        } = place.pose().filter(|_| !place.is_reported())?;
        let docked = self.docked();
        Some((
            (x_m - docked.x_m).hypot(y_m - docked.y_m),
            wrap_angle(heading_rad - docked.heading_rad).abs(),
        ))
    }
}

/// Most must have found out where the dock is, and none may be wrong.
fn check(offs: &[Option<(f64, f64)>], least: usize) {
    let felt: Vec<(f64, f64)> = offs.iter().flatten().copied().collect();
    let is_wrong = |(off_m, off_rad): &(f64, f64)| *off_m > WRONG_M || *off_rad > WRONG_RAD;
    assert_eq!(felt.iter().filter(|off| is_wrong(off)).count(), 0, "{offs:?}");
    assert!(felt.len() >= least, "{offs:?}");
}

#[test]
#[ignore = "campaign: a whole run; cargo xtask test --all"]
fn a_robot_that_was_carried_along_with_its_dock_finds_out_where_it_stands() {
    let scene = scene();
    let offs: Vec<Option<(f64, f64)>> = (0..8)
        .map(|seed| {
            let mut moved = Move::new(&scene, seed, None);
            moved.carry_dock(seed);
            let world = moved.household.robot_mut().world_mut();
            world.lift();
            moved.household.pass_ms(3_000);
            let world = moved.household.robot_mut().world_mut();
            let docked = world.docked_pose().unwrap();
            world.put_down_at(docked);
            moved.household.pass_ms(10_000);
            moved.point_at_dock();
            start_cleaning(&mut moved.household, StrategyName::Systematic);
            moved.household.pass_ms(300_000);
            assert!(moved.dock(), "seed {seed}: {}", moved.story());
            assert_eq!(moved.household.robot().monitor().violations().len(), 0);
            moved.felt_off()
        })
        .collect();
    check(&offs, 7);
}

#[test]
fn a_robot_that_stood_elsewhere_drives_to_where_its_dock_was_carried() {
    let scene = scene();
    let offs: Vec<Option<(f64, f64)>> = (0..4)
        .map(|seed| {
            let mut moved = Move::new(&scene, seed, Some(Pose::new(3.6, 2.5, seed as f64)));
            moved.carry_dock(seed);
            moved.point_at_dock();
            assert!(moved.dock(), "seed {seed}: {}", moved.story());
            moved.felt_off()
        })
        .collect();
    check(&offs, 3);
}
