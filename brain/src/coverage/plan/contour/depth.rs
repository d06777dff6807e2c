//! How deep within the floor that is ringed each cell lies.

use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::Ground;

/// Depths are whole fifths of a cell: with steps of 5, 7 and 11 they are right to 2 %.
pub(super) const CELL: i32 = 5;
const DIAGONAL: i32 = 7;
const KNIGHT: i32 = 11;
/// Work of a cell in one sweep.
const VISIT_WORK: usize = 8;

/// The depth of each cell. Cells beside what the body cannot take are one cell deep; where floor of another kind begins the
/// first ring keeps off by what a lane sweeps to its side.
pub(super) async fn depths(ground: &Ground, ringed: &[bool], budget: &mut StepBudget) -> Vec<i32> {
    let beyond = -CELL * ground.reach as i32;
    let mut depths: Vec<i32> = ground
        .free
        .iter()
        .zip(ringed)
        .map(|(free, ringed)| match (free, ringed) {
            (true, true) => i32::MAX / 2,
            (true, false) => beyond,
            (false, _) => 0,
        })
        .collect();
    let width = ground.width;
    let before = [
        (1, CELL),
        (width, CELL),
        (width + 1, DIAGONAL),
        (width - 1, DIAGONAL),
        (width + 2, KNIGHT),
        (width - 2, KNIGHT),
        (2 * width + 1, KNIGHT),
        (2 * width - 1, KNIGHT),
    ];
    // The margin around the ground is wider than the longest step.
    let border = 2 * width + 2;
    let inner = border..depths.len().saturating_sub(border);
    for index in inner.clone() {
        if ground.free[index] {
            let through = before.map(|(back, step)| depths[index - back] + step);
            depths[index] = through.into_iter().fold(depths[index], i32::min);
        }
        if index.is_multiple_of(width) {
            budget.spend(VISIT_WORK * width).await;
        }
    }
    for index in inner.rev() {
        if ground.free[index] {
            let through = before.map(|(ahead, step)| depths[index + ahead] + step);
            depths[index] = through.into_iter().fold(depths[index], i32::min);
        }
        if index.is_multiple_of(width) {
            budget.spend(VISIT_WORK * width).await;
        }
    }
    depths
}
