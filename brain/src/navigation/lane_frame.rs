//! The frame in which lanes are planned: turned so that most walls of the home run along its axes.
//!
//! The map's own frame is that of the place where the robot began, which may look anywhere. Lanes that run askew of the walls end
//! at a slant at each of them, and in a corridor they are short and many.

use crate::mapping::{Cell, CellKnowledge, Raster, wall_direction_rad};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;

/// Walls that stand this little askew are planned for as if they did not, radians: the cells of the map are those of the plan then.
const STRAIGHT_RAD: f64 = 0.012;

/// A frame that shares its origin with that of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LaneFrame {
    /// Direction of its x axis in the map.
    direction_rad: f64,
    sin: f64,
    cos: f64,
}

impl LaneFrame {
    /// The map's own.
    pub(crate) const OF_MAP: Self = Self {
        direction_rad: 0.0,
        sin: 0.0,
        cos: 1.0,
    };

    /// With the x axis in this direction of the map.
    pub(crate) fn along(direction_rad: f64) -> Self {
        if direction_rad.abs() < STRAIGHT_RAD {
            return Self::OF_MAP;
        }
        let (sin, cos) = libm::sincos(direction_rad);
        Self {
            direction_rad,
            sin,
            cos,
        }
    }

    /// Along the walls of what is known; the map's own when those show no direction.
    pub(crate) async fn of_walls(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Self {
        Self::along(wall_direction_rad(knowledge, budget).await.unwrap_or(0.0))
    }

    /// A point of the map in this frame.
    pub(crate) fn point(&self, in_map: Point2) -> Point2 {
        Point2 {
            x_m: in_map.x_m * self.cos + in_map.y_m * self.sin,
            y_m: in_map.y_m * self.cos - in_map.x_m * self.sin,
        }
    }

    /// A point of this frame in the map.
    pub(crate) fn point_in_map(&self, point: Point2) -> Point2 {
        Point2 {
            x_m: point.x_m * self.cos - point.y_m * self.sin,
            y_m: point.y_m * self.cos + point.x_m * self.sin,
        }
    }

    /// The cell of the map in which the middle of a cell of this frame lies.
    pub(crate) fn cell_in_map(&self, cell: Cell) -> Cell {
        if *self == Self::OF_MAP {
            return cell;
        }
        Cell::under(self.point_in_map(cell.middle()))
    }

    /// A pose of the map in this frame.
    pub(crate) fn pose(&self, in_map: Pose2) -> Pose2 {
        self.in_map().inverse() * in_map
    }

    /// This frame as a pose of the map.
    pub(crate) fn in_map(&self) -> Pose2 {
        Pose2 {
            heading_rad: self.direction_rad,
            ..Pose2::IDENTITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LaneFrame;
    use crate::mapping::Cell;
    use crate::model::geometry::{Point2, Pose2};

    #[test]
    fn there_and_back_is_where_it_was() {
        let frame = LaneFrame::along(0.6);
        let at = Point2 { x_m: 1.3, y_m: -4.2 };
        assert!(frame.point_in_map(frame.point(at)).distance_m(at) < 1e-12);
        let pose = Pose2 {
            x_m: at.x_m,
            y_m: at.y_m,
            heading_rad: 3.0,
        };
        let back = frame.in_map() * frame.pose(pose);
        assert!(back.position().distance_m(at) < 1e-12 && (back.heading_rad - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_wall_that_hardly_stands_askew_leaves_cells_as_they_are() {
        let frame = LaneFrame::along(0.01);
        assert_eq!(frame, LaneFrame::OF_MAP);
        let cell = Cell { x: -7, y: 3 };
        assert_eq!(frame.cell_in_map(cell), cell);
        assert_ne!(
            LaneFrame::along(0.7).cell_in_map(Cell { x: 100, y: 3 }),
            Cell { x: 100, y: 3 }
        );
    }
}
