//! Which strokes lie on which walls.

use super::graph::{Mark, Wall, direction};
use super::square::quarter;
use super::stroke::Stroke;
use super::{NODES_MAX, Survey};
use crate::model::geometry::{Pose2, normalize_rad};

/// A stroke lies on a wall when it is within so many deviations of it,
const GATE: f64 = 3.0;
/// but never farther, metres,
const GATE_MAX_M: f64 = 0.3;
/// and looks the same way, radians: 14 degrees.
const GATE_RAD: f64 = 0.25;
/// Deviation of a wall's own place, metres.
const WALL_SIGMA_M: f64 = 0.03;
/// A stroke may lie this far beyond the known end of a wall, metres.
const BEYOND_M: f64 = 0.6;
/// Another wall that fits nearly as well, metres, makes it open on which one the stroke lies.
const RIVAL_M: f64 = 0.12;

impl Survey {
    /// Lets the strokes of the newest node correct the belief, and remembers on which walls they lie.
    pub(super) fn place_strokes(&mut self, strokes: &[Stroke]) {
        let mut new = Vec::new();
        for stroke in strokes {
            match self.wall_of(stroke) {
                Known::Wall(wall) => {
                    self.correct(stroke, wall);
                    self.mark(*stroke, wall);
                }
                Known::Open => {}
                Known::New => new.push(*stroke),
            }
        }
        for stroke in new {
            if self.here >= NODES_MAX {
                break;
            }
            let wall = self.graph.walls.len();
            let seen = self.new_wall(&stroke);
            self.graph.walls.push(seen);
            self.mark(stroke, wall);
        }
    }

    fn mark(&mut self, stroke: Stroke, wall: usize) {
        let node = self.here;
        if node >= NODES_MAX {
            return;
        }
        self.graph.marks.push(Mark { node, wall, stroke });
        if let Some(wall) = self.graph.walls.get_mut(wall) {
            let (_, along_m) = wall.place_of(self.belief.pose.transform(stroke.middle));
            wall.low_m = wall.low_m.min(along_m - stroke.half_m);
            wall.high_m = wall.high_m.max(along_m + stroke.half_m);
            wall.marks += 1;
        }
    }

    fn new_wall(&self, stroke: &Stroke) -> Wall {
        let pose = self.belief.pose;
        let seen_rad = normalize_rad(pose.heading_rad + stroke.normal_rad);
        let square = self.graph.square_rad;
        let quarter = square
            .and_then(|square_rad| quarter(square_rad, seen_rad, self.belief.sigmas().1 + stroke.sigma_rad));
        let normal_rad = match (square, quarter) {
            (Some(square_rad), Some(quarter)) => {
                normalize_rad(square_rad + f64::from(quarter) * core::f64::consts::FRAC_PI_2)
            }
            _ => seen_rad,
        };
        Wall {
            quarter,
            normal_rad,
            anchor: pose.transform(stroke.middle),
            offset_m: 0.0,
            low_m: -stroke.half_m,
            high_m: stroke.half_m,
            first: self.here,
            marks: 0,
            is_apart: false,
        }
    }

    fn correct(&mut self, stroke: &Stroke, wall: usize) {
        let Some(wall) = self.graph.walls.get(wall).copied() else {
            return;
        };
        let pose = self.belief.pose;
        let off_rad = normalize_rad(pose.heading_rad + stroke.normal_rad - wall.normal_rad);
        let wall_rad2 = if wall.quarter.is_some() { 1e-5 } else { 4e-4 };
        self.belief.measure(
            [0.0, 0.0, 1.0],
            off_rad,
            stroke.sigma_rad * stroke.sigma_rad + wall_rad2,
        );
        let pose = self.belief.pose;
        let at = pose.transform(stroke.middle);
        let (off_m, _) = wall.place_of(at);
        let normal = direction(wall.normal_rad);
        let arm = normal.y_m * (at.x_m - pose.x_m) - normal.x_m * (at.y_m - pose.y_m);
        self.belief.measure(
            [normal.x_m, normal.y_m, arm],
            off_m,
            stroke.sigma_m * stroke.sigma_m + WALL_SIGMA_M * WALL_SIGMA_M,
        );
    }

    /// The wall on which a stroke lies that is seen from where the robot believes to be.
    fn wall_of(&self, stroke: &Stroke) -> Known {
        let pose = self.belief.pose;
        let mut best: Option<(f64, usize)> = None;
        let mut second_m = f64::INFINITY;
        for (index, wall) in self.graph.walls.iter().enumerate() {
            let Some(off_m) = self.off_m(stroke, pose, wall) else {
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
            Some((off_m, wall)) if second_m - off_m >= RIVAL_M || off_m < 0.3 * second_m => Known::Wall(wall),
            Some(_) => Known::Open,
            None => Known::New,
        }
    }

    /// How far a stroke lies off a wall, if it may lie on it.
    fn off_m(&self, stroke: &Stroke, pose: Pose2, wall: &Wall) -> Option<f64> {
        let turned_rad = normalize_rad(pose.heading_rad + stroke.normal_rad - wall.normal_rad);
        if turned_rad.abs() > GATE_RAD {
            return None;
        }
        let (off_m, along_m) = wall.place_of(pose.transform(stroke.middle));
        let beyond_m = (wall.low_m - along_m).max(along_m - wall.high_m) - stroke.half_m;
        let normal = direction(wall.normal_rad);
        let variance_m2 = self.belief.variance_along_m2(normal)
            + stroke.sigma_m * stroke.sigma_m
            + WALL_SIGMA_M * WALL_SIGMA_M;
        let gate_m = (GATE * libm::sqrt(variance_m2)).min(GATE_MAX_M);
        (off_m.abs() <= gate_m && beyond_m <= BEYOND_M).then(|| off_m.abs())
    }
}

/// What is known of the wall of a stroke.
enum Known {
    Wall(usize),
    /// It may be one of several.
    Open,
    New,
}
