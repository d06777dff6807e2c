//! The guard against floor that is cut off: whether a robot on its dock still reaches the floor over which it drove in earlier runs.
//!
//! A few wrong touches in a doorway cut off a room, and nothing disproves them, because no plan leads there any more. So when much
//! less than that floor is connected, touches on it expire before the run begins. What is cut off even so stands behind something that
//! infrared sees: that floor counts as not swept, and a person is told.

use super::HomeMap;
use crate::mapping::derived::Derived;
use crate::mapping::occupancy_grid::{Evidence, Flag, is_touched_only};
use crate::mapping::reach::{connected, passable};
use crate::mapping::{Cell, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// When floor counts as cut off.
struct CutOffParameters {
    /// Less than this share of the floor is connected. Chosen, not measured: a room is more than a tenth of most homes.
    connected_below: f64,
}

const CUT_OFF: CutOffParameters = CutOffParameters { connected_below: 0.9 };

/// Work of looking at a cell.
const CELL_WORK: usize = 6;

impl HomeMap {
    /// Expires touches that cut off floor from a robot at `dock`. Returns the share of the floor driven before that is connected then.
    pub(super) async fn reconnect(&mut self, dock: Point2, budget: &mut StepBudget) -> f64 {
        if self.driven_share(dock, budget).await >= CUT_OFF.connected_below {
            return 1.0;
        }
        let touched = self.grid.gathered();
        let touched =
            touched.filter(|(cell, evidence)| is_touched_only(*evidence) && self.is_driven_near(*cell));
        let touched: Vec<Cell> = touched.map(|(cell, _)| cell).collect();
        for cell in touched {
            self.grid.change(cell, Evidence::expire_touch);
            budget.spend(CELL_WORK).await;
        }
        self.derived = Derived::compute(&mut self.grid, budget).await;
        let share = self.driven_share(dock, budget).await;
        if share >= CUT_OFF.connected_below {
            1.0
        } else {
            share
        }
    }

    /// Share of the floor driven in earlier runs that a robot at `dock` reaches, where nothing is forbidden: people know what they
    /// cut off by that.
    async fn driven_share(&mut self, dock: Point2, budget: &mut StepBudget) -> f64 {
        let without_no_go = self.knowledge_without_no_go();
        let knowledge = without_no_go.as_ref().unwrap_or_else(|| self.knowledge());
        let open: Raster<bool> = passable(knowledge, self.sensor_model.body.radius_m, budget).await;
        let reached = connected(&open, dock, budget).await;
        let (mut reached_cells, mut cells) = (0.0, 0.0);
        for (index, is_open) in open.values().iter().enumerate() {
            if *is_open && self.grid.at(open.cell(index)).has(Flag::Body) {
                cells += 1.0;
                if reached.values().get(index) == Some(&true) {
                    reached_cells += 1.0;
                }
            }
            budget.spend(1).await;
        }
        if cells > 0.0 { reached_cells / cells } else { 1.0 }
    }

    /// Whether the body was in a cell or beside it: it is drawn a little smaller than it is.
    fn is_driven_near(&self, cell: Cell) -> bool {
        let around = (-2..=2).flat_map(|rise| (-2..=2).map(move |shift| (shift, rise)));
        around
            .map(|(shift, rise)| Cell {
                x: cell.x.saturating_add(shift),
                y: cell.y.saturating_add(rise),
            })
            .any(|beside| self.grid.at(beside).has(Flag::Body))
    }
}

#[cfg(test)]
mod tests {
    use crate::mapping::derived::Derived;
    use crate::mapping::home::HomeMap;
    use crate::mapping::occupancy_grid::{Evidence, Flag};
    use crate::mapping::{Cell, CellKnowledge};
    use crate::model::config::BrainConfig;
    use crate::model::geometry::Point2;
    use crate::model::gradual::{StepBudget, at_once};

    const DOCK: Point2 = Point2 { x_m: 0.5, y_m: 1.0 };
    /// A cell in the middle of the door.
    const DOOR: Cell = Cell { x: 80, y: 40 };

    /// Two rooms of 2 by 2 metres side by side, all of it driven, with a door of 80 cm and this evidence across the door.
    fn home(in_door: impl Fn(&mut Evidence)) -> HomeMap {
        let config = BrainConfig::of_tests();
        let mut home = HomeMap::new(config.body, config.sensors);
        for y in -1..=80 {
            for x in -1..=161 {
                let is_wall =
                    !(0..80).contains(&y) || !(0..161).contains(&x) || (x == 80 && !(24..56).contains(&y));
                home.grid.change(Cell { x, y }, |evidence| {
                    evidence.occupancy = if is_wall { 60 } else { -60 };
                    if !is_wall {
                        evidence.set(Flag::Body);
                    }
                    if x == 80 && (24..56).contains(&y) {
                        in_door(evidence);
                    }
                });
            }
        }
        home.derived = at_once(Derived::compute(&mut home.grid, &mut StepBudget::unlimited()));
        home
    }

    fn share(home: &mut HomeMap) -> f64 {
        at_once(home.reconnect(DOCK, &mut StepBudget::unlimited()))
    }

    #[test]
    fn touches_across_a_door_expire_and_nothing_is_cut_off() {
        let mut home = home(|evidence| evidence.contact = 4);
        assert_eq!(home.knowledge().get(DOOR), Some(&CellKnowledge::Occupied));
        assert_eq!(share(&mut home), 1.0);
        assert_eq!(home.knowledge().get(DOOR), Some(&CellKnowledge::Free));
    }

    #[test]
    fn a_door_that_infrared_sees_shut_cuts_off_what_is_behind_it() {
        let mut home = home(|evidence| evidence.occupancy = 60);
        let share = share(&mut home);
        assert!((0.4..0.6).contains(&share), "{share}");
        assert_eq!(home.knowledge().get(DOOR), Some(&CellKnowledge::Occupied));
    }

    #[test]
    fn touches_in_a_home_that_is_whole_stay() {
        let mut home = home(|_| {});
        let leg = Cell { x: 30, y: 60 };
        home.grid.change(leg, |evidence| evidence.contact = 4);
        home.derived.refresh(&mut home.grid);
        assert_eq!(share(&mut home), 1.0);
        assert_eq!(home.knowledge().get(leg), Some(&CellKnowledge::Occupied));
    }
}
