//! Follows a path of arcs, straights and turns on the spot by the pose in the map.
//!
//! Terms. *Segment*: see [`PathSegment`]. *Offset*: distance of the robot from the segment it follows, left positive.

use super::arc_beside_edge::corner_beside_edge;
use super::{PathSegment, Situation};
use crate::model::action::Motion;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::navigation::parameters::{CHASSIS, PATH_FOLLOWER};

/// A path that is being driven.
#[derive(Clone, Debug, Default)]
pub(crate) struct PathFollower {
    segments: Vec<PathSegment>,
    current: usize,
    /// The segment that was looked at as it began.
    begun: Option<usize>,
    /// Remaining turn on the spot, once it has begun.
    turn_left_rad: Option<f64>,
}

/// State of the path after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FollowStep {
    /// It goes on.
    Going(Motion),
    /// The robot is at its end.
    Arrived,
    /// The robot is too far from it.
    Off,
}

/// Corrections that the surroundings require at this moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caution {
    /// Speed limit.
    pub(crate) speed_m_per_s: f64,
    /// Offset to keep to the left of the path (negative: to the right).
    pub(crate) offset_m: f64,
    /// Correction to the left of the current position (negative: to the right), unless the path leads farther that way
    /// anyhow.
    pub(crate) aside_m: f64,
    /// Straight distance until a contact, as far as sensors see.
    pub(crate) ahead_m: f64,
}

impl Default for Caution {
    /// No obstacle is near.
    fn default() -> Self {
        Self {
            speed_m_per_s: f64::INFINITY,
            offset_m: 0.0,
            aside_m: 0.0,
            ahead_m: f64::INFINITY,
        }
    }
}

impl Caution {
    /// The part of an offset that is to be corrected.
    fn off_m(&self, offset_m: f64) -> f64 {
        let off_m = offset_m - self.offset_m;
        if self.aside_m > 0.0 {
            off_m.min(-self.aside_m)
        } else if self.aside_m < 0.0 {
            off_m.max(-self.aside_m)
        } else {
            off_m
        }
    }
}

/// The position of the robot relative to a segment.
struct SegmentPosition {
    segment: PathSegment,
    /// Distance along the segment.
    along_m: f64,
    offset_m: f64,
    /// Heading relative to that of the path.
    heading_rad: f64,
}

impl PathFollower {
    pub(crate) fn new(segments: Vec<PathSegment>) -> Self {
        Self {
            segments,
            current: 0,
            begun: None,
            turn_left_rad: None,
        }
    }

    /// Corners of the remaining path, arcs by their ends and middles.
    pub(crate) fn remaining_path(&self) -> Vec<Point2> {
        let left = self.segments.get(self.current..).unwrap_or_default();
        let mut corners = Vec::with_capacity(left.len() + 1);
        for segment in left.iter().filter(|segment| !is_turn(segment)) {
            if corners.is_empty() {
                corners.push(segment.start.position());
            }
            if segment.turn_rad != 0.0 {
                corners.push(segment.at(0.5).position());
            }
            corners.push(segment.at(1.0).position());
        }
        corners
    }

    /// The point of the path beside the robot, while it keeps away from an obstacle beside a straight.
    pub(crate) fn beside(&self, situation: &Situation<'_>) -> Option<Point2> {
        let segment = self
            .segments
            .get(self.current)
            .filter(|segment| !is_turn(segment) && segment.turn_rad == 0.0)?;
        let position = SegmentPosition::on(segment, situation.pose);
        let off_m = position.offset_m.abs();
        let is_beside = (0.0..=segment.length_m).contains(&position.along_m);
        (is_beside && PATH_FOLLOWER.keeps_away_m.contains(&off_m))
            .then(|| segment.at(position.along_m / segment.length_m).position())
    }

    /// Whether a turn on the spot is in progress.
    pub(crate) fn turns_on_spot(&self) -> bool {
        self.segments.get(self.current).is_some_and(is_turn)
    }

