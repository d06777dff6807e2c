//! The home as earlier runs left it: the reference of this run.
//!
//! The sensors of a run show the same walls as those of earlier runs, from poses with other errors. Drawn where the pose places them,
//! they would become a second wall beside the first one, and walls would get thicker with each run. So a hit that a known obstacle
//! explains is *associated* with it: it confirms that obstacle and makes no new one. This is the data association of a map of
//! landmarks (Durrant-Whyte and Bailey 2006), with the nearest solid cell as the landmark.

use super::distance::DistanceField;
use super::occupancy_grid::{Evidence, OccupancyGrid, is_seen_solid};
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Which known obstacle explains a reading.
struct ExplanationParameters {
    /// A known obstacle explains a hit up to this distance from it, metres: the error of pose and distance together. In a flat of
    /// 26 square metres the 90th percentile of the pose's error was 13 to 22 cm.
    reach_m: f64,
    /// A known touch explains one up to so many cells beside it: the bearing of a contact is known to a quarter of the body.
    touch_cells: i32,
}

const EXPLANATION: ExplanationParameters = ExplanationParameters {
    reach_m: 0.1,
    touch_cells: 2,
};

/// What explains an infrared hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hit {
    /// The obstacle in this cell, which it confirms.
    Known(Cell),
    /// An obstacle whose cell cannot be told.
    Near,
    /// Nothing that is known.
    New,
}

/// What explains a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touched {
    /// An obstacle that infrared has seen.
    Seen,
    /// An obstacle that was touched in this cell.
    Again(Cell),
    /// Nothing that is known.
    New,
}

/// The home as earlier runs left it.
#[derive(Debug)]
pub(super) struct KeptHome {
    grid: OccupancyGrid,
    /// Distances to what infrared has seen. Touches are not in it: a hit beside a touch is something else.
    seen: DistanceField,
}

impl KeptHome {
    /// The home in `grid`, for this knowledge of it.
    pub(super) async fn of(
        grid: &OccupancyGrid,
        knowledge: &Raster<CellKnowledge>,
        budget: &mut StepBudget,
    ) -> Self {
        let mut seen = knowledge.clone();
        for (cell, evidence) in grid.gathered() {
            if !is_seen_solid(evidence)
                && let Some(kind) = seen.get_mut(cell)
                && *kind == CellKnowledge::Occupied
            {
                *kind = CellKnowledge::Unknown;
            }
            budget.spend(1).await;
        }
        Self {
            grid: grid.clone(),
            seen: DistanceField::in_steps(&seen, budget).await,
        }
    }

    /// What was known of a cell when the run began.
    pub(super) fn at(&self, cell: Cell) -> Evidence {
        self.grid.at(cell)
    }

    /// All of it.
    pub(super) fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// What explains an infrared hit in `cell`.
    pub(super) fn hit(&self, cell: Cell) -> Hit {
        let middle = cell.middle();
        let gap_m = self.seen.at(middle);
        if gap_m > EXPLANATION.reach_m {
            return Hit::New;
        }
        if is_seen_solid(self.at(cell)) {
            return Hit::Known(cell);
        }
        let away = self.seen.gradient(middle);
        let length = libm::sqrt(away.x_m * away.x_m + away.y_m * away.y_m);
        let (x, y) = (away.x_m / length.max(1e-9), away.y_m / length.max(1e-9));
        // The gradient is that of an interpolated field, so the first try may miss a corner.
        [0.5, 1.0, 0.0, 1.5]
            .into_iter()
            .map(|beyond| gap_m + beyond * CELL_M)
            .map(|distance_m| {
                Cell::under(Point2 {
                    x_m: middle.x_m - x * distance_m,
                    y_m: middle.y_m - y * distance_m,
                })
            })
            .find(|solid| is_seen_solid(self.at(*solid)))
            .map_or(Hit::Near, Hit::Known)
    }

    /// What explains a touch in `cell`.
    pub(super) fn touched(&self, cell: Cell) -> Touched {
        match (self.touched_near(cell), self.hit(cell)) {
            (Some(again), _) => Touched::Again(again),
            (None, Hit::Known(_) | Hit::Near) => Touched::Seen,
            (None, Hit::New) => Touched::New,
        }
    }

    fn touched_near(&self, cell: Cell) -> Option<Cell> {
        let reach = EXPLANATION.touch_cells;
        let around = (-reach..=reach).flat_map(|rise| (-reach..=reach).map(move |shift| (shift, rise)));
        around
            .map(|(shift, rise)| {
                let beside = Cell {
                    x: cell.x.saturating_add(shift),
                    y: cell.y.saturating_add(rise),
                };
                (shift * shift + rise * rise, beside)
            })
            .filter(|(_, beside)| self.at(*beside).past.touched_runs > 0)
            .min_by_key(|(square, _)| *square)
            .map(|(_, beside)| beside)
    }
}
