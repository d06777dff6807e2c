//! What the robot hears of its dock, and where it heard it: whoever cleans passes the dock's beams, and a robot that has no map
//! with a dock in it goes back there first.

use std::collections::VecDeque;

use super::hearing::{Hearing, Lobe};
use crate::coverage::plan::Goal;
use crate::geometry::Point2;
use crate::localization::PoseEstimate;
use crate::observation::Observation;

/// Places nearer to each other than this are one place, metres.
const SAME_M: f64 = 0.3;
/// Places kept; those that were heard longest ago go first.
const PLACES_MAX: usize = 60;
/// A place is forgotten when the pose has become so much less sure since, metres: beams reach 3 m.
const DRIFTED_M: f64 = 1.5;
/// What is as good as a place on the line in front of the dock may be so much nearer, metres.
const ASIDE_DETOUR_M: f64 = 0.5;

/// The memory.
#[derive(Debug, Default)]
pub(crate) struct BeamMemory {
    hearing: Hearing,
    places: VecDeque<Place>,
}

/// A place where a beam was heard.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: Point2,
    on_line: bool,
    sigma_m: f64,
    heard_us: u64,
}

/// A place from which the robot did not get onto the dock.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vain {
    pub(super) at: Point2,
    /// Places within this are no better, metres.
    pub(super) within_m: f64,
    pub(super) time_us: u64,
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
                self.places.push_back(Place {
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
        self.places.push_back(Place {
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
    pub(super) fn hearing(&self) -> &Hearing {
        &self.hearing
    }

    /// Places where a beam was heard and not looked for in vain since.
    pub(super) fn goals(&self, vain: &[Vain]) -> Vec<Goal> {
        let is_vain = |place: &&Place| {
            vain.iter()
                .any(|vain| vain.time_us >= place.heard_us && vain.at.distance_m(place.at) < vain.within_m)
        };
        self.places
            .iter()
            .filter(|place| !is_vain(place))
            .map(|place| Goal {
                at: place.at,
                detour_m: if place.on_line { 0.0 } else { ASIDE_DETOUR_M },
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{BeamMemory, Vain};
    use crate::geometry::{Point2, Pose2};
    use crate::localization::PoseEstimate;
    use crate::observation::Observation;

    /// Drives along x for so many steps of 5 mm and 20 ms; hears `word` from `heard` on for ten steps.
    fn driven(memory: &mut BeamMemory, steps: u64, heard: u64, word: u8) {
        for step in 0..steps {
            let is_heard = (heard..heard + 10).contains(&step);
            let observation = Observation {
                time_us: step * 20_000,
                dock_beams: if is_heard { vec![word; 4] } else { Vec::new() },
                ..Observation::default()
            };
            let estimate = PoseEstimate {
                pose: Pose2 {
                    x_m: 0.005 * step as f64,
                    ..Pose2::default()
                },
                ..PoseEstimate::default()
            };
            memory.take(&observation, &estimate);
        }
    }

    #[test]
    fn a_beam_is_remembered_until_it_was_looked_for_in_vain_or_the_robot_is_carried() {
        let mut memory = BeamMemory::default();
        driven(&mut memory, 600, 200, 3);
        let goals = memory.goals(&[]);
        assert_eq!(goals.len(), 1, "{goals:?}");
        assert!((goals[0].at.x_m - 1.03).abs() < 0.05, "{goals:?}");
        let vain = |time_us| Vain {
            at: Point2 { x_m: 1.2, y_m: 0.1 },
            within_m: 0.5,
            time_us,
        };
        assert_eq!(memory.goals(&[vain(1_000_000)]).len(), 1, "heard after it");
        assert_eq!(memory.goals(&[vain(9_000_000)]).len(), 0);
        let lifted = Observation {
            wheel_drop: true,
            ..Observation::default()
        };
        memory.take(&lifted, &PoseEstimate::default());
        assert_eq!(memory.goals(&[]).len(), 0);
    }

    #[test]
    fn a_place_that_the_pose_has_drifted_away_from_is_forgotten() {
        let mut memory = BeamMemory::default();
        driven(&mut memory, 300, 200, 1);
        assert_eq!(memory.goals(&[]).len(), 1);
        let unsure = PoseEstimate {
            sigma_m: 2.0,
            ..PoseEstimate::default()
        };
        memory.take(&Observation::default(), &unsure);
        assert_eq!(memory.goals(&[]).len(), 0);
    }
}
