//! Rings along the border of the ground, from the wall inwards or from the middle outwards.
//!
//! Terms. *Depth*: how far a cell lies from the border of the ground that is ringed. *Ring*: a closed row of cells of one
//! depth; those of the next *level* lie a lane's spacing deeper. Furniture is a border, too, so that rings lie around it.
//! *Run*: a part of a ring that is worth driving, or all of it. Where the sides of a ring come so near to each other that one
//! of them sweeps the floor of both, only one is driven.
//!
//! Rings leave floor open where they turn and in the middle between the last of them: that is for lanes.

mod depth;
mod order;
mod rings;
mod runs;
mod shape;
#[cfg(test)]
mod tests;

use super::course::Course;
use super::settings::Departure;
use crate::mapping::Cell;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::Ground;
use crate::navigation::router::Router;
use order::{Drive, RingWay};
use runs::{Run, Sweeper};

/// A job that has swept less than this share of the floor to be ringed begins at the wall, or in the middle; a later plan
/// goes on where the robot is.
const BEGUN_SHARE: f64 = 0.05;
/// Work of asking how a cell is to be swept.
const ASK_WORK: usize = 1;

/// The floor that is swept in rings.
pub(super) struct RingFloor {
    /// By the indices of the ground.
    cells: Vec<bool>,
    is_outwards: bool,
    /// How much of it there was before any of it was swept.
    floor: usize,
}

impl RingFloor {
    /// The part of the ground that is to be swept in rings, before what is swept already is closed; `None` if there is none.
    pub(super) async fn of(
        ground: &Ground,
        course: impl Fn(Cell) -> Option<Course>,
        budget: &mut StepBudget,
    ) -> Option<Self> {
        let mut floor = Self {
            cells: vec![false; ground.free.len()],
            is_outwards: false,
            floor: 0,
        };
        for row in 0..ground.height {
            for index in row * ground.width..(row + 1) * ground.width {
                let course = course(ground.cell(index)).filter(|course| *course != Course::Lines);
                if ground.open[index] && course.is_some() {
                    floor.cells[index] = true;
                    floor.floor += 1;
                    floor.is_outwards |= course == Some(Course::Outwards);
                }
            }
            budget.spend(ASK_WORK * ground.width).await;
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
        left.count() as f64 >= (1.0 - BEGUN_SHARE) * self.floor as f64
    }
}

/// The way along all rings that are worth it, from the cell `origin`.
pub(super) async fn ring_way(
    ground: &Ground,
    floor: &RingFloor,
    (departure, origin): (&Departure, usize),
    budget: &mut StepBudget,
) -> RingWay {
    let depths = depth::depths(ground, &floor.cells, budget).await;
    let rings = rings::rings(ground, &depths, budget).await;
    let sweeper = Sweeper::new(ground);
    let mut runs: Vec<Run> = Vec::new();
    for ring in rings {
        runs.extend(sweeper.runs(ring, budget).await);
    }
    let is_fresh = floor.is_fresh(&ground.open);
    let router = Router::new(ground, budget).await;
    let mut drive = Drive::new(&router, (sweeper, runs), (departure, origin));
    if is_fresh {
        drive.begin(floor.is_outwards, budget).await;
    }
    drive.go_through(budget).await;
    drive.way()
}
