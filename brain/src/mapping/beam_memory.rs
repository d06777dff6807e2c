//! Remembers where the robot received beams of the dock.
//!
//! A cleaning robot crosses the beams. Without a dock in the map it returns to these positions first.

use std::collections::VecDeque;

use super::dock_beam_filter::{DockBeamFilter, Lobe};
use crate::model::geometry::Point2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;

/// Positions closer together than this are one, metres.
const SAME_M: f64 = 0.3;
/// Most positions; the oldest is dropped first.
const PLACES_MAX: usize = 60;
/// A position is dropped when the pose uncertainty has grown by this much since, metres. Beams reach 3 m.
const DRIFTED_M: f64 = 1.5;

/// Received beams: the present ones and the positions of earlier ones.
#[derive(Debug, Default)]
pub(crate) struct BeamMemory {
    current: DockBeamFilter,
    places: VecDeque<BeamPlace>,
}

/// A position where a beam was received.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BeamPlace {
    pub(crate) at: Point2,
    /// Both beams were received: the position is on the dock's centre line.
    pub(crate) on_line: bool,
    sigma_m: f64,
    pub(crate) received_us: u64,
}

impl BeamMemory {
    /// Adds one observation. Lifting the robot or losing its pose clears the memory.
    pub(crate) fn update(&mut self, observation: &Observation, estimate: &PoseEstimate) {
        self.current.update(&observation.dock_beams);
        if observation.wheel_drop || estimate.lost {
            self.places.clear();
            return;
        }
        self.places
            .retain(|place| estimate.sigma_m - place.sigma_m < DRIFTED_M);
        if self.current.is_any() {
            self.note(observation.time_us, estimate);
        }
    }

    /// The dock was moved.
    pub(crate) fn forget(&mut self) {
        self.places.clear();
    }

    fn note(&mut self, time_us: u64, estimate: &PoseEstimate) {
        let at = estimate.pose.position();
        let mut on_line = self.current.lobe() == Lobe::Both;
        if let Some(index) = self
            .places
            .iter()
            .position(|place| place.at.distance_m(at) < SAME_M)
            && let Some(before) = self.places.remove(index)
        {
            if before.on_line && !on_line {
                self.places.push_back(BeamPlace {
                    received_us: time_us,
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
            received_us: time_us,
        });
    }

    /// Whether there is a position to return to.
    pub(crate) fn has_received_dock(&self) -> bool {
        !self.places.is_empty()
    }

    /// What the receivers receive now.
    pub(crate) fn current(&self) -> &DockBeamFilter {
        &self.current
    }

    /// Positions where a beam was received, the oldest first.
    pub(crate) fn places(&self) -> impl Iterator<Item = &BeamPlace> {
        self.places.iter()
    }
}
