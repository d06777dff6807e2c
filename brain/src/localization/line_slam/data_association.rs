//! Data association: which line segments belong to which landmarks.

use super::LineSlam;
use super::graph::{LineLandmark, LineObservation, Projection, direction};
use super::line_segment::LineSegment;
use super::manhattan::quarter;
use super::parameters::{ASSOCIATION, UPDATE};
use crate::model::geometry::{Pose2, normalize_rad};

impl LineSlam {
    /// Corrects the belief with the segments of the newest node and stores them as observations.
    pub(super) fn associate_segments(&mut self, segments: &[LineSegment]) {
        let mut new = Vec::new();
        for segment in segments {
            match self.associate(segment) {
                Association::Landmark(landmark) => {
                    self.correct(segment, landmark);
                    self.add_observation(*segment, landmark);
                }
                Association::Ambiguous => {}
                Association::New => new.push(*segment),
            }
        }
        for segment in new {
            if self.here >= UPDATE.nodes_max {
                break;
            }
            let landmark = self.graph.landmarks.len();
            let seen = self.new_landmark(&segment);
            self.graph.landmarks.push(seen);
            self.add_observation(segment, landmark);
        }
    }

    fn add_observation(&mut self, segment: LineSegment, landmark: usize) {
        let node = self.here;
        if node >= UPDATE.nodes_max {
            return;
        }
        self.graph.observations.push(LineObservation {
            node,
            landmark,
            segment,
        });
        if let Some(landmark) = self.graph.landmarks.get_mut(landmark) {
            let Projection { along_m, .. } = landmark.project(self.belief.pose.transform(segment.middle));
            landmark.low_m = landmark.low_m.min(along_m - segment.half_m);
            landmark.high_m = landmark.high_m.max(along_m + segment.half_m);
            landmark.observation_count += 1;
        }
    }

    fn new_landmark(&self, segment: &LineSegment) -> LineLandmark {
        let pose = self.belief.pose;
        let seen_rad = normalize_rad(pose.heading_rad + segment.normal_rad);
        let manhattan = self.graph.manhattan_rad;
        let quarter = manhattan.and_then(|manhattan_rad| {
            quarter(
                manhattan_rad,
                seen_rad,
                self.belief.sigmas().1 + segment.sigma_rad,
            )
        });
        let normal_rad = match (manhattan, quarter) {
            (Some(manhattan_rad), Some(quarter)) => {
                normalize_rad(manhattan_rad + f64::from(quarter) * core::f64::consts::FRAC_PI_2)
            }
            _ => seen_rad,
        };
        LineLandmark {
            quarter,
            normal_rad,
            anchor: pose.transform(segment.middle),
            offset_m: 0.0,
            low_m: -segment.half_m,
            high_m: segment.half_m,
            first: self.here,
            observation_count: 0,
            is_distinct: false,
        }
    }

    fn correct(&mut self, segment: &LineSegment, landmark: usize) {
        let Some(landmark) = self.graph.landmarks.get(landmark).copied() else {
            return;
        };
        let pose = self.belief.pose;
        let off_rad = normalize_rad(pose.heading_rad + segment.normal_rad - landmark.normal_rad);
        let wall_rad2 = if landmark.quarter.is_some() { 1e-5 } else { 4e-4 };
        self.belief.measure(
            [0.0, 0.0, 1.0],
            off_rad,
            segment.sigma_rad * segment.sigma_rad + wall_rad2,
        );
        let pose = self.belief.pose;
        let at = pose.transform(segment.middle);
        let Projection { off_m, .. } = landmark.project(at);
        let normal = direction(landmark.normal_rad);
        let arm = normal.y_m * (at.x_m - pose.x_m) - normal.x_m * (at.y_m - pose.y_m);
        self.belief.measure(
            [normal.x_m, normal.y_m, arm],
            off_m,
            segment.sigma_m * segment.sigma_m + ASSOCIATION.landmark_sigma_m * ASSOCIATION.landmark_sigma_m,
        );
    }

    /// The landmark to which a segment belongs, seen from the believed pose.
    fn associate(&self, segment: &LineSegment) -> Association {
        let pose = self.belief.pose;
        let mut best: Option<(f64, usize)> = None;
        let mut second_m = f64::INFINITY;
        for (index, landmark) in self.graph.landmarks.iter().enumerate() {
            let Some(off_m) = self.off_m(segment, pose, landmark) else {
                continue;
            };
            match best {
                Some((least_m, _)) if off_m >= least_m => second_m = second_m.min(off_m),
                _ => {
                    second_m = best.map_or(second_m, |(least_m, _)| least_m);
                    best = Some((off_m, index));
                }
            }
        }
        match best {
            Some((off_m, landmark))
                if second_m - off_m >= ASSOCIATION.ambiguity_m || off_m < 0.3 * second_m =>
            {
                Association::Landmark(landmark)
            }
            Some(_) => Association::Ambiguous,
            None => Association::New,
        }
    }

    /// Distance of a segment from a landmark, metres; `None` when it cannot belong to it.
    fn off_m(&self, segment: &LineSegment, pose: Pose2, landmark: &LineLandmark) -> Option<f64> {
        let turned_rad = normalize_rad(pose.heading_rad + segment.normal_rad - landmark.normal_rad);
        if turned_rad.abs() > ASSOCIATION.gate_rad {
            return None;
        }
        let Projection { off_m, along_m } = landmark.project(pose.transform(segment.middle));
        let beyond_m = (landmark.low_m - along_m).max(along_m - landmark.high_m) - segment.half_m;
        let normal = direction(landmark.normal_rad);
        let variance_m2 = self.belief.variance_along_m2(normal)
            + segment.sigma_m * segment.sigma_m
            + ASSOCIATION.landmark_sigma_m * ASSOCIATION.landmark_sigma_m;
        let gate_m = (ASSOCIATION.gate_sigmas * libm::sqrt(variance_m2)).min(ASSOCIATION.gate_max_m);
        (off_m.abs() <= gate_m && beyond_m <= ASSOCIATION.extension_max_m).then(|| off_m.abs())
    }
}

/// The landmark of a segment.
enum Association {
    Landmark(usize),
    /// Several landmarks fit.
    Ambiguous,
    New,
}
