//! A run that is seen again.

use std::fmt::Write as _;

use rvac_api::{RunTrack, TrackPose};

use super::picture::cm;

/// Poses farther apart in time than this have nothing between them: the robot stood, or it was not recorded.
const GAP_S: f32 = 30.0;

/// A run that is seen again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Replay {
    poses: Vec<TrackPose>,
    /// When its recordings begin. Nothing is drawn from one to the next: the robot may have been carried, or the next one has
    /// another map.
    begins: Vec<f32>,
}

impl Replay {
    /// The one in the recordings.
    #[must_use]
    pub fn new(track: &RunTrack) -> Self {
        let mut poses = track.poses.clone();
        poses.retain(|TrackPose(t, x, y, heading)| [t, x, y, heading].iter().all(|value| value.is_finite()));
        poses.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut begins = track.begins_s.clone();
        begins.retain(|begin| begin.is_finite());
        begins.sort_by(f32::total_cmp);
        Self { poses, begins }
    }

    /// How many recordings have begun at that time.
    fn part_at(&self, t: f32) -> usize {
        self.begins.partition_point(|begin| *begin <= t)
    }

    /// When it ends, seconds since the run began.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.poses.last().map_or(0.0, |pose| f64::from(pose.0))
    }

    /// Where the robot was: x and y in centimetres with y downwards, and the turn of its picture in degrees, clockwise.
    #[must_use]
    pub fn robot_at(&self, t_s: f64) -> Option<(f64, f64, f64)> {
        let t = t_s as f32;
        let after = self.poses.partition_point(|pose| pose.0 <= t);
        let before = self.poses.get(after.saturating_sub(1))?;
        let TrackPose(from_s, mut x, mut y, heading) = *before;
        if let Some(TrackPose(to_s, next_x, next_y, _)) = self.poses.get(after)
            && to_s - from_s > 0.0
            && to_s - from_s < GAP_S
            && self.part_at(from_s) == self.part_at(*to_s)
        {
            let share = ((t - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
            x += share * (next_x - x);
            y += share * (next_y - y);
        }
        let (x, y, heading) = (f64::from(x), f64::from(y), f64::from(heading));
        Some((100.0 * x, -100.0 * y, -heading.to_degrees()))
    }

    /// The path up to that time, in the path syntax of SVG.
    #[must_use]
    pub fn path_until(&self, t_s: f64) -> String {
        let t = t_s as f32;
        let driven = self.poses.partition_point(|pose| pose.0 <= t);
        let mut path = String::new();
        let mut part_before = None;
        for TrackPose(at, x, y, _) in self.poses.iter().take(driven) {
            let part = Some(self.part_at(*at));
            let letter = if part == part_before { 'L' } else { 'M' };
            part_before = part;
            // Writing to a string does not fail.
            write!(path, "{letter}{} {}", cm(f64::from(*x)), cm(-f64::from(*y))).ok();
        }
        path
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{RunTrack, TrackPose};

    use super::Replay;

    fn replay(poses: &[TrackPose]) -> Replay {
        Replay::new(&RunTrack {
            poses: poses.to_vec(),
            ..RunTrack::default()
        })
    }

    #[test]
    fn the_robot_goes_along_its_poses() {
        let replay = replay(&[
            TrackPose(1.0, 0.0, 0.0, 0.0),
            TrackPose(2.0, 1.0, 0.5, 0.0),
            TrackPose(90.0, 3.0, 0.5, 1.0),
        ]);
        assert_eq!(replay.end_s(), 90.0);
        assert_eq!(
            replay.robot_at(0.0),
            Some((0.0, 0.0, 0.0)),
            "it stands before it drives"
        );
        assert_eq!(replay.robot_at(1.5), Some((50.0, -25.0, 0.0)));
        assert_eq!(
            replay.robot_at(60.0),
            Some((100.0, -50.0, 0.0)),
            "nothing between far moments"
        );
        assert_eq!(replay.robot_at(500.0).map(|at| at.0), Some(300.0));
        assert_eq!(replay.path_until(2.0), "M0 0L100 -50");
        assert_eq!(replay.path_until(0.5), "");
    }

    #[test]
    fn nothing_is_drawn_from_one_recording_to_the_next() {
        let replay = Replay::new(&RunTrack {
            begins_s: vec![0.0, 2.0],
            poses: vec![
                TrackPose(1.0, 0.0, 0.0, 0.0),
                TrackPose(1.5, 0.5, 0.0, 0.0),
                TrackPose(2.0, 2.0, 1.0, 0.0),
                TrackPose(3.0, 3.0, 1.0, 0.0),
            ],
            ..RunTrack::default()
        });
        assert_eq!(replay.robot_at(1.9), Some((50.0, 0.0, 0.0)));
        assert_eq!(replay.robot_at(2.5), Some((250.0, -100.0, 0.0)));
        assert_eq!(replay.path_until(9.0), "M0 0L50 0M200 -100L300 -100");
    }

    #[test]
    fn of_nothing_nothing_is_seen() {
        let none = replay(&[TrackPose(f32::NAN, 0.0, 0.0, 0.0)]);
        assert_eq!((none.robot_at(1.0), none.end_s()), (None, 0.0));
    }
}
