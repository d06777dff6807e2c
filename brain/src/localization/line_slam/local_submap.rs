//! Divides the path into submaps: short stretches along walls.

use super::OdometryStep;
use super::line_segment::{LineSegment, RangePoint, extract_segments};
use super::parameters::SUBMAP;
use crate::model::advance::Advance;
use crate::model::config::ProximityLayout;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::observation::Observation;

/// A completed submap.
#[derive(Clone, Debug)]
pub(super) struct LocalSubmap {
    /// When it ended.
    pub(super) time_us: u64,
    /// Pose at its end, by odometry.
    pub(super) odom: Pose2,
    /// Its segments, in the frame of the robot at its end.
    pub(super) segments: Vec<LineSegment>,
}

/// The submap that is being recorded.
#[derive(Clone, Debug, Default)]
pub(super) struct SubmapBuilder {
    points: Vec<RangePoint>,
    distance_m: f64,
    unseen_m: f64,
    step_m: f64,
    step_rad: f64,
    spin: Spin,
}

/// A turn on the spot.
#[derive(Clone, Copy, Debug, Default)]
struct Spin {
    turned_rad: f64,
    distance_m: f64,
    /// Number of points when it began.
    began: usize,
}

impl Spin {
    fn follow(&mut self, advance: Advance, points: usize) {
        self.distance_m += advance.distance_m.abs();
        self.turned_rad += advance.turn_rad;
        if self.distance_m > SUBMAP.spin_distance_max_m {
            *self = Self {
                began: points,
                ..Self::default()
            };
        }
    }

    fn is_whole_turn(&self) -> bool {
        self.turned_rad.abs() > SUBMAP.spin_min_rad
    }
}

impl SubmapBuilder {
    /// Takes the pose by odometry and the sensor readings there. Returns the submap that ends here.
    pub(super) fn follow(
        &mut self,
        step: OdometryStep,
        observation: &Observation,
        layout: &ProximityLayout,
    ) -> Option<LocalSubmap> {
        let OdometryStep { odom, advance } = step;
        let distance_m = advance.distance_m.abs();
        self.step_m += distance_m;
        self.step_rad += advance.turn_rad.abs();
        if !self.points.is_empty() {
            self.distance_m += distance_m;
            self.unseen_m += distance_m;
        }
        self.spin.follow(advance, self.points.len());
        let is_spinning = self.spin.is_whole_turn();
        if !is_spinning && (self.step_m >= SUBMAP.step_m || self.step_rad >= SUBMAP.step_rad) {
            (self.step_m, self.step_rad) = (0.0, 0.0);
            self.sample(odom, observation, layout);
        }
        let is_cut = is_spinning && !self.points.is_empty();
        let over = is_cut
            || self.unseen_m >= SUBMAP.unseen_max_m
            || self.distance_m >= SUBMAP.length_max_m
            || self.points.len() >= SUBMAP.points_max;
        if !over {
            return None;
        }
        let next = Self {
            spin: Spin {
                began: 0,
                ..self.spin
            },
            ..Self::default()
        };
        let mut log = core::mem::replace(self, next);
        if is_cut {
            log.points.truncate(log.spin.began);
        }
        let base_from_odom = odom.inverse();
        let segments = extract_segments(&log.points, &layout.response)
            .into_iter()
            .map(|segment| LineSegment {
                middle: base_from_odom.transform(segment.middle),
                normal_rad: normalize_rad(segment.normal_rad - odom.heading_rad),
                ..segment
            })
            .collect();
        Some(LocalSubmap {
            time_us: observation.time_us,
            odom,
            segments,
        })
    }

    fn sample(&mut self, odom: Pose2, observation: &Observation, layout: &ProximityLayout) {
        for (sensor, level) in layout.sensors().iter().zip(&observation.proximity) {
            let level = f64::from(*level);
            let seen = layout
                .response
                .distance_m(level)
                .filter(|_| level >= SUBMAP.level_min);
            if let Some(seen_m) = seen {
                self.unseen_m = 0.0;
                self.points.push(RangePoint {
                    beam: odom * *sensor,
                    seen_m,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LocalSubmap, OdometryStep, SubmapBuilder};
    use crate::model::advance::Advance;
    use crate::model::config::{ProximityLayout, ProximityResponse};
    use crate::model::geometry::{Pose2, normalize_rad};
    use crate::model::observation::Observation;
    use core::f64::consts::{FRAC_PI_2, TAU};

    /// Scale error of this gyro.
    const ERROR: f64 = 0.01;

    /// One sensor that faces right.
    fn layout() -> ProximityLayout {
        let response = ProximityResponse {
            range_m: 0.25,
            half_angle_rad: 0.0,
            half_level_m: 0.06,
            skin_m: 0.01,
            near_m: None,
        };
        ProximityLayout::ring(&[-FRAC_PI_2], 0.16, response)
    }

    /// A robot that drives along a wall on its right, 0.2 m from its centre, and sometimes turns on the spot.
    #[derive(Default)]
    struct Ride {
        truth: Pose2,
        odom: Pose2,
        log: SubmapBuilder,
        submaps: Vec<LocalSubmap>,
    }

    impl Ride {
        fn step(&mut self, distance_m: f64, turn_rad: f64) {
            let layout = layout();
            self.truth = self.truth.after_arc(distance_m, turn_rad);
            self.odom = self.odom.after_arc(distance_m, turn_rad * (1.0 + ERROR));
            let beam = self.truth * layout.sensors()[0];
            let toward = -beam.heading_rad.sin();
            let clear_m = (beam.y_m + 0.2) / toward.max(1e-9);
            let level = layout.response.level(clear_m);
            let observation = Observation {
                proximity: vec![level as f32],
                ..Observation::default()
            };
            let advance = Advance {
                distance_m,
                turn_rad: turn_rad * (1.0 + ERROR),
                ..Advance::default()
            };
            let step = OdometryStep {
                odom: self.odom,
                advance,
            };
            self.submaps.extend(self.log.follow(step, &observation, &layout));
        }

        fn drive(&mut self, centimetres: u32) {
            (0..2 * centimetres).for_each(|_| self.step(0.005, 0.0));
        }

        fn turn(&mut self, turns: f64) {
            (0..600).for_each(|_| self.step(0.0, turns * TAU / 600.0));
        }

        /// Direction of the longest wall of the submap, by odometry.
        fn normal_rad(&self, submap: usize) -> f64 {
            let submap = &self.submaps[submap];
            normalize_rad(submap.odom.heading_rad + submap.segments[0].normal_rad)
        }
    }

    #[test]
    fn whole_turns_separate_submaps_and_show_the_scale_error() {
        let mut ride = Ride::default();
        ride.drive(50);
        ride.turn(3.0);
        ride.drive(75);
        assert_eq!(ride.submaps.len(), 2);
        assert!(ride.submaps.iter().all(|submap| submap.segments.len() == 1));
        let off_rad = normalize_rad(ride.normal_rad(1) - ride.normal_rad(0));
        assert!((off_rad - 3.0 * TAU * ERROR).abs() < 0.02, "{off_rad}");
    }

    #[test]
    fn a_turn_at_a_corner_does_not_end_the_submap() {
        let mut ride = Ride::default();
        ride.drive(20);
        ride.turn(0.25);
        assert!(ride.submaps.is_empty());
    }
}
