//! The floor of a known home: what the swath reaches from where the map has room for the body, and where the body was in any run.
//!
//! A plan keeps a gap to obstacles, and a map has obstacles that do not exist. Of the floor of a plan alone a job would sweep
//! nearly all, whatever the map has lost. Floor that an earlier run drove over is floor, and counts as long as no obstacle is seen there.

use core::task::Poll;

use crate::coverage::plan::{Departure, floor_in_reach};
use crate::coverage::target_floor::TargetFloor;
use crate::mapping::{CELL_M, CellKnowledge, Map, Raster};
use crate::model::gradual::{Gradual, StepBudget};
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::{Inflation, reachable};

/// The floor, once it is found.
#[derive(Debug)]
pub(super) enum KnownFloor {
    /// In progress.
    Finding(Gradual<Raster<bool>>),
    /// What the swath reaches.
    Found(Raster<bool>),
}

impl KnownFloor {
    /// Begins to find the floor that a body of this radius can sweep from its departure.
    pub(super) fn begin(knowledge: Raster<CellKnowledge>, radius_m: f64, departure: Departure) -> Self {
        Self::Finding(Gradual::new(async move {
            let budget = &mut StepBudget::limited();
            let inflation = Inflation {
                radius_m,
                blocked: &[],
            };
            let places = reachable(&knowledge, &LaneFrame::OF_MAP, inflation, budget).await;
            floor_in_reach(&places, &departure, budget).await
        }))
    }

    /// Does the next step.
    pub(super) fn go_on(&mut self) {
        if let Self::Finding(rest) = self
            && let Poll::Ready(floor) = rest.go_on()
        {
            *self = Self::Found(floor);
        }
    }

    /// Counts the target floor, and what of it was passed; `None` while the floor is being found.
    pub(super) fn count(
        &self,
        passed: &Raster<bool>,
        target: &TargetFloor,
        map: &Map,
    ) -> Option<CountedFloor> {
        let Self::Found(floor) = self else { return None };
        let knowledge = map.knowledge();
        let (mut cells, mut passed_cells) = (0.0, 0.0);
        for (index, kind) in knowledge.values().iter().enumerate() {
            let cell = knowledge.cell(index);
            let is_passed = passed.get(cell) == Some(&true);
            let is_floor = || floor.get(cell) == Some(&true) || map.was_driven(cell);
            if *kind == CellKnowledge::Free && is_floor() && target.pattern_at(cell).is_some() {
                cells += 1.0;
                passed_cells += if is_passed { 1.0 } else { 0.0 };
            }
        }
        Some(CountedFloor {
            floor_m2: cells * CELL_M * CELL_M,
            passed_m2: passed_cells * CELL_M * CELL_M,
        })
    }
}

/// Square metres of a known home.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CountedFloor {
    pub(super) floor_m2: f64,
    pub(super) passed_m2: f64,
}
