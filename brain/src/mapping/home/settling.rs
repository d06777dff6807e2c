//! What a run in a known home leaves to the next one.
//!
//! A robot that drifts notices it late. So the grid is remembered now and then while the robot is sure of its place. When it doubts its
//! place, what it has drawn in the minute before is dropped, and so is what it draws until it is sure again.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Access, HomeMap};
use crate::mapping::Cell;
use crate::mapping::kept_home::KeptHome;
use crate::mapping::learning::{LEARNING, merged};
use crate::mapping::occupancy_grid::{Flag, OccupancyGrid};
use crate::model::gradual::StepBudget;

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
    /// The grid at some moments, the oldest first; never empty. They share their cells with the grid until that changes them.
    remembered: VecDeque<RememberedGrid>,
    trust: PlaceTrust,
}

/// The grid of a robot that was sure of its place.
#[derive(Clone, Debug)]
struct RememberedGrid {
    time_us: u64,
    grid: OccupancyGrid,
}

impl KnownHome {
    pub(super) fn begun(kept: KeptHome) -> Self {
        let begun = RememberedGrid {
            time_us: 0,
            grid: kept.grid().clone(),
        };
        Self {
            kept: Arc::new(kept),
            remembered: VecDeque::from([begun]),
            trust: PlaceTrust::Sure,
        }
    }

    /// Sets or clears a flag wherever the grid is remembered.
    pub(super) fn flag(&mut self, cell: Cell, flag: Flag, access: Access) {
        for remembered in &mut self.remembered {
            remembered.grid.change(cell, |evidence| match access {
                Access::Forbidden => evidence.set(flag),
                Access::Allowed => evidence.clear(flag),
            });
        }
    }

    /// Remembers the grid once in a while, and forgets what is too old to be returned to.
    fn remember(&mut self, grid: &OccupancyGrid, time_us: u64) {
        let newest_us = self.remembered.back().map_or(0, |newest| newest.time_us);
        if time_us < newest_us.saturating_add(LEARNING.remembered_us) {
            return;
        }
        let settled_us = time_us.saturating_sub(LEARNING.settling_us);
        while self
            .remembered
            .get(1)
            .is_some_and(|second| second.time_us <= settled_us)
        {
            self.remembered.pop_front();
        }
        self.remembered.push_back(RememberedGrid {
            time_us,
            grid: grid.clone(),
        });
    }

    /// The grid as it was at this time; that is all that is remembered from now on.
    fn return_to(&mut self, settled_us: u64) -> Option<OccupancyGrid> {
        while self.remembered.len() > 1
            && self
                .remembered
                .back()
                .is_some_and(|newest| newest.time_us > settled_us)
        {
            self.remembered.pop_back();
        }
        let settled = self.remembered.pop_back()?;
        let grid = settled.grid.clone();
        self.remembered.clear();
        self.remembered.push_back(settled);
        Some(grid)
    }
}

impl HomeMap {
    /// Notes how sure the robot is of its place now.
    pub(in crate::mapping) fn note_trust(&mut self, trust: PlaceTrust, time_us: u64) {
        let Some(known) = &mut self.known else { return };
        let returned = match (core::mem::replace(&mut known.trust, trust), trust) {
            (PlaceTrust::Sure, PlaceTrust::Sure) => {
                known.remember(&self.grid, time_us);
                None
            }
            (PlaceTrust::Sure, PlaceTrust::Doubtful) => {
                known.return_to(time_us.saturating_sub(LEARNING.settling_us))
            }
            (PlaceTrust::Doubtful, PlaceTrust::Doubtful) => None,
            // What is remembered is from before the doubt.
            (PlaceTrust::Doubtful, PlaceTrust::Sure) => known.return_to(time_us),
        };
        if let Some(grid) = returned {
            self.grid = grid;
            self.grid.mark_all_dirty();
            self.begin_refresh();
        }
    }

