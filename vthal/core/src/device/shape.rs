//! The outline of a robot seen from above.

use brain::Point2;

/// Corners of the polygon that stands for a circle, or for half of one.
const CIRCLE_CORNERS: usize = 32;

/// Outline seen from above, around the middle of the wheel axis; x is ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A disc around the wheel axis.
    Circle {
        /// Radius in metres.
        radius_m: f64,
    },
    /// A half disc behind the wheel axis and a rectangle of the same width before it.
    D {
        /// Radius of the half disc in metres, half of the width.
        radius_m: f64,
        /// From the wheel axis to the straight front edge, metres.
        front_m: f64,
    },
}

impl Shape {
    /// Radius of the smallest circle around the middle of the wheel axis that holds the robot, metres. A robot may turn
    /// wherever this circle is free.
    #[must_use]
    pub fn circumscribed_radius_m(self) -> f64 {
        match self {
            Self::Circle { radius_m } => radius_m,
            Self::D { radius_m, front_m } => radius_m.max(radius_m.hypot(front_m)),
        }
    }

    /// A polygon that holds the robot, counter-clockwise in the body's frame; its arcs lie outside of the round edges.
    #[must_use]
    pub fn footprint(self) -> Vec<Point2> {
        match self {
            Self::Circle { radius_m } => arc(radius_m, 0..CIRCLE_CORNERS).collect(),
            Self::D { radius_m, front_m } => {
                let front = [-radius_m, radius_m].map(|y_m| Point2 { x_m: front_m, y_m });
                let side = |y_m| Point2 { x_m: 0.0, y_m };
                // The corners of the arc between a quarter and three quarters of a turn.
                let rear = arc(radius_m, CIRCLE_CORNERS / 4..3 * CIRCLE_CORNERS / 4);
                front
                    .into_iter()
                    .chain([side(radius_m)])
                    .chain(rear)
                    .chain([side(-radius_m)])
                    .collect()
            }
        }
    }
}

/// Corners of the polygon around a circle, half a step after the angle of each number.
fn arc(radius_m: f64, corners: core::ops::Range<usize>) -> impl Iterator<Item = Point2> {
    let step_rad = core::f64::consts::TAU / CIRCLE_CORNERS as f64;
    let outer_m = radius_m / (0.5 * step_rad).cos();
    corners.map(move |corner| {
        let (y, x) = ((corner as f64 + 0.5) * step_rad).sin_cos();
        Point2 {
            x_m: outer_m * x,
            y_m: outer_m * y,
        }
    })
}

#[cfg(test)]
mod tests {
    use brain::Point2;

    use super::Shape;

    const D: Shape = Shape::D {
        radius_m: 0.16,
        front_m: 0.12,
    };

    fn area_m2(corners: &[Point2]) -> f64 {
        let next = corners.iter().cycle().skip(1);
        let cross = |(one, other): (&Point2, &Point2)| one.x_m * other.y_m - other.x_m * one.y_m;
        0.5 * corners.iter().zip(next).map(cross).sum::<f64>()
    }

    #[test]
    fn the_circle_around_a_d_reaches_its_front_corners() {
        assert_eq!(D.circumscribed_radius_m(), 0.2);
        assert_eq!(Shape::Circle { radius_m: 0.17 }.circumscribed_radius_m(), 0.17);
    }

    #[test]
    fn footprints_hold_the_robot_and_little_more() {
        let disc_m2 = core::f64::consts::PI * 0.16 * 0.16;
        let circle = area_m2(&Shape::Circle { radius_m: 0.16 }.footprint());
        assert!((1.0..1.01).contains(&(circle / disc_m2)), "{circle}");
        let whole_m2 = 0.5 * disc_m2 + 0.32 * 0.12;
        let d = area_m2(&D.footprint());
        assert!((1.0..1.01).contains(&(d / whole_m2)), "{d} of {whole_m2}");
    }
}
