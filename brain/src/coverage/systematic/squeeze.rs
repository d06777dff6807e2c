//! Through a gap that the map shows a little too narrow: a touch at a door post, or a wall drawn a cell too thick, shuts off all that
//! lies behind.
//!
//! Where a robot has nothing left to plan, it looks once more at what a body without any gap to what is known would reach. If
//! that is much more floor, it tries the way there, and what it touches tells the rest.

use crate::coverage::plan::CoveragePlan;
use crate::mapping::{Cell, Raster};
use crate::model::config::Body;
use crate::model::gradual::StepBudget;

/// Floor that must come into reach, square metres.
pub(super) const WORTH_M2: f64 = 0.4;
/// Floor is hoped for so far beyond what is known, metres.
pub(super) const BEYOND_M: f64 = 1.2;
/// The body is planned for with so much less at its rim, metres: half a cell, since cells count as a whole.
const LESS_M: f64 = 0.0125;
/// Ways that are tried until some floor is won.
const TRIES_MAX: u32 = 3;
/// Floor nearer than this to what was in reach is no new floor, cells: a slimmer body gets nearer to all walls.
const NEAR: i32 = 3;
/// Work of a cell that is copied with those around it.
const GROW_WORK: usize = 20;

/// Looks for a way through a gap, and how often.
#[derive(Debug, Default)]
pub(super) struct Squeeze {
    /// The plan that left nothing, while a look goes on.
    ended: Option<CoveragePlan>,
    tries: u32,
    /// Floor that the newest look showed, square metres.
    seen_m2: Option<f64>,
}

impl Squeeze {
    /// Begins a look after a plan that left nothing. `false` when there were enough.
    pub(super) fn begin(&mut self, ended: &CoveragePlan) -> bool {
        if self.tries >= TRIES_MAX {
            return false;
        }
        self.tries += 1;
        self.ended = Some(ended.clone());
        true
    }

    /// The radius to plan for while a look goes on.
    pub(super) fn radius_m(&self, body: Body) -> Option<f64> {
        self.ended.as_ref().map(|_| body.radius_m - LESS_M)
    }

    /// Ends a look: the plan that left nothing.
    pub(super) fn end(&mut self) -> Option<CoveragePlan> {
        self.ended.take()
    }

    /// Notes how much floor a look showed, square metres.
    pub(super) fn saw(&mut self, floor_m2: f64) {
        self.seen_m2 = Some(floor_m2);
    }

    /// One more look, if the newest one showed so much floor: the robot has moved, and who stood in the way may have left meanwhile.
    pub(super) fn allow_one(&mut self, worth_m2: f64) {
        if self.seen_m2.is_none_or(|seen_m2| seen_m2 >= worth_m2) {
            self.tries = self.tries.min(TRIES_MAX - 1);
        }
    }

    /// No more looks until [`Self::start_anew`].
    pub(super) fn give_up(&mut self) {
        self.tries = TRIES_MAX;
    }

    /// There is new floor, and there may be new gaps.
    pub(super) fn start_anew(&mut self) {
        self.tries = 0;
    }
}

/// What lies on or near these cells.
pub(super) async fn near(cells: &Raster<bool>, budget: &mut StepBudget) -> Raster<bool> {
    let mut near = cells.clone();
    let (width, origin) = (cells.width().max(1), cells.origin());
    for (row, line) in cells.values().chunks(width).enumerate() {
        for (column, _) in line.iter().enumerate().filter(|(_, cell)| **cell) {
            let (x, y) = (origin.x + column as i32, origin.y + row as i32);
            let around = (-NEAR..=NEAR).flat_map(|rise| (-NEAR..=NEAR).map(move |shift| (shift, rise)));
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
    use super::{Squeeze, TRIES_MAX, near};
    use crate::coverage::plan::CoveragePlan;
    use crate::mapping::{Cell, Raster};
    use crate::model::config::Body;
    use crate::model::gradual::{StepBudget, at_once};

    #[test]
    fn looks_end_after_some_tries_until_floor_is_won() {
        let body = Body {
            radius_m: 0.175,
            track_m: 0.23,
            swath_m: 0.3,
        };
        let mut squeeze = Squeeze::default();
        assert_eq!(squeeze.radius_m(body), None);
        for _ in 0..TRIES_MAX {
            assert!(squeeze.begin(&CoveragePlan::default()));
            assert!(
                squeeze
                    .radius_m(body)
                    .is_some_and(|radius_m| radius_m < body.radius_m)
            );
            assert_eq!(squeeze.end(), Some(CoveragePlan::default()));
            assert_eq!(squeeze.end(), None, "a look is over once");
        }
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.start_anew();
        assert!(squeeze.begin(&CoveragePlan::default()));
        squeeze.give_up();
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.saw(2.0);
        squeeze.allow_one(2.5);
        assert!(!squeeze.begin(&CoveragePlan::default()));
        squeeze.allow_one(1.5);
        assert!(squeeze.begin(&CoveragePlan::default()));
        assert!(!squeeze.begin(&CoveragePlan::default()));
    }

    #[test]
    fn cells_at_the_edge_of_the_window_are_near_what_is_inside() {
        let mut cells = Raster::filled(Cell { x: -5, y: 2 }, 10, 10, false);
        *cells.get_mut(Cell { x: -5, y: 2 }).unwrap() = true;
        let near = at_once(near(&cells, &mut StepBudget::unlimited()));
        let is_near = |x, y| near.get(Cell { x, y }).copied();
        assert_eq!((is_near(-2, 5), is_near(-1, 2)), (Some(true), Some(false)));
        assert_eq!(near.values().iter().filter(|cell| **cell).count(), 16);
    }
}
