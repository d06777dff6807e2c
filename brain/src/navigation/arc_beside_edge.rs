//! Arcs beside floor that ends are driven as corners: straight, a turn on the spot, straight.
//!
//! The cliff sensors sit at the front. On a straight they pass over all floor before the wheels do, and in a turn on the spot the wheels
//! stay on their circle. On an arc the inner wheel cuts the corner on floor that no sensor has passed over: with the outer sensors 95 mm
//! before and 130 mm beside the middle and the wheels 115 mm beside it, on each arc whose radius is less than 0.42 m. Edges are
//! known where a sensor has met them, and their corners mostly are not.

use super::smoothing::PathSegment;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::{Point2, Pose2};

/// Arcs of a larger radius are safe, metres.
const RADIUS_SAFE_M: f64 = 0.42;
/// An edge that was met at this distance from the arc may go on to it, metres.
const EDGE_REACH_M: f64 = 0.6;

/// The corner that this arc rounds, if it is tight and the floor ends near it.
pub(super) fn corner_beside_edge(
    arc: &PathSegment,
    knowledge: &Raster<CellKnowledge>,
) -> Option<[PathSegment; 3]> {
    let is_tight = arc.length_m > 0.0 && arc.length_m < RADIUS_SAFE_M * arc.turn_rad.abs();
    (is_tight && is_near_edge(arc.at(0.5).position(), knowledge)).then(|| corner(arc))
}

/// The straights whose corner the arc cuts, and the turn between them.
fn corner(arc: &PathSegment) -> [PathSegment; 3] {
    let radius_m = arc.length_m / arc.turn_rad.abs();
    let straight_m = radius_m * libm::tan(0.5 * arc.turn_rad.abs());
    let straight = |start: Pose2| PathSegment {
        start,
        length_m: straight_m,
        turn_rad: 0.0,
    };
    let before = straight(arc.start);
    let turn = PathSegment {
        start: before.at(1.0),
        length_m: 0.0,
        turn_rad: arc.turn_rad,
    };
    [before, turn, straight(turn.at(1.0))]
}

fn is_near_edge(at: Point2, knowledge: &Raster<CellKnowledge>) -> bool {
    let reach = (EDGE_REACH_M / CELL_M) as i32;
    let middle = Cell::under(at);
    let is_edge = |cell: Cell| {
        knowledge.get(cell) == Some(&CellKnowledge::Cliff) && cell.middle().distance_m(at) <= EDGE_REACH_M
    };
    (-reach..=reach).any(|rise| {
        (-reach..=reach).any(|shift| {
            is_edge(Cell {
                x: middle.x.saturating_add(shift),
                y: middle.y.saturating_add(rise),
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::corner_beside_edge;
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::navigation::PathSegment;

    const ARC: PathSegment = PathSegment {
        start: Pose2 {
            x_m: 1.0,
            y_m: 1.0,
            heading_rad: 0.0,
        },
        length_m: 0.3 * FRAC_PI_2,
        turn_rad: FRAC_PI_2,
    };

    /// Floor of 4 m by 4 m that ends at one place.
    fn floor(edge: Point2) -> Raster<CellKnowledge> {
        let mut floor = Raster::filled(Cell { x: 0, y: 0 }, 160, 160, CellKnowledge::Free);
        *floor.get_mut(Cell::under(edge)).expect("in the window") = CellKnowledge::Cliff;
        floor
    }

    #[test]
    fn a_tight_arc_beside_an_edge_is_driven_as_a_corner_with_the_same_end() {
        let near = floor(Point2 { x_m: 1.0, y_m: 1.4 });
        let corner = corner_beside_edge(&ARC, &near).expect("a corner");
        let [before, turn, after] = corner;
        assert_eq!((before.turn_rad, turn.length_m, after.turn_rad), (0.0, 0.0, 0.0));
        let (end, arc_end) = (after.at(1.0), ARC.at(1.0));
        assert!(end.position().distance_m(arc_end.position()) < 1e-9, "{end:?}");
        assert!((end.heading_rad - arc_end.heading_rad).abs() < 1e-9);
        assert_eq!(turn.start, before.at(1.0));
        assert_eq!(after.start, turn.at(1.0));
    }

    #[test]
    fn wide_arcs_straights_turns_and_arcs_far_from_edges_stay() {
        let near = floor(Point2 { x_m: 1.0, y_m: 1.4 });
        let far = floor(Point2 { x_m: 3.0, y_m: 3.0 });
        assert_eq!(corner_beside_edge(&ARC, &far), None);
        for (length_m, turn_rad) in [(0.5 * FRAC_PI_2, FRAC_PI_2), (0.5, 0.0), (0.0, 1.0)] {
            let segment = PathSegment {
                length_m,
                turn_rad,
                ..ARC
            };
            assert_eq!(corner_beside_edge(&segment, &near), None, "{segment:?}");
        }
    }
}
