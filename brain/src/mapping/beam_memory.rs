//! What the robot hears of its dock, and where it heard it: whoever cleans passes the dock's beams, and a robot that has no map
//! with a dock in it goes back there first.

use std::collections::VecDeque;

use super::dock_beams::{Hearing, Lobe};
use crate::model::geometry::Point2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// Places nearer to each other than this are one place, metres.
const SAME_M: f64 = 0.3;
/// Places kept; those that were heard longest ago go first.
const PLACES_MAX: usize = 60;
/// A place is forgotten when the pose has become so much less sure since, metres: beams reach 3 m.
const DRIFTED_M: f64 = 1.5;
/// The memory.
#[derive(Debug, Default)]
pub(crate) struct BeamMemory {
    hearing: Hearing,
    places: VecDeque<BeamPlace>,
}

/// A place where a beam was heard.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BeamPlace {
    pub(crate) at: Point2,
    /// Both lobes were heard: it lies on the line that leads straight in.
    pub(crate) on_line: bool,
    sigma_m: f64,
    pub(crate) heard_us: u64,
}

impl BeamMemory {
    /// Takes in what is heard in one observation. Who carries the robot takes its memory away.
    pub(crate) fn take(&mut self, observation: &Observation, estimate: &PoseEstimate) {
        self.hearing.take(&observation.dock_beams);
        if observation.wheel_drop || estimate.lost {
            self.places.clear();
            return;
        }
        self.places
            .retain(|place| estimate.sigma_m - place.sigma_m < DRIFTED_M);
        if self.hearing.is_any() {
            self.note(observation.time_us, estimate);
        }
    }

    /// The dock stands elsewhere now.
    pub(crate) fn forget(&mut self) {
        self.places.clear();
    }

    fn note(&mut self, time_us: u64, estimate: &PoseEstimate) {
        let at = estimate.pose.position();
        let mut on_line = self.hearing.lobe() == Lobe::Both;
        if let Some(index) = self
            .places
            .iter()
            .position(|place| place.at.distance_m(at) < SAME_M)
            && let Some(before) = self.places.remove(index)
        {
            if before.on_line && !on_line {
                self.places.push_back(BeamPlace {
                    heard_us: time_us,
                    ..before
                });
                return;
            }
            on_line |= before.on_line;
        }
        if self.places.len() >= PLACES_MAX {
            self.places.pop_front();
        }
        self.places.push_back(BeamPlace {
            at,
            on_line,
            sigma_m: estimate.sigma_m,
            heard_us: time_us,
        });
    }

    /// Whether a beam was heard somewhere that the robot could go back to.
    pub(crate) fn knows_a_dock(&self) -> bool {
        !self.places.is_empty()
    }

    /// What is heard now.
    pub(crate) fn hearing(&self) -> &Hearing {
        &self.hearing
    }

    /// Places where a beam was heard, those of long ago first.
    pub(crate) fn places(&self) -> impl Iterator<Item = &BeamPlace> {
        self.places.iter()
    }
}
