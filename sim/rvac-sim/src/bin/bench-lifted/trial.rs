//! A robot that is lifted from its work.

use brain::BehaviorState;
use brain::command::StrategyName;
use home::{Pcg, Pose};
use robot::RobotSettings;
use rvac_api::RequestBody;
use rvac_sim::run::{core_config, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use serde::Serialize;

use crate::place;

/// Time after which a robot that still does not know its place is given up, seconds.
const LONGEST_S: u64 = 900;
/// How long it is in the air, and how long it stands before the button is pressed, milliseconds.
const AIR_MS: u64 = 3_000;
const STANDS_MS: u64 = 3_000;
/// A pose counts as known when its error is below the first value, metres; a found pose with an error above the second is wrong.
const RIGHT_M: f64 = 0.3;
const WRONG_M: f64 = 0.5;
/// Radius of the body, metres.
const RADIUS_M: f64 = 0.175;
/// Stream of the draws of this bench.
const STREAM: u64 = 79;

/// What the robot has on its Linux board.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RadioFitted {
    Absent,
    /// It receives so many beacons, and measures their signal strength.
    Strengths(u8),
}

/// What comes before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preparation {
    pub(crate) minutes: u64,
    pub(crate) radio: RadioFitted,
}

/// Outcome of the trial.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LiftedTrial {
    pub(crate) home: String,
    pub(crate) seed: u64,
    /// From the button until it knew its right place, seconds.
    pub(crate) right_s: Option<u64>,
    /// How long it believed before that to be where it was not, seconds.
    pub(crate) wrong_s: u64,
    pub(crate) violations: usize,
}

impl LiftedTrial {
    pub(crate) fn of(scene: &Scene, seed: u64, work: Preparation) -> Self {
        let mut random = Pcg::new(seed, STREAM);
        let there = place::draw(scene.home(), RADIUS_M, &mut random);
        let mut household = household(scene, seed, work.radio);
        start_cleaning(&mut household, StrategyName::Systematic);
        household.pass_ms(work.minutes * 60_000);
        let world = household.robot_mut().world_mut();
        world.lift();
        household.pass_ms(AIR_MS);
        household.robot_mut().world_mut().put_down_at(there);
        household.pass_ms(STANDS_MS);
        go_on(&mut household);
        Self::watch(&mut household, (scene, seed))
    }

    fn watch(household: &mut Household, (scene, seed): (&Scene, u64)) -> Self {
        let mut wrong_s = 0;
        let mut right_s = None;
        for second in 0..LONGEST_S {
            household.pass_ms(1_000);
            let Some(off_m) = believed_off_m(household, scene) else {
                continue;
            };
            if off_m < RIGHT_M {
                right_s = Some(second);
                break;
            }
            wrong_s += u64::from(off_m > WRONG_M);
        }
        Self {
            home: scene.home().name().to_owned(),
            seed,
            right_s,
            wrong_s,
            violations: household.robot().monitor().violations().len(),
        }
    }
}

/// Resumes the job, or begins one if the last one was over when the robot was lifted.
fn go_on(household: &mut Household) {
    household.ask(RequestBody::Resume);
    household.pass_ms(1_000);
    let state = household.host().and_then(Host::state);
    if state != Some(BehaviorState::Cleaning) {
        start_cleaning(household, StrategyName::Systematic);
        household.pass_ms(1_000);
    }
}

fn household(scene: &Scene, seed: u64, radio: RadioFitted) -> Household {
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let robot = scene.robot(seed, &settings);
    let host = Host::start(0, core_config(scene, seed, StrategyName::Systematic));
    let household = Household::new(robot, host).with_known_map();
    match radio {
        RadioFitted::Absent => household,
        RadioFitted::Strengths(beacons) => {
            household.with_beacons(scene.beacons(seed, usize::from(beacons)).by_strength())
        }
    }
}

/// How far the believed place is from the true one, unless the robot says that it is lost.
fn believed_off_m(household: &Household, scene: &Scene) -> Option<f64> {
    let host = household.host()?;
    let estimate = host.brain()?.estimate();
    if estimate.lost {
        return None;
    }
    let truth = household.robot().world().truth().pose;
    let in_map = scene.home().start().inverse().then(truth);
    let believed = Pose::new(estimate.pose.x_m, estimate.pose.y_m, estimate.pose.heading_rad);
    Some(believed.distance_m(in_map))
}
