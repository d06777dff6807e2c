//! Drives through a gap that is slightly too narrow on the map: a touch at a door post, or a wall drawn a cell too thick,
//! closes off everything behind.
//!
//! Where the robot has nothing left to plan, it checks once more what a body without any gap to known obstacles could
//! reach. If that is much more floor, it drives there, and its contacts decide.

use super::parameters::SQUEEZE;
use crate::coverage::plan::CoveragePlan;
use crate::mapping::{Cell, Raster};
use crate::model::config::Body;
use crate::model::gradual::StepBudget;

/// Work to copy a cell with its neighbours.
const GROW_WORK: usize = 20;

/// Checks for a path through a gap, a limited number of times.
#[derive(Debug, Default)]
pub(super) struct Squeeze {
    /// The plan that left nothing, during a check.
    ended: Option<CoveragePlan>,
    tries: u32,
    /// Floor that the newest check found, square metres.
    seen_m2: Option<f64>,
}

impl Squeeze {
    /// Begins a check after a plan that left nothing. `false` when there were enough.
    pub(super) fn begin(&mut self, ended: &CoveragePlan) -> bool {
        if self.tries >= SQUEEZE.tries_max {
            return false;
        }
        self.tries += 1;
        self.ended = Some(ended.clone());
        true
    }

    /// The radius to plan with during a check.
    pub(super) fn radius_m(&self, body: Body) -> Option<f64> {
        self.ended.as_ref().map(|_| body.radius_m - SQUEEZE.slimmer_m)
    }

    /// Ends a check: gives the plan that left nothing.
    pub(super) fn end(&mut self) -> Option<CoveragePlan> {
        self.ended.take()
    }

    /// Records how much floor a check found, square metres.
    pub(super) fn record(&mut self, floor_m2: f64) {
        self.seen_m2 = Some(floor_m2);
    }

    /// Allows one more check if the newest one found this much floor: the robot has moved, and people in the path may have
    /// left meanwhile.
    pub(super) fn allow_one(&mut self, worth_m2: f64) {
        if self.seen_m2.is_none_or(|seen_m2| seen_m2 >= worth_m2) {
            self.tries = self.tries.min(SQUEEZE.tries_max - 1);
        }
    }

    /// No more checks until [`Self::reset_attempts`].
    pub(super) fn end_checks(&mut self) {
        self.tries = SQUEEZE.tries_max;
    }

    /// There is new floor, and there may be new gaps.
    pub(super) fn reset_attempts(&mut self) {
        self.tries = 0;
    }
}

/// Cells near these cells.
pub(super) async fn near(cells: &Raster<bool>, budget: &mut StepBudget) -> Raster<bool> {
    let mut near = cells.clone();
    let (width, origin) = (cells.width().max(1), cells.origin());
    for (row, line) in cells.values().chunks(width).enumerate() {
        for (column, _) in line.iter().enumerate().filter(|(_, cell)| **cell) {
            let (x, y) = (origin.x + column as i32, origin.y + row as i32);
            let around = (-SQUEEZE.near_cells..=SQUEEZE.near_cells)
                .flat_map(|rise| (-SQUEEZE.near_cells..=SQUEEZE.near_cells).map(move |shift| (shift, rise)));
            for (shift, rise) in around {
                if let Some(cell) = near.get_mut(Cell {
                    x: x + shift,
                    y: y + rise,
                }) {
                    *cell = true;
                }
            }
        }
        budget
            .spend(GROW_WORK * line.iter().filter(|cell| **cell).count() + line.len() / 8)
            .await;
    }
    near
}

#[cfg(test)]
mod tests {
    use super::{SQUEEZE, Squeeze, near};
    use crate::coverage::plan::CoveragePlan;
    use crate::mapping::{Cell, Raster};
    use crate::model::config::Body;
    use crate::model::gradual::{StepBudget, at_once};

    #[test]
    fn checks_end_after_some_attempts_until_floor_is_gained() {
        let body = Body {
            radius_m: 0.175,
            track_m: 0.23,
            swath_m: 0.3,
        };
        let mut squeeze = Squeeze::default();
        assert_eq!(squeeze.radius_m(body), None);
        for _ in 0..SQUEEZE.tries_max {
            assert!(squeeze.begin(&CoveragePlan::default()));
            assert!(
                squeeze
                    .radius_m(body)
                    .is_some_and(|radius_m| radius_m < body.radius_m)
            );
            assert_eq!(squeeze.end(), Some(CoveragePlan::default()));
            assert_eq!(squeeze.end(), None, "a check ends once");
        }
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.reset_attempts();
        assert!(squeeze.begin(&CoveragePlan::default()));
        squeeze.end_checks();
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.record(2.0);
        squeeze.allow_one(2.5);
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.allow_one(1.5);
        assert!(squeeze.begin(&CoveragePlan::default()));
        assert!(!squeeze.begin(&CoveragePlan::default()));
    }

    #[test]
    fn cells_near_a_cell_at_the_window_edge_are_inside_the_window() {
        let mut cells = Raster::filled(Cell { x: -5, y: 2 }, 10, 10, false);
        *cells.get_mut(Cell { x: -5, y: 2 }).unwrap() = true;
        let near = at_once(near(&cells, &mut StepBudget::unlimited()));
        let is_near = |x, y| near.get(Cell { x, y }).copied();
        assert_eq!((is_near(-2, 5), is_near(-1, 2)), (Some(true), Some(false)));
        assert_eq!(near.values().iter().filter(|cell| **cell).count(), 16);
    }
}
