//! The recent track, whose points may still be corrected.
//!
//! In the middle of a large room no wall is in sight, and the pose estimate drifts by centimetres until the robot sees one
//! again. The error that is corrected then built up before, while the pose became less certain. So the correction is
//! distributed back along the track, which shows strips that a lane left out beside the one before it.

use std::collections::VecDeque;

use super::parameters::RECENT_TRACK;
use crate::model::advance::Advance;
use crate::model::geometry::{Point2, Pose2};
use crate::model::pose_estimate::PoseEstimate;

/// A point of the track.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrackPoint {
    /// The estimated position at that time.
    estimated: Point2,
    /// A point beside it whose floor is not worth another drive.
    beside: Option<Point2>,
    sigma_m: f64,
    /// The error of the estimate, as far as known now.
    error: Point2,
}

impl TrackPoint {
    /// The corrected position, and the one given up beside it. A small error is as likely an error of the correction.
    pub(super) fn swept_from(&self) -> impl Iterator<Item = Point2> {
        let shift = beyond_tolerance(self.error);
        [Some(self.estimated), self.beside]
            .into_iter()
            .flatten()
            .map(move |point| plus(point, shift, 1.0))
    }
}

/// The part of an error that exceeds the tolerance.
fn beyond_tolerance(error: Point2) -> Point2 {
    let error_m = error.distance_m(Point2::ORIGIN);
    plus(
        Point2::ORIGIN,
        error,
        1.0 - RECENT_TRACK.tolerance_m / error_m.max(RECENT_TRACK.tolerance_m),
    )
}

fn plus(point: Point2, by: Point2, share: f64) -> Point2 {
    Point2 {
        x_m: point.x_m + share * by.x_m,
        y_m: point.y_m + share * by.y_m,
    }
}

/// The points, the newest last.
#[derive(Debug, Default)]
pub(super) struct RecentTrack {
    points: VecDeque<TrackPoint>,
    last: Option<Pose2>,
    /// The correction that is not distributed yet.
    due: Point2,
}

impl RecentTrack {
    /// Extends the track to the current pose estimate. With `advance` the difference between the expected and the estimated
    /// pose is distributed; without, points stay as estimated. Gives the points that are settled now.
    pub(super) fn follow(&mut self, estimate: &PoseEstimate, advance: Option<Advance>) -> Vec<TrackPoint> {
        let at = estimate.pose.position();
        let mut settled = Vec::new();
        if let (Some(last), Some(advance)) = (self.last, advance) {
            let expected = last.after_arc(advance.distance_m, advance.turn_rad).position();
            if estimate.lost || expected.distance_m(at) > RECENT_TRACK.carried_m {
                self.due = Point2::ORIGIN;
                settled.extend(self.points.drain(..));
            } else {
                self.due = plus(self.due, plus(at, expected, -1.0), 1.0);
                self.distribute_correction();
            }
        }
        self.last = Some(estimate.pose);
        if self
            .points
            .back()
            .is_none_or(|last| last.estimated.distance_m(at) >= RECENT_TRACK.step_m)
        {
            self.points.push_back(TrackPoint {
                estimated: at,
                beside: None,
                sigma_m: estimate.sigma_m,
                error: Point2::ORIGIN,
            });
        }
        while self.points.len() > RECENT_TRACK.kept_max {
            settled.extend(self.points.pop_front());
        }
        settled
    }

    /// Gives up the floor that would be swept from a point beside the last one.
    pub(super) fn skip_beside(&mut self, beside: Point2) {
        if let Some(last) = self.points.back_mut() {
            last.beside = Some(beside);
        }
    }

    /// The points as they are known now.
    pub(super) fn points(&self) -> impl Iterator<Item = &TrackPoint> {
        self.points.iter()
    }

