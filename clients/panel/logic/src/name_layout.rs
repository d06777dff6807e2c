//! Names on the map that do not cover each other.

use crate::point::Pixel;

/// Pixels that stay free between two names.
const GAP_PX: f64 = 2.0;

/// Where a name wants to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NameBox {
    /// Its middle on the screen.
    pub middle: Pixel,
    /// Width and height, CSS pixels.
    pub size_px: [f64; 2],
    /// Whether it stays where it is, whatever is there: a number of an order, for example.
    pub is_fixed: bool,
}

impl NameBox {
    fn moved_down(self, way_px: f64) -> Self {
        Self {
            middle: Pixel::new(self.middle.x, self.middle.y + way_px),
            ..self
        }
    }

    fn covers(&self, other: &Self) -> bool {
        let is_near = |way_px: f64, axis: usize| {
            way_px.abs() < 0.5 * (self.size_px[axis] + other.size_px[axis]) + GAP_PX
        };
        is_near(self.middle.x - other.middle.x, 0) && is_near(self.middle.y - other.middle.y, 1)
    }
}

/// How many pixels down each name goes (up, when negative) so that none covers another; `None` for one without room. Fixed ones
/// come first, then the others in their order.
#[must_use]
pub fn lay_out_names(names: &[NameBox]) -> Vec<Option<f64>> {
    let mut taken: Vec<NameBox> = names.iter().filter(|name| name.is_fixed).copied().collect();
    let mut place = |name: &NameBox| {
        if name.is_fixed {
            return Some(0.0);
        }
        let line_px = name.size_px[1] + GAP_PX;
        let free = [0.0, line_px, -line_px].into_iter().find(|way_px| {
            let moved = name.moved_down(*way_px);
            !taken.iter().any(|other| moved.covers(other))
        })?;
        taken.push(name.moved_down(free));
        Some(free)
    };
    names.iter().map(&mut place).collect()
}

#[cfg(test)]
mod tests {
    use super::{NameBox, lay_out_names};
    use crate::point::Pixel;

    fn name(x: f64, y: f64) -> NameBox {
        NameBox {
            middle: Pixel::new(x, y),
            size_px: [60.0, 20.0],
            is_fixed: false,
        }
    }

    #[test]
    fn names_with_room_stay_where_they_are() {
        let names = [name(0.0, 0.0), name(70.0, 0.0), name(0.0, 30.0)];
        assert_eq!(lay_out_names(&names), [Some(0.0); 3]);
    }

    #[test]
    fn one_that_would_cover_another_goes_a_line_down_or_up_or_away() {
        let names = [name(0.0, 0.0), name(20.0, 0.0), name(40.0, 0.0), name(30.0, 0.0)];
        let laid = lay_out_names(&names);
        assert_eq!(laid, [Some(0.0), Some(22.0), Some(-22.0), None]);
    }

    #[test]
    fn a_fixed_one_stays_and_the_others_make_room_whatever_their_order() {
        let number = NameBox {
            is_fixed: true,
            ..name(10.0, 5.0)
        };
        let laid = lay_out_names(&[name(0.0, 0.0), number]);
        assert_eq!(laid[1], Some(0.0));
        assert_eq!(laid[0], Some(-22.0));
        assert_eq!(lay_out_names(&[number, number]), [Some(0.0); 2]);
    }

    #[test]
    fn names_that_are_not_measured_yet_are_all_written() {
        let unknown = |x| NameBox {
            size_px: [0.0, 0.0],
            ..name(x, 0.0)
        };
        assert_eq!(lay_out_names(&[unknown(0.0), unknown(10.0)]), [Some(0.0); 2]);
    }
}
