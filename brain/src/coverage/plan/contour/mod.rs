//! Rings along the border of the free space, from the wall inwards or from the middle outwards.
//!
//! Terms. *Depth*: distance of a cell from the border of the ringed floor. *Ring*: a closed chain of cells of one depth;
//! those of the next *level* lie one lane spacing deeper. Furniture has a border, too, so rings lie around it. *Section*: a
//! part of a ring that is worth driving, or the whole ring. Where the sides of a ring come so close that one sweeps the
//! floor of both, only one is driven.
//!
//! Rings leave floor open where they turn and in the middle of the innermost one. Lanes sweep that.

mod depth;
mod order;
mod ring_sections;
mod rings;
mod shape;
#[cfg(test)]
mod tests;

use super::sweep_pattern::SweepPattern;
use crate::coverage::plan::parameters::RINGS;
use crate::mapping::Cell;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::ConfigurationSpace;
use crate::navigation::router::Router;
pub(super) use order::RingStart;
use order::{RingPath, RingTour};
use ring_sections::{RingSection, Sweeper};

/// Work to find the pattern of a cell.
const ASK_WORK: usize = 1;

/// The floor that is swept in rings.
pub(super) struct RingFloor {
    /// By the indices of the configuration space.
    cells: Vec<bool>,
    is_outwards: bool,
    /// Cells of it before any of it was swept.
    floor: usize,
}

impl RingFloor {
    /// The floor that is swept in rings, before already swept floor is closed; `None` if there is none.
    pub(super) async fn of(
        space: &ConfigurationSpace,
        pattern: impl Fn(Cell) -> Option<SweepPattern>,
        budget: &mut StepBudget,
    ) -> Option<Self> {
        let mut floor = Self {
            cells: vec![false; space.free.len()],
            is_outwards: false,
            floor: 0,
        };
        for row in 0..space.height {
            for index in row * space.width..(row + 1) * space.width {
                let pattern = pattern(space.cell(index)).filter(|pattern| *pattern != SweepPattern::Lines);
                if space.open[index] && pattern.is_some() {
                    floor.cells[index] = true;
                    floor.floor += 1;
                    floor.is_outwards |= pattern == Some(SweepPattern::Outwards);
                }
            }
            budget.spend(ASK_WORK * space.width).await;
        }
        (floor.floor > 0).then_some(floor)
    }

    /// Whether the job has hardly begun with it.
    fn is_fresh(&self, open: &[bool]) -> bool {
        let left = self
            .cells
            .iter()
            .zip(open)
            .filter(|(ringed, open)| **ringed && **open);
        left.count() as f64 >= (1.0 - RINGS.begun_share) * self.floor as f64
    }
}

/// The path along all rings that are worth driving, from `start`.
pub(super) async fn ring_path(
    space: &ConfigurationSpace,
    floor: &RingFloor,
    start: RingStart<'_>,
    budget: &mut StepBudget,
) -> RingPath {
    let depths = depth::depths(space, &floor.cells, budget).await;
    let rings = rings::rings(space, &depths, budget).await;
    let sweeper = Sweeper::new(space);
    let mut sections: Vec<RingSection> = Vec::new();
    for ring in rings {
        sections.extend(sweeper.sections(ring, budget).await);
    }
    let is_fresh = floor.is_fresh(&space.open);
    let router = Router::new(space, budget).await;
    let mut tour = RingTour::new(&router, sweeper, start);
    sections.into_iter().for_each(|section| tour.add(section));
    if is_fresh {
        tour.begin(floor.is_outwards, budget).await;
    }
    tour.go_through(budget).await;
    tour.path()
}
