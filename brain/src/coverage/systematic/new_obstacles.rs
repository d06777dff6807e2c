//! Obstacles that appeared since the job began: a person in a door, a bag, a chair that was moved.
//!
//! In a known home everything was reachable when the job began. Where the robot has nothing left to plan, it checks once
//! more what would be reachable without these obstacles, and drives there: people who stood in a door have mostly left by
//! then.

use crate::mapping::{CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Cells read for a unit of work.
const CELLS_A_WORK: usize = 4;

/// A copy of the map in which cells that were free when the job `began` and are occupied now are free again. Cliffs and
/// no-go zones stay.
pub(super) async fn without_new_obstacles(
    mut knowledge: Raster<CellKnowledge>,
    began: &Raster<CellKnowledge>,
    budget: &mut StepBudget,
) -> Raster<CellKnowledge> {
    let width = knowledge.width().max(1);
    for row in 0..knowledge.height() {
        for index in row * width..(row + 1) * width {
            let cell = knowledge.cell(index);
            if let Some(kind) = knowledge.values_mut().get_mut(index)
                && *kind == CellKnowledge::Occupied
                && began.get(cell) == Some(&CellKnowledge::Free)
            {
                *kind = CellKnowledge::Free;
            }
        }
        budget.spend(width / CELLS_A_WORK + 1).await;
    }
    knowledge
}

#[cfg(test)]
mod tests {
    use super::without_new_obstacles;
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::gradual::{StepBudget, at_once};

    #[test]
    fn new_obstacles_are_removed_and_walls_cliffs_and_no_go_zones_stay() {
        use CellKnowledge::{Cliff, Free, NoGo, Occupied, Unknown};
        let raster = |origin, kinds: &[CellKnowledge]| {
            let mut raster = Raster::filled(origin, kinds.len(), 1, Unknown);
            raster.values_mut().copy_from_slice(kinds);
            raster
        };
        let began = raster(Cell { x: 0, y: 0 }, &[Free, Free, Free, Free, Occupied, Unknown]);
        let now = raster(
            Cell { x: -1, y: 0 },
            &[Occupied, Occupied, Free, Cliff, NoGo, Occupied, Occupied],
        );
        let without = at_once(without_new_obstacles(now, &began, &mut StepBudget::unlimited()));
        assert_eq!(
            without.values(),
            [Occupied, Free, Free, Cliff, NoGo, Occupied, Occupied],
            "beyond the map of then nothing was free"
        );
    }
}