    /// A copy of the run up to now, for saving.
    pub(in crate::mapping) fn run_so_far(&self) -> Option<RunSoFar> {
        let known = self.known.as_ref()?;
        let remembered = known.remembered.back();
        let doubted = remembered.filter(|_| known.trust == PlaceTrust::Doubtful);
        Some(RunSoFar {
            kept: known.kept.clone(),
            grid: doubted.map_or(&self.grid, |before| &before.grid).clone(),
        })
    }
}

/// A copy of a run in a known home. It shares its cells with the map until the map writes to them.
pub(in crate::mapping) struct RunSoFar {
    kept: Arc<KeptHome>,
    grid: OccupancyGrid,
}

impl RunSoFar {
    /// The home as this run leaves it.
    pub(in crate::mapping) async fn left_home(self, budget: &mut StepBudget) -> OccupancyGrid {
        merged(&self.kept, &self.grid, budget).await
    }
}

#[cfg(test)]
mod tests {
    use super::PlaceTrust;
    use crate::mapping::home::HomeMap;
    use crate::mapping::kept_home::KeptHome;
    use crate::mapping::occupancy_grid::Flag;
    use crate::mapping::{Cell, CellKnowledge};
    use crate::model::config::BrainConfig;
    use crate::model::gradual::{StepBudget, at_once};

    const SECOND_US: u64 = 1_000_000;

    /// A home of which nothing is known but that it is known.
    fn home() -> HomeMap {
        let config = BrainConfig::of_tests();
        let mut home = HomeMap::new(config.body, config.sensors);
        let budget = &mut StepBudget::unlimited();
        let kept = at_once(KeptHome::of(&home.grid, &home.derived.knowledge, budget));
        home.known = Some(Box::new(super::KnownHome::begun(kept)));
        home
    }

    /// The robot is sure for so long, and marks a cell of its own each second.
    fn drive(home: &mut HomeMap, seconds: core::ops::Range<i32>, trust: PlaceTrust) {
        for second in seconds {
            home.grid
                .change(Cell { x: second, y: 0 }, |evidence| evidence.set(Flag::Body));
            home.note_trust(trust, second as u64 * SECOND_US);
        }
    }

    /// Seconds of which the grid knows.
    fn known(home: &HomeMap) -> Vec<i32> {
        let is_known =
            |second: &i32| home.grid.at(Cell { x: *second, y: 0 }).knowledge() == CellKnowledge::Free;
        (0..1_000).filter(is_known).collect()
    }

    fn left(home: &HomeMap) -> usize {
        let run = home.run_so_far().expect("the home is known");
        at_once(run.left_home(&mut StepBudget::unlimited()))
            .gathered()
            .count()
    }

    #[test]
    fn a_doubt_takes_back_the_minute_before_it_and_at_most_half_a_minute_more() {
        let mut home = home();
        drive(&mut home, 0..300, PlaceTrust::Sure);
        assert_eq!((known(&home).len(), left(&home)), (300, 300));
        drive(&mut home, 300..301, PlaceTrust::Doubtful);
        let kept = known(&home).len();
        assert!((210..=241).contains(&kept), "{kept}");
        assert_eq!(left(&home), kept);
    }

    #[test]
    fn what_is_drawn_in_doubt_is_not_left_and_goes_when_the_robot_is_sure_again() {
        let mut home = home();
        drive(&mut home, 0..300, PlaceTrust::Sure);
        drive(&mut home, 300..400, PlaceTrust::Doubtful);
        let settled = left(&home);
        assert!(settled <= 241 && known(&home).len() > settled, "{settled}");
        drive(&mut home, 400..401, PlaceTrust::Sure);
        assert_eq!(known(&home).len(), settled);
        drive(&mut home, 401..500, PlaceTrust::Sure);
        assert_eq!((known(&home).len(), left(&home)), (settled + 99, settled + 99));
    }
}
