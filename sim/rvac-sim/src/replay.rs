//! What a robot perceived on one drive, shown again to brains with other seeds: how much of an error of the place is chance of the filter.
//!
//! The drive is made once, with physics, and kept in memory with the true poses. A replay takes a small part of its time.

use brain::{Brain, Command, Observation};
use home::{Pose, wrap_angle};
use serde::Serialize;
use vthal_core::{Record, RunStart};

use crate::figures::Sigma;
use crate::household::Household;
use crate::report::RootMeanSquare;

/// A robot that is wrong by so much and does not know it is unnoticed lost, metres.
const WRONG_M: f64 = 0.5;
/// Errors beyond so many of their standard deviations are the tail.
const TAIL_SIGMAS: f64 = 3.0;

/// Something that the brain was given.
#[derive(Clone, Debug)]
enum Given {
    Command(Command),
    /// With the true pose at that moment, in the frame of the map.
    Observation(Box<Observation>, Pose),
}

/// All that a brain was given on a drive.
#[derive(Clone, Debug)]
pub struct Drive {
    start: Box<RunStart>,
    given: Vec<Given>,
}

/// How well a brain knew its place on a drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ReplayFigures {
    /// Root mean square of the error of the place, metres; `null` = nothing was perceived.
    pub rmse_m: Option<f64>,
    /// The same while the robot does not say that it is lost.
    pub rmse_sure_m: Option<f64>,
    /// Largest error, metres.
    pub error_max_m: f64,
    /// Seconds in which it says that it is lost.
    pub lost_s: f64,
    /// Seconds in which it is wrong by more than half a metre and does not say so.
    pub unnoticed_s: f64,
    /// Mean of the error squared over its variance for each dimension, while it does not say that it is lost.
    pub nees: Option<f64>,
    /// Share of these moments with an error beyond three standard deviations.
    pub tail: Option<f64>,
}

/// Takes down what the brain of a household is given.
#[derive(Debug, Default)]
pub struct DriveRecorder {
    drive: Option<Drive>,
}

impl DriveRecorder {
    /// To be called after each tick. A later run of the same household replaces nothing: the first one is the drive.
    pub fn note(&mut self, household: &mut Household) {
        let truth = household.truth_in_map();
        let records = household.host_mut().map(crate::Host::take_records);
        for record in records.unwrap_or_default() {
            match (record, &mut self.drive) {
                (Record::RunStarted(start), None) => {
                    self.drive = Some(Drive {
                        start,
                        given: Vec::new(),
                    });
                }
                (Record::Command { command, .. }, Some(drive)) => drive.given.push(Given::Command(command)),
                (Record::Observation(observation), Some(drive)) => {
                    drive.given.push(Given::Observation(Box::new(observation), truth));
                }
                _ => {}
            }
        }
    }

    /// The drive; `None` when no run began.
    #[must_use]
    pub fn finish(self) -> Option<Drive> {
        self.drive
    }
}

impl Drive {
    /// Shows the drive to a brain with this seed.
    #[must_use]
    pub fn replay(&self, seed: u64) -> ReplayFigures {
        let mut brain = Brain::new(self.start.brain, seed);
        let mut checkpoint = self.start.checkpoint.clone();
        checkpoint.random_state = seed;
        brain.restore(&checkpoint);
        let mut judge = Judge::default();
        let mut commands = Vec::new();
        for given in &self.given {
            match given {
                Given::Command(command) => commands.push(command.clone()),
                Given::Observation(observation, truth) => {
                    brain.step(observation, &commands);
                    commands.clear();
                    judge.sample(observation, &brain, *truth);
                }
            }
        }
        judge.figures()
    }
}

#[derive(Debug, Default)]
struct Judge {
    whole: RootMeanSquare,
    sure: RootMeanSquare,
    nees: f64,
    sure_count: f64,
    tail_count: f64,
    before_us: Option<u64>,
    figures: ReplayFigures,
}

impl Judge {
    fn sample(&mut self, observation: &Observation, brain: &Brain, truth: Pose) {
        let passed_us = observation.time_us.saturating_sub(
            self.before_us
                .replace(observation.time_us)
                .unwrap_or(observation.time_us),
        );
        if observation.docked {
            return;
        }
        let passed_s = passed_us as f64 * 1e-6;
        let estimate = brain.estimate();
        let believed = Pose::new(estimate.pose.x_m, estimate.pose.y_m, estimate.pose.heading_rad);
        let error_m = believed.distance_m(truth);
        self.whole.add(error_m);
        self.figures.error_max_m = self.figures.error_max_m.max(error_m);
        if estimate.lost {
            self.figures.lost_s += passed_s;
            return;
        }
        self.sure.add(error_m);
        if error_m > WRONG_M {
            self.figures.unnoticed_s += passed_s;
        }
        let sigma = Sigma {
            place_m: estimate.sigma_m,
            heading_rad: estimate.sigma_rad,
        };
        self.nees += sigma.nees_of_place(error_m);
        self.sure_count += 1.0;
        let heading_off = wrap_angle(believed.heading_rad - truth.heading_rad).abs();
        let is_tail = error_m > TAIL_SIGMAS * sigma.place_m || heading_off > TAIL_SIGMAS * sigma.heading_rad;
        self.tail_count += f64::from(u8::from(is_tail));
    }

    fn figures(self) -> ReplayFigures {
        let share = |sum: f64| (self.sure_count > 0.0).then(|| sum / self.sure_count);
        ReplayFigures {
            rmse_m: self.whole.value(),
            rmse_sure_m: self.sure.value(),
            nees: share(self.nees),
            tail: share(self.tail_count),
            ..self.figures
        }
    }
}
