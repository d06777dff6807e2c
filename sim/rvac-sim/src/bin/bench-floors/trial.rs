//! A floor that was learnt, and a robot that is put down on it.

use anyhow::Context;
use brain::StoredMap;
use brain::command::StrategyName;
use home::{Pcg, Pose};
use robot::RobotSettings;
use rvac_sim::run::{RunEnd, RunSettings, core_config, household, run_until, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use serde::Serialize;
use vthal_core::{CoreConfig, KeptFloor};

use crate::place;

/// Floors that the host keeps.
const FLOORS: usize = 3;
/// Time after which a trial ends.
const LONGEST_MS: u64 = 900_000;
/// Stream of the draws of this bench.
const STREAM: u64 = 79;
/// A found place may be wrong by this, metres.
const PLACE_M: f64 = 0.5;

/// A floor with the map that the robot has made of it.
#[derive(Debug)]
pub(crate) struct MappedFloor {
    scene: Scene,
    map: StoredMap,
    map_from_plan: Pose,
}

/// What the host keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum HostMemory {
    /// The floor on which the robot is, and others.
    Present,
    /// Others alone.
    Absent,
}

/// Outcome of the trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FloorsOutcome {
    /// The robot knows floor and pose.
    Right,
    /// It knows the floor, and its estimated pose is wrong.
    Misplaced,
    /// It takes the floor for another one.
    Wrong,
    /// It has asked a person.
    Asked,
    /// Nothing within the time.
    Silent,
}

/// A robot that was put down.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct FloorsTrial {
    pub(crate) home: String,
    pub(crate) seed: u64,
    pub(crate) kept: HostMemory,
    pub(crate) outcome: FloorsOutcome,
    /// From the start until the robot knew, or had asked, seconds.
    pub(crate) time_s: f64,
    /// How far the place was off when it knew, metres.
    pub(crate) off_m: Option<f64>,
}

impl MappedFloor {
    /// Learnt on a run from the dock.
    pub(crate) fn learnt(scene: Scene, seed: u64, minutes: u64) -> anyhow::Result<Self> {
        let settings = RunSettings {
            strategy: StrategyName::Systematic,
            pattern: None,
            seed,
            duration_ms: minutes * 60_000,
        };
        let mut household = household(&scene, &settings);
        let map_from_plan = household.robot().world().truth().pose.inverse();
        run_until(&mut household, (&settings, RunEnd::JobOver), |_| {})?;
        let brain = household.host().and_then(Host::brain).context("a brain")?;
        let map = brain.map().stored();
        Ok(Self {
            scene,
            map,
            map_from_plan,
        })
    }
}

impl HostMemory {
    pub(crate) const ALL: [Self; 2] = [Self::Present, Self::Absent];

    const fn first(self) -> usize {
        match self {
            Self::Present => 0,
            Self::Absent => 1,
        }
    }
}

impl FloorsTrial {
    /// Number of the floor 1 is the true one if it is kept.
    pub(crate) fn of(floors: &[MappedFloor], number: usize, (kept, seed): (HostMemory, u64)) -> Option<Self> {
        let floor = floors.get(number)?;
        let near = (0..FLOORS).map(|step| (number + kept.first() + step) % floors.len());
        let maps = near.enumerate().filter_map(|(place, near)| {
            Some(KeptFloor {
                home: Some(floors.get(near)?.map.clone()),
                ..KeptFloor::new(u16::try_from(place + 1).ok()?)
            })
        });
        let mut household = put_down(floor, seed, maps.collect());
        start_cleaning(&mut household, StrategyName::Systematic);
        let begun_ms = household.robot().now_ms();
        let mut asked_ms = None;
        let mut here = None;
        while here.is_none() && household.robot().now_ms() < begun_ms + LONGEST_MS {
            household.pass_ms(100);
            let view = household.host()?.floors();
            here = view.here;
            if view.question.is_some() && asked_ms.is_none() {
                asked_ms = Some(household.robot().now_ms());
            }
        }
        let ended_ms = household.robot().now_ms();
        let off_m = here.map(|_| off_m(&household, floor));
        let outcome = match (here, kept, off_m) {
            (Some(1), HostMemory::Present, Some(off_m)) if off_m < PLACE_M => FloorsOutcome::Right,
            (Some(1), HostMemory::Present, _) => FloorsOutcome::Misplaced,
            (Some(_), _, _) => FloorsOutcome::Wrong,
            (None, _, _) if asked_ms.is_some() => FloorsOutcome::Asked,
            (None, _, _) => FloorsOutcome::Silent,
        };
        let until_ms = here.map_or(asked_ms.unwrap_or(ended_ms), |_| ended_ms);
        Some(Self {
            home: floor.scene.home().name().to_owned(),
            seed,
            kept,
            outcome,
            time_s: (until_ms - begun_ms) as f64 / 1000.0,
            off_m,
        })
    }
}

fn put_down(floor: &MappedFloor, seed: u64, floors: Vec<KeptFloor>) -> Household {
    let scene = &floor.scene;
    let mut random = Pcg::new(seed, STREAM);
    let start = place::draw(scene.home(), 0.175, &mut random);
    let settings = RobotSettings {
        seed: seed + 1_000,
        ..RobotSettings::default()
    };
    let robot = scene.robot_at(Some(start), settings.seed, &settings);
    let config = CoreConfig {
        floors,
        ..core_config(scene, settings.seed, StrategyName::Systematic)
    };
    Household::new(robot, Host::start(0, config))
}

/// How far the believed place is from the true one in the map of the floor.
fn off_m(household: &Household, floor: &MappedFloor) -> f64 {
    let truth = floor.map_from_plan.then(household.robot().world().truth().pose);
    let believed = household.host().map(Host::pose).unwrap_or_default();
    Pose::new(believed.x, believed.y, believed.heading).distance_m(truth)
}
