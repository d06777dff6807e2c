//! What a run in a known home leaves to the next one.
//!
//! *Settled*: drawn by a robot that was sure of its place, and stayed sure for a while after. A robot that drifts notices it
//! late, so newer sightings wait. When it doubts its place they are dropped, and the map is again as it was before them.

use std::sync::Arc;

use super::HomeMap;
use crate::mapping::inverse_sensor_model::InverseSensorModel;
use crate::mapping::kept_home::KeptHome;
use crate::mapping::learning::{LEARNING, merged};
use crate::mapping::occupancy_grid::OccupancyGrid;
use crate::mapping::sighting::Sighting;
use crate::model::gradual::StepBudget;

/// Most sightings that settle in a step. Less than one a step is drawn.
const SETTLED_A_STEP: usize = 4;
/// Work of drawing a sighting: some two hundred cells.
const SIGHTING_WORK: usize = 1_000;

/// How sure the robot is of its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlaceTrust {
    /// The home explains what the sensors show.
    Sure,
    /// It is lost, was just found, or the home explains too little.
    Doubtful,
}

/// A home that earlier runs have left.
#[derive(Debug)]
pub(in crate::mapping) struct KnownHome {
    pub(in crate::mapping) kept: Arc<KeptHome>,
    /// With what has settled of this run.
    pub(in crate::mapping) settled: OccupancyGrid,
    /// Sightings that have settled, or were dropped.
    settled_sightings: usize,
    trust: PlaceTrust,
    /// Of the last doubt.
    doubted_us: u64,
}

impl KnownHome {
    pub(super) fn begun(kept: KeptHome) -> Self {
        Self {
            settled: kept.grid().clone(),
            kept: Arc::new(kept),
            settled_sightings: 0,
            trust: PlaceTrust::Sure,
            doubted_us: 0,
        }
    }
}

impl HomeMap {
    /// Notes how sure the robot is of its place now.
    pub(in crate::mapping) fn note_trust(&mut self, trust: PlaceTrust, time_us: u64) {
        let Some(known) = &mut self.known else { return };
        let before = core::mem::replace(&mut known.trust, trust);
        match (before, trust) {
            (PlaceTrust::Sure, PlaceTrust::Doubtful) => {
                known.settled_sightings = self.sightings.len();
                self.grid = known.settled.clone();
                self.grid.mark_all_dirty();
                self.begin_refresh();
            }
            (_, PlaceTrust::Doubtful) => known.settled_sightings = self.sightings.len(),
            (_, PlaceTrust::Sure) => self.settle_until(time_us.saturating_sub(LEARNING.settling_us)),
        }
        if trust == PlaceTrust::Doubtful
            && let Some(known) = &mut self.known
        {
            known.doubted_us = time_us;
        }
    }

    /// Settles everything that waits.
    pub(in crate::mapping) fn settle_all(&mut self) {
        if let Some(known) = &mut self.known {
            let waiting = self.sightings.get(known.settled_sightings..).unwrap_or_default();
            for sighting in waiting {
                self.sensor_model
                    .draw(sighting, Some(&known.kept), &mut known.settled);
            }
            known.settled_sightings = 0;
        }
    }

    fn settle_until(&mut self, time_us: u64) {
        let Some(known) = &mut self.known else { return };
        let waiting = self.sightings.get(known.settled_sightings..).unwrap_or_default();
        let old = |sighting: &&Sighting| sighting.time_us <= time_us;
        for sighting in waiting.iter().take_while(old).take(SETTLED_A_STEP) {
            self.sensor_model
                .draw(sighting, Some(&known.kept), &mut known.settled);
            known.settled_sightings += 1;
        }
    }

    /// A copy of the run up to now, for saving.
    pub(in crate::mapping) fn run_so_far(&self) -> Option<RunSoFar> {
        let known = self.known.as_ref()?;
        let waiting = self.sightings.get(known.settled_sightings..).unwrap_or_default();
        Some(RunSoFar {
            sensor_model: self.sensor_model,
            kept: known.kept.clone(),
            settled: known.settled.clone(),
            waiting: waiting.to_vec(),
        })
    }
}

/// A copy of a run in a known home. It shares its cells with the map until the map writes to them.
pub(in crate::mapping) struct RunSoFar {
    sensor_model: InverseSensorModel,
    kept: Arc<KeptHome>,
    settled: OccupancyGrid,
    /// Of a robot that is sure of its place: what has not settled yet.
    waiting: Vec<Sighting>,
}

impl RunSoFar {
    /// The home as this run leaves it.
    pub(in crate::mapping) async fn left_home(mut self, budget: &mut StepBudget) -> OccupancyGrid {
        for sighting in &self.waiting {
            self.sensor_model
                .draw(sighting, Some(&self.kept), &mut self.settled);
            budget.spend(SIGHTING_WORK).await;
        }
        merged(&self.kept, &self.settled, budget).await
    }
}
