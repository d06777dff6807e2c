//! The path of the robot, and where it touched something or detected a cliff.

use crate::model::geometry::Point2;

/// Least distance between consecutive path points.
const PATH_STEP_MM: i64 = 20;
/// Most points of one path: 4 km, more than any battery drives.
const PATH_POINTS_MAX: usize = 200_000;
/// Most hazards of one map.
const HAZARDS_MAX: usize = 50_000;

/// A point of the path, in millimetres of the map frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathPoint {
    /// Millimetres.
    pub x_mm: i32,
    /// Millimetres.
    pub y_mm: i32,
}

/// What the robot detected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HazardKind {
    /// The bumper touched something.
    Contact,
    /// The floor ends.
    Cliff,
}

/// A position where the robot touched something or detected a cliff.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hazard {
    /// Position in the map frame.
    pub at: Point2,
    /// What was detected.
    pub kind: HazardKind,
}

/// The path, thinned.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    points: Vec<PathPoint>,
}

impl Path {
    pub(super) fn points(&self) -> &[PathPoint] {
        &self.points
    }

    pub(super) fn follow(&mut self, position: Point2) {
        let point = PathPoint {
            x_mm: millimetres(position.x_m),
            y_mm: millimetres(position.y_m),
        };
        let far_enough = self.points.last().is_none_or(|last| {
            let dx = i64::from(point.x_mm) - i64::from(last.x_mm);
            let dy = i64::from(point.y_mm) - i64::from(last.y_mm);
            dx * dx + dy * dy >= PATH_STEP_MM * PATH_STEP_MM
        });
        if far_enough && self.points.len() < PATH_POINTS_MAX {
            self.points.push(point);
        }
    }

    /// Path length in metres, to the precision of one step.
    pub(super) fn length_m(&self) -> f64 {
        let steps = self.points.len().saturating_sub(1) as f64;
        0.001 * steps * PATH_STEP_MM as f64
    }

    pub(super) fn extend(&mut self, points: &[PathPoint]) {
        let room = PATH_POINTS_MAX.saturating_sub(self.points.len());
        self.points.extend(points.iter().take(room));
    }
}

fn millimetres(length_m: f64) -> i32 {
    libm::round(length_m * 1000.0) as i32
}

/// An odometry position and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StampedOdometry {
    pub(crate) time_us: u64,
    pub(crate) odom: Point2,
}

/// All hazards of a map.
#[derive(Clone, Debug, Default)]
pub(super) struct HazardLog {
    hazards: Vec<Hazard>,
    /// When and where by odometry each hazard was detected; `None` = its position is final.
    seen: Vec<Option<StampedOdometry>>,
}

impl HazardLog {
    pub(super) fn all(&self) -> &[Hazard] {
        &self.hazards
    }

    pub(super) fn add(&mut self, hazard: Hazard, seen: Option<StampedOdometry>) {
        if self.hazards.len() < HAZARDS_MAX {
            self.hazards.push(hazard);
            self.seen.push(seen);
        }
    }

    /// Moves the hazards to their corrected positions.
    pub(super) fn moved(&mut self, place: impl Fn(u64, Point2) -> Point2) {
        for (hazard, seen) in self.hazards.iter_mut().zip(&self.seen) {
            if let Some(seen) = seen {
                hazard.at = place(seen.time_us, seen.odom);
            }
        }
    }

    /// Drops hazards detected from `since_us` on.
    pub(super) fn roll_back(&mut self, since_us: u64) {
        let hazards = self.hazards.iter().zip(&self.seen);
        let kept = hazards.filter(|(_, seen)| seen.is_none_or(|seen| seen.time_us < since_us));
        (self.hazards, self.seen) = kept.map(|(hazard, seen)| (*hazard, *seen)).unzip();
    }

    /// Makes all present positions final.
    pub(super) fn finalize(&mut self) {
        self.seen.fill(None);
    }
}

#[cfg(test)]
mod tests {
    use super::Path;
    use crate::model::geometry::Point2;

    #[test]
    fn the_path_is_thinned_to_two_centimetres() {
        let mut path = Path::default();
        for step in 0..=100 {
            path.follow(Point2 {
                x_m: f64::from(step) * 0.005,
                y_m: 0.0,
            });
        }
        assert_eq!(path.points().len(), 26, "0.5 m in steps of 2 cm and the start");
        assert_eq!(path.points()[25].x_mm, 500);
        assert!((path.length_m() - 0.5).abs() < 1e-9);
    }
}
