//! Places to return to because the robot received a dock beam there.

use super::parameters::DOCKING;
use crate::mapping::{BeamMemory, BeamPlace};
use crate::model::geometry::Point2;
use crate::navigation::Goal;

/// A place from which docking failed.
#[derive(Clone, Copy, Debug)]
pub(super) struct FailedPlace {
    pub(super) at: Point2,
    /// Other places within this distance are no better, metres.
    pub(super) within_m: f64,
    pub(super) time_us: u64,
}

/// Places where a beam was received and from which docking has not failed since.
pub(super) fn goals(memory: &BeamMemory, failed: &[FailedPlace]) -> Vec<Goal> {
    let has_failed = |place: &&BeamPlace| {
        failed.iter().any(|failed| {
            failed.time_us >= place.received_us && failed.at.distance_m(place.at) < failed.within_m
        })
    };
    memory
        .places()
        .filter(|place| !has_failed(place))
        .map(|place| Goal {
            at: place.at,
            detour_m: if place.on_line {
                0.0
            } else {
                DOCKING.beside_detour_m
            },
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{FailedPlace, goals};
    use crate::mapping::BeamMemory;
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::observation::Observation;
    use crate::model::pose_estimate::PoseEstimate;

    /// Drives along x for this many steps of 5 mm and 20 ms; receives `word` for ten steps from `heard` on.
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
            memory.update(&observation, &estimate);
        }
    }

    #[test]
    fn a_beam_is_remembered_until_docking_failed_there_or_the_robot_is_carried() {
        let mut memory = BeamMemory::default();
        driven(&mut memory, 600, 200, 3);
        let heard = goals(&memory, &[]);
        assert_eq!(heard.len(), 1, "{heard:?}");
        assert!((heard[0].at.x_m - 1.03).abs() < 0.05, "{heard:?}");
        let failed = |time_us| FailedPlace {
            at: Point2 { x_m: 1.2, y_m: 0.1 },
            within_m: 0.5,
            time_us,
        };
        assert_eq!(goals(&memory, &[failed(1_000_000)]).len(), 1, "received after it");
        assert_eq!(goals(&memory, &[failed(9_000_000)]).len(), 0);
        let lifted = Observation {
            wheel_drop: true,
            ..Observation::default()
        };
        memory.update(&lifted, &PoseEstimate::default());
        assert_eq!(goals(&memory, &[]).len(), 0);
    }

    #[test]
    fn a_place_that_the_pose_has_drifted_away_from_is_forgotten() {
        let mut memory = BeamMemory::default();
        driven(&mut memory, 300, 200, 1);
        assert_eq!(goals(&memory, &[]).len(), 1);
        let unsure = PoseEstimate {
            sigma_m: 2.0,
            ..PoseEstimate::default()
        };
        memory.update(&Observation::default(), &unsure);
        assert_eq!(goals(&memory, &[]).len(), 0);
    }
}
