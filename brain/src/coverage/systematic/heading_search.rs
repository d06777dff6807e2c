//! A robot without a gyro that hears beacons drives about until they tell its heading.
//!
//! It bounces first: straight lines in several directions locate the beacons soonest. Where they tell no heading for long, or have
//! fallen silent, it cleans by statistics, as a robot without beacons does, and lanes begin as soon as the heading is known.

use super::detour::DetourStep;
use crate::coverage::{Bounce, Statistical};
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;
use crate::navigation::{Situation, Task, TaskContext, TaskStatus};

/// In homes of the measurements the heading is known after 8 to 15 m. Beyond this distance the robot does not count on it, metres.
const BOUNCE_MAX_M: f64 = 40.0;

/// The drive without a heading.
#[derive(Debug, Default)]
pub(super) struct HeadingSearch {
    drive: Option<Drive>,
    driven_m: f64,
}

/// How it drives.
#[derive(Debug)]
enum Drive {
    Bounce(Box<Bounce>),
    ByStatistics(Box<Statistical>),
}

impl HeadingSearch {
    /// Somebody else moved the robot.
    pub(super) fn interrupted(&mut self) {
        match &mut self.drive {
            Some(Drive::Bounce(bounce)) => bounce.interrupted(),
            Some(Drive::ByStatistics(statistical)) => statistical.interrupted(),
            None => {}
        }
    }

    pub(super) fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> DetourStep {
        // A gyro that was lost may come back, and is waited for elsewhere.
        let is_needed = !situation.knows_heading && situation.gyro_fault.is_none();
        if self.drive.is_none() && !is_needed {
            return DetourStep::Idle;
        }
        let may_end = situation.is_free() && !self.is_evading();
        if !is_needed && may_end {
            context.decide(DecisionKind::HeadingFound, Reason::BeaconsHeard, self.driven_m);
            *self = Self::default();
            return DetourStep::Over;
        }
        self.driven_m += situation.advance.distance_m.abs();
        DetourStep::Driving(self.drive(situation, context))
    }

    fn is_evading(&self) -> bool {
        match &self.drive {
            Some(Drive::Bounce(bounce)) => bounce.is_evading(),
            Some(Drive::ByStatistics(statistical)) => statistical.is_evading(),
            None => false,
        }
    }

    fn drive(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let is_hopeful = situation.hears_beacons && self.driven_m <= BOUNCE_MAX_M;
        let drive = match self.drive.take() {
            None if is_hopeful => {
                context.decide(DecisionKind::FindHeading, Reason::BeaconsHeard, 0.0);
                Drive::Bounce(Box::default())
            }
            Some(Drive::Bounce(bounce)) if is_hopeful || bounce.is_evading() => Drive::Bounce(bounce),
            None | Some(Drive::Bounce(_)) => {
                let reason = if situation.hears_beacons {
                    Reason::NoHeading
                } else {
                    Reason::BeaconsSilent
                };
                context.decide(DecisionKind::CleanByStatistics, reason, self.driven_m);
                Drive::ByStatistics(Box::new(Statistical::unannounced()))
            }
            Some(drive) => drive,
        };
        match self.drive.insert(drive) {
            Drive::Bounce(bounce) => bounce.step(situation, context),
            Drive::ByStatistics(statistical) => statistical.step(situation, context),
        }
    }
}
