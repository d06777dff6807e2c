//! The way of the robot and the places where it met something.

use crate::model::geometry::Point2;

/// Points of the way are at least this far apart.
const PATH_STEP_MM: i64 = 20;
/// Points kept of one way: 4 km, more than any battery drives.
const PATH_POINTS_MAX: usize = 200_000;
/// Marks kept of one map.
const MARKS_MAX: usize = 50_000;

/// A point of the way, in millimetres of the map frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathPoint {
    /// Millimetres.
    pub x_mm: i32,
    /// Millimetres.
    pub y_mm: i32,
}

/// What was met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// The bumper touched something.
    Contact,
    /// The floor ends.
    Cliff,
}

/// A place where something was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Where, in the map frame.
    pub at: Point2,
    /// What.
    pub kind: MarkKind,
}

/// The way, thinned.
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

    /// Its length, metres; what is shorter than a step is not in it.
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

/// When something was met, and where by odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenAt {
    pub(crate) time_us: u64,
    pub(crate) odom: Point2,
}

/// Places where something was met.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    marks: Vec<Mark>,
    /// For each mark how it was met; `None` = it stays where it is.
    seen: Vec<Option<SeenAt>>,
}

impl Marks {
    pub(super) fn all(&self) -> &[Mark] {
        &self.marks
    }

    pub(super) fn add(&mut self, mark: Mark, seen: Option<SeenAt>) {
        if self.marks.len() < MARKS_MAX {
            self.marks.push(mark);
            self.seen.push(seen);
        }
    }

    /// Puts the marks where the robot met them as far as is known now.
    pub(super) fn moved(&mut self, place: impl Fn(u64, Point2) -> Point2) {
        for (mark, seen) in self.marks.iter_mut().zip(&self.seen) {
            if let Some(seen) = seen {
                mark.at = place(seen.time_us, seen.odom);
            }
        }
    }

    /// Drops what was met from `since_us` on.
    pub(super) fn withdraw(&mut self, since_us: u64) {
        let marks = self.marks.iter().zip(&self.seen);
        let kept = marks.filter(|(_, seen)| seen.is_none_or(|seen| seen.time_us < since_us));
        (self.marks, self.seen) = kept.map(|(mark, seen)| (*mark, *seen)).unzip();
    }

    /// The marks up to now stay where they are.
    pub(super) fn settle(&mut self) {
        self.seen.fill(None);
    }
}

#[cfg(test)]
mod tests {
    use super::Path;
    use crate::model::geometry::Point2;

    #[test]
    fn the_way_is_thinned_to_two_centimetres() {
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
