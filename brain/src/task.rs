//! The seam between the state machine and everything that knows how to drive: strategies, spot cleaning, docking.

use core::fmt::Debug;

use crate::action::{Decision, Motion};
use crate::behavior::Reason;
use crate::config::BrainConfig;
use crate::coverage::SweptShare;
use crate::docking::BeamMemory;
use crate::geometry::{Point2, Pose2};
use crate::localization::{Advance, Localization, PoseEstimate};
use crate::mapping::Map;
use crate::observation::Observation;
use crate::random::Random;

/// What a task sees in one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Situation<'step> {
    pub(crate) observation: &'step Observation,
    /// What was moved since the last step.
    pub(crate) advance: Advance,
    /// Pose in the map.
    pub(crate) pose: Pose2,
    /// The pose again, and how sure it is.
    pub(crate) estimate: PoseEstimate,
    /// What is known of the home.
    pub(crate) map: &'step Map,
    /// What is seen is compared with a map of the home that is good enough for it.
    pub(crate) is_tracked: bool,
    /// Deviation of the gyro's scale, relative, where only what the robot does on purpose tells it soon; `None` = it has no gyro, or
    /// a map tells it.
    pub(crate) gyro_scale_sigma: Option<f64>,
    /// Deviation of the gyro's bias, rad/s; `None` = it has no gyro.
    pub(crate) gyro_bias_sigma_rad_per_s: Option<f64>,
    /// Way for which backing may still be commanded, in metres.
    pub(crate) way_back_m: f64,
    /// What is heard of the dock, and where it was heard.
    pub(crate) beams: &'step BeamMemory,
    pub(crate) config: &'step BrainConfig,
    /// Something besides the wheels tells the heading; without, no map is kept.
    pub(crate) knows_heading: bool,
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    pub(crate) touching: bool,
    /// A cliff is seen, or the firmware still holds the wheels because of one.
    pub(crate) at_cliff: bool,
}

impl<'step> Situation<'step> {
    pub(crate) fn new(
        observation: &'step Observation,
        advance: Advance,
        (localization, map, beams): (&Localization, &'step Map, &'step BeamMemory),
        config: &'step BrainConfig,
    ) -> Self {
        Self {
            observation,
            advance,
            pose: localization.pose(),
            estimate: localization.estimate(),
            map,
            is_tracked: localization.explained().is_some(),
            gyro_scale_sigma: localization.surveyed_gyro_scale_sigma(observation.time_us),
            gyro_bias_sigma_rad_per_s: localization.gyro_bias_sigma_rad_per_s(observation.time_us),
            way_back_m: localization.way_back_m(),
            beams,
            config,
            knows_heading: localization.knows_heading(observation.time_us),
            touching: observation.is_touching(),
            at_cliff: observation.is_at_cliff(),
        }
    }

    /// Nothing is touched and no cliff seen.
    pub(crate) fn is_free(&self) -> bool {
        !self.touching && !self.at_cliff
    }
}

/// What a task may use besides its eyes.
#[derive(Debug)]
pub(crate) struct Mind {
    pub(crate) random: Random,
    pub(crate) journal: Vec<Decision>,
}

impl Mind {
    pub(crate) fn decide(&mut self, what: &'static str, reason: Reason, value: f64) {
        self.journal.push(Decision {
            what,
            reason: reason.name(),
            value,
        });
    }
}

/// What a task wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Plan {
    /// Move so.
    Go(Motion),
    /// It cannot go on by its own means: the recovery ladder's turn.
    Trouble(Reason),
    /// It is done.
    Finished(Reason),
}

/// Something that drives the robot while the state machine lets it. Coverage strategies are tasks; a new one is a new
/// implementation and a new [`crate::StrategyName`].
pub(crate) trait Task: Debug + Send {
    /// What to do now. A task never asks to drive towards a pressed bumper or a cliff.
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan;

    /// The robot was moved by somebody else (a person, the recovery ladder) or stood still: half-done manoeuvres are void.
    fn interrupted(&mut self);

    /// Corners of the way that it means to drive from here on, for people who look; none where it decides as it goes.
    fn way(&self) -> Vec<Point2> {
        Vec::new()
    }

    /// How much of the floor that it wants it has swept; `None` where it does not know what there is to sweep.
    fn swept_share(&self, _map: &Map) -> Option<SweptShare> {
        None
    }
}