    pub(crate) fn step(&mut self, situation: &Situation<'_>, caution: Caution) -> FollowStep {
        while let Some(segment) = self.segments.get(self.current).copied() {
            if is_turn(&segment) {
                if let Some(motion) = self.turn(&segment, situation) {
                    return FollowStep::Going(motion);
                }
            } else if self.squares_arc(&segment, situation) {
                continue;
            } else {
                let position = SegmentPosition::on(&segment, situation.pose);
                let left_m = segment.length_m - position.along_m;
                let is_at_wall = caution.ahead_m < PATH_FOLLOWER.next_segment_clear_m
                    && left_m < PATH_FOLLOWER.next_segment_left_m
                    && self.current + 1 < self.segments.len();
                let speeds = &situation.config.speeds;
                let speed_m_per_s = segment_speed(&segment, speeds.cruise_m_per_s, speeds.turn_max_rad_per_s);
                if !is_at_wall && left_m > 0.5 * PATH_FOLLOWER.lag_s * speed_m_per_s {
                    return self.drive(&position, situation, caution);
                }
            }
            self.current += 1;
            self.turn_left_rad = None;
        }
        FollowStep::Arrived
    }

    /// Replaces an arc that begins now by the corner that it rounds, where the floor may end beside it.
    fn squares_arc(&mut self, arc: &PathSegment, situation: &Situation<'_>) -> bool {
        if self.begun == Some(self.current) {
            return false;
        }
        self.begun = Some(self.current);
        let Some(corner) = corner_beside_edge(arc, situation.map.knowledge()) else {
            return false;
        };
        self.segments.splice(self.current..=self.current, corner);
        true
    }

    /// The motion of a turn on the spot; `None` when it is finished.
    fn turn(&mut self, segment: &PathSegment, situation: &Situation<'_>) -> Option<Motion> {
        let target_rad = segment.start.heading_rad + segment.turn_rad;
        let error_rad = normalize_rad(target_rad - situation.pose.heading_rad);
        // A half turn keeps its direction.
        let left_rad = match self.turn_left_rad {
            Some(before_rad) if error_rad.abs() > PATH_FOLLOWER.half_turn_from_rad => {
                error_rad.abs().copysign(before_rad)
            }
            Some(_) => error_rad,
            None if error_rad.abs() > PATH_FOLLOWER.half_turn_from_rad => {
                error_rad.abs().copysign(segment.turn_rad)
            }
            None => error_rad,
        };
        self.turn_left_rad = Some(left_rad);
        if left_rad.abs() < PATH_FOLLOWER.turn_done_rad {
            return None;
        }
        let fastest = situation
            .config
            .speeds
            .turn_max_rad_per_s
            .max(CHASSIS.turn_min_rad_per_s);
        let rate = (CHASSIS.turn_gain_per_s * left_rad.abs()).clamp(CHASSIS.turn_min_rad_per_s, fastest);
        Some(Motion::Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: rate.copysign(left_rad),
        })
    }

    fn drive(&self, position: &SegmentPosition, situation: &Situation<'_>, caution: Caution) -> FollowStep {
        let segment = &position.segment;
        if position.offset_m.abs() > PATH_FOLLOWER.lost_m {
            return FollowStep::Off;
        }
        let turn_max = situation.config.speeds.turn_max_rad_per_s;
        if position.heading_rad.abs() > PATH_FOLLOWER.turn_first_rad {
            return FollowStep::Going(Motion::Drive {
                speed_m_per_s: 0.0,
                turn_rad_per_s: -turn_max.copysign(position.heading_rad),
            });
        }
        let cruise_m_per_s = situation.config.speeds.cruise_m_per_s;
        let left_m = segment.length_m - position.along_m;
        let free_m_per_s = segment_speed(segment, cruise_m_per_s, turn_max)
            .min(self.braked(left_m, cruise_m_per_s, turn_max))
            .max(CHASSIS.speed_min_m_per_s);
        let speed_m_per_s = free_m_per_s.min(caution.speed_m_per_s.max(CHASSIS.speed_min_m_per_s));
        let curvature = self.curvature_ahead(segment, left_m, PATH_FOLLOWER.lag_s * speed_m_per_s);
        let offset_m = caution.off_m(position.offset_m);
        let steer = -PATH_FOLLOWER.heading_gain_per_s * position.heading_rad
            - PATH_FOLLOWER.offset_gain * speed_m_per_s * offset_m;
        let steer = if steer.abs() < PATH_FOLLOWER.steer_min_rad_per_s {
            0.0
        } else {
            steer
        };
        // A robot with a heading error turns first.
        let facing = libm::cos(position.heading_rad).max(PATH_FOLLOWER.facing_min);
        FollowStep::Going(Motion::Drive {
            speed_m_per_s: speed_m_per_s * facing,
            // Caution does not slow the turn: an arc gets tighter before an obstacle, and turns away from it.
            turn_rad_per_s: (free_m_per_s * facing * curvature + steer).clamp(-turn_max, turn_max),
        })
    }

    /// The speed from which it can brake for the next segment.
    fn braked(&self, left_m: f64, cruise_m_per_s: f64, turn_max: f64) -> f64 {
        let after_m_per_s = match self.segments.get(self.current + 1) {
            Some(next) if !is_turn(next) => segment_speed(next, cruise_m_per_s, turn_max),
            _ => 0.0,
        };
        libm::sqrt(after_m_per_s * after_m_per_s + 2.0 * PATH_FOLLOWER.brake_m_per_s2 * left_m.max(0.0))
    }

    /// Curvature of the path a little ahead.
    fn curvature_ahead(&self, segment: &PathSegment, left_m: f64, ahead_m: f64) -> f64 {
        let there = if ahead_m < left_m {
            Some(segment)
        } else {
            self.segments.get(self.current + 1).filter(|next| !is_turn(next))
        };
        there.map_or(0.0, curvature)
    }
}

