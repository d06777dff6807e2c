//! Whether the robot gets anywhere: the bounding box of where it has been.

use super::parameters::PEN;
use crate::model::geometry::Point2;

/// What became of the robot in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Whereabouts {
    /// Still in the box.
    Inside,
    /// Still in the box, but away from where it was held.
    MovedOff,
    /// Out of the box. Where it first got stuck, if it did.
    Left(Option<Point2>),
}

/// The bounding box of where the robot has been since it last left one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pen {
    /// Lower left and upper right corner.
    corners: Option<(Point2, Point2)>,
    time_s: f64,
    /// Time at which the robot next counts as penned; `None` = the default.
    due_s: Option<f64>,
    held_at: Option<Point2>,
    stuck_at: Option<Point2>,
}

impl Pen {
    /// Updates the box with the robot's position.
    pub(crate) fn follow(&mut self, place: Point2, time_s: f64) -> Whereabouts {
        let (low, high) = self.corners.unwrap_or((place, place));
        let low = Point2 {
            x_m: low.x_m.min(place.x_m),
            y_m: low.y_m.min(place.y_m),
        };
        let high = Point2 {
            x_m: high.x_m.max(place.x_m),
            y_m: high.y_m.max(place.y_m),
        };
        if low.distance_m(high) > PEN.left_m {
            let stuck_at = self.stuck_at;
            *self = Self {
                corners: Some((place, place)),
                ..Self::default()
            };
            return Whereabouts::Left(stuck_at);
        }
        self.corners = Some((low, high));
        self.time_s += time_s;
        if self
            .held_at
            .is_some_and(|held| held.distance_m(place) > PEN.moved_off_m)
        {
            self.held_at = None;
            return Whereabouts::MovedOff;
        }
        Whereabouts::Inside
    }

    /// The robot is held here.
    pub(crate) fn hold(&mut self, place: Point2) {
        self.held_at.get_or_insert(place);
        self.stuck_at.get_or_insert(place);
    }

    /// The robot is penned here, and recovery begins.
    pub(crate) fn begin_recovery(&mut self, place: Point2) {
        self.stuck_at.get_or_insert(place);
    }

    /// A behavior is over: the task gets some time before the robot counts as penned again.
    pub(crate) fn try_again(&mut self) {
        let due_s = self.due_s.unwrap_or(PEN.patience_s);
        self.due_s = Some(due_s.max(self.time_s + PEN.patience_again_s));
    }

    /// Whether the robot counts as penned now.
    pub(crate) fn is_due(&self) -> bool {
        self.time_s >= self.due_s.unwrap_or(PEN.patience_s)
    }

    /// Whether a job that ends here, with most of the home not swept, ends in a pen.
    pub(crate) fn holds_the_end(&self) -> bool {
        self.time_s >= PEN.ends_in_pen_s
    }
}

#[cfg(test)]
mod tests {
    use super::{Pen, Whereabouts};
    use crate::model::geometry::Point2;

    fn at(x_m: f64) -> Point2 {
        Point2 { x_m, y_m: 0.0 }
    }

    #[test]
    fn a_robot_that_moves_to_and_fro_is_penned_and_one_that_moves_away_has_left() {
        let mut pen = Pen::default();
        for second in 0..239 {
            assert_eq!(
                pen.follow(at(f64::from(second % 10) * 0.15), 1.0),
                Whereabouts::Inside
            );
            assert!(!pen.is_due(), "{second}");
        }
        pen.follow(at(0.0), 1.0);
        assert!(pen.is_due());
        pen.begin_recovery(at(0.5));
        pen.try_again();
        assert!(!pen.is_due());
        (0..45).for_each(|_| {
            pen.follow(at(0.2), 1.0);
        });
        assert!(pen.is_due());
        assert_eq!(pen.follow(at(-1.0), 1.0), Whereabouts::Left(Some(at(0.5))));
        assert!(!pen.is_due());
        assert_eq!(pen.follow(at(-3.4), 1.0), Whereabouts::Left(None));
    }

    #[test]
    fn moving_off_is_reported_once() {
        let mut pen = Pen::default();
        pen.follow(at(0.0), 1.0);
        pen.hold(at(0.0));
        assert_eq!(pen.follow(at(0.2), 1.0), Whereabouts::Inside);
        assert_eq!(pen.follow(at(0.31), 1.0), Whereabouts::MovedOff);
        assert_eq!(pen.follow(at(0.32), 1.0), Whereabouts::Inside);
    }
}
