//! What came to stand in the way since the job began: a person in a door, a bag, a chair that was moved.
//!
//! A home that is known was whole when the job began. Where a robot has nothing left to plan, it looks once more at what would be
//! in reach if that were gone again, and tries the way there: who stood in a door has mostly left by then.

use crate::mapping::{CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Cells that are looked at for a unit of work.
const CELLS_A_WORK: usize = 4;

/// Knowledge in which what was free floor when the job `began`, and is occupied now, is free again. Edges, and what people do not
/// allow, stay as they are.
pub(super) async fn without_what_came(
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
    use super::without_what_came;
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::gradual::{StepBudget, at_once};

    #[test]
    fn what_came_is_gone_again_and_walls_edges_and_what_is_forbidden_stay() {
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
        let without = at_once(without_what_came(now, &began, &mut StepBudget::unlimited()));
        assert_eq!(
            without.values(),
            [Occupied, Free, Free, Cliff, NoGo, Occupied, Occupied],
            "beyond the map of then nothing was free"
        );
    }
}