fn is_turn(segment: &PathSegment) -> bool {
    segment.length_m <= 0.0
}

fn curvature(segment: &PathSegment) -> f64 {
    segment.turn_rad / segment.length_m
}

fn segment_speed(segment: &PathSegment, cruise_m_per_s: f64, turn_max: f64) -> f64 {
    if segment.turn_rad == 0.0 {
        cruise_m_per_s
    } else {
        cruise_m_per_s.min(PATH_FOLLOWER.arc_share * turn_max / curvature(segment).abs())
    }
}

impl SegmentPosition {
    fn on(segment: &PathSegment, pose: Pose2) -> Self {
        let local = segment.start.inverse() * pose;
        // Before its start an arc continues as a straight: the circle of a tight arc deviates within centimetres.
        if segment.turn_rad == 0.0 || local.x_m < 0.0 {
            return Self {
                segment: *segment,
                along_m: local.x_m,
                offset_m: local.y_m,
                heading_rad: local.heading_rad,
            };
        }
        // Relative to the centre of the arc, with the start below it for a left turn and above it for a right one.
        let radius_m = segment.length_m / segment.turn_rad;
        let (x_m, y_m) = (local.x_m, local.y_m - radius_m);
        let side = radius_m.signum();
        let angle_rad = libm::atan2(x_m, -y_m * side);
        Self {
            segment: *segment,
            along_m: angle_rad * radius_m.abs(),
            offset_m: side * (radius_m.abs() - libm::sqrt(x_m * x_m + y_m * y_m)),
            heading_rad: normalize_rad(local.heading_rad - angle_rad * side),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Caution, PathSegment, SegmentPosition};
    use crate::model::geometry::Pose2;

    #[test]
    fn a_sideways_correction_is_relative_to_the_robot_unless_the_path_needs_more() {
        let aside = |aside_m: f64| Caution {
            aside_m,
            ..Caution::default()
        };
        assert_eq!(aside(0.0).off_m(0.02), 0.02);
        // Offset to the right: the correction exceeds that of the path a little, then it is smaller.
        assert_eq!(aside(0.03).off_m(-0.01), -0.03);
        assert_eq!(aside(0.03).off_m(-0.05), -0.05);
        // Offset to the left of a path with an obstacle on the right: the offset stays.
        assert_eq!(aside(0.01).off_m(0.02), -0.01);
        assert_eq!(aside(-0.01).off_m(-0.02), 0.01);
    }

    #[test]
    fn a_robot_on_an_arc_has_no_offset_and_one_inside_of_it_has() {
        for turn_rad in [1.2, -1.2] {
            let start = Pose2 {
                x_m: 0.3,
                y_m: -0.1,
                heading_rad: 0.7,
            };
            let segment = PathSegment {
                start,
                length_m: 0.3,
                turn_rad,
            };
            let there = segment.at(0.5);
            let position = SegmentPosition::on(&segment, there);
            assert!((position.along_m - 0.15).abs() < 1e-9 && position.offset_m.abs() < 1e-9);
            assert!(position.heading_rad.abs() < 1e-9);
            let left = there.transform(crate::model::geometry::Point2 { x_m: 0.0, y_m: 0.02 });
            let position = SegmentPosition::on(
                &segment,
                Pose2 {
                    x_m: left.x_m,
                    y_m: left.y_m,
                    ..there
                },
            );
            assert!((position.offset_m - 0.02).abs() < 1e-9, "{}", position.offset_m);
        }
    }
}