    /// Forgets all points.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Distributes the pending correction back along the track, in proportion to the uncertainty of each point.
    fn distribute_correction(&mut self) {
        if self.due.distance_m(Point2::ORIGIN) < RECENT_TRACK.distributed_from_m {
            return;
        }
        let due = core::mem::replace(&mut self.due, Point2::ORIGIN);
        let (mut share, mut later_m) = (1.0, 0.0);
        for point in self.points.iter_mut().rev() {
            if later_m > point.sigma_m {
                share *= point.sigma_m / later_m;
            }
            if share < RECENT_TRACK.share_min {
                return;
            }
            later_m = point.sigma_m;
            point.error = plus(point.error, due, share);
            share *= 1.0 - RECENT_TRACK.step_m / RECENT_TRACK.fade_m;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{RECENT_TRACK, RecentTrack, TrackPoint};
    use crate::model::advance::Advance;
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::pose_estimate::PoseEstimate;

    fn estimated(x_m: f64, y_m: f64, sigma_m: f64) -> PoseEstimate {
        PoseEstimate {
            pose: Pose2 {
                x_m,
                y_m,
                heading_rad: 0.0,
            },
            sigma_m,
            ..PoseEstimate::default()
        }
    }

    fn ahead(distance_m: f64) -> Option<Advance> {
        Some(Advance {
            distance_m,
            ..Advance::default()
        })
    }

    /// Two metres along x, after which the position turns out to be `off_m` to the left. The pose gets less certain on the
    /// drive.
    fn corrected(off_m: f64) -> RecentTrack {
        let mut track = RecentTrack::default();
        for step in 0..=100 {
            let x_m = 0.02 * f64::from(step);
            assert!(
                track
                    .follow(&estimated(x_m, 0.0, 0.01 + 0.02 * x_m), ahead(0.02))
                    .is_empty()
            );
        }
        track.follow(&estimated(2.0, off_m, 0.01), ahead(0.0));
        track
    }

    fn swept_from(point: &TrackPoint) -> Point2 {
        point.swept_from().next().unwrap()
    }

    #[test]
    fn a_correction_moves_uncertain_points_and_keeps_certain_ones() {
        let track = corrected(0.1);
        let points: Vec<Point2> = track.points().map(swept_from).collect();
        let (first, middle, last) = (points[0], points[50], points[100]);
        assert_eq!(first, Point2::ORIGIN);
        assert!(
            (last.y_m - (0.1 - RECENT_TRACK.tolerance_m)).abs() < 1e-9,
            "{last:?}"
        );
        assert!((0.01..0.05).contains(&middle.y_m), "{middle:?}");
    }

    #[test]
    fn floor_given_up_beside_the_track_moves_with_it() {
        let mut track = RecentTrack::default();
        track.follow(&estimated(0.0, 0.0, 0.05), ahead(0.0));
        track.skip_beside(Point2 { x_m: 0.0, y_m: 0.02 });
        track.follow(&estimated(0.0, 0.1, 0.01), ahead(0.0));
        let given_up = track.points().next().unwrap().swept_from().nth(1).unwrap();
        assert!(
            (given_up.y_m - (0.12 - RECENT_TRACK.tolerance_m)).abs() < 1e-9,
            "{given_up:?}"
        );
    }

    #[test]
    fn small_corrections_move_nothing() {
        let track = corrected(RECENT_TRACK.tolerance_m);
        assert!(
            track
                .points()
                .take(101)
                .all(|point| swept_from(point).y_m.abs() < 1e-9)
        );
    }

    #[test]
    fn carrying_the_robot_does_not_move_its_track() {
        let mut track = corrected(0.0);
        let settled = track.follow(&estimated(5.0, 3.0, 0.01), ahead(0.0));
        assert_eq!(settled.len(), 101);
        assert_eq!(
            settled.last().map(swept_from),
            Some(Point2 { x_m: 2.0, y_m: 0.0 })
        );
        assert_eq!(track.points().count(), 1);
    }

    #[test]
    fn without_a_map_for_corrections_points_stay() {
        let mut track = RecentTrack::default();
        track.follow(&estimated(0.0, 0.0, 0.05), None);
        track.follow(&estimated(0.0, 0.2, 0.01), None);
        assert_eq!(track.points().next().map(swept_from), Some(Point2::ORIGIN));
    }
}
