//! Rows of cells along the borders of each level.

use super::depth::CELL;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::Ground;

/// Work of looking at a cell, and of a step along a border.
const LOOK_WORK: usize = 1;
const STEP_WORK: usize = 4;

/// Cells of one level, each beside the one before; the last one lies beside the first.
pub(super) struct Ring {
    pub(super) level: usize,
    pub(super) cells: Vec<usize>,
}

/// The rings of all levels.
pub(super) async fn rings(ground: &Ground, depths: &[i32], budget: &mut StepBudget) -> Vec<Ring> {
    let spacing = CELL * (2 * ground.reach as i32 + 1);
    // Each border has a cell that lies deep enough above one that does not; as depths of neighbours differ by a cell at
    // most and levels by more, that pair belongs to one level only.
    let mut is_seen = vec![false; depths.len()];
    let mut rings = Vec::new();
    for index in ground.width..depths.len() {
        if index.is_multiple_of(ground.width) {
            budget.spend(LOOK_WORK * ground.width).await;
        }
        if depths[index] < CELL || is_seen[index] {
            continue;
        }
        let level = (depths[index] - CELL) / spacing;
        let least = CELL + level * spacing;
        if depths[index - ground.width] < least {
            let is_in = |cell: usize| depths[cell] >= least;
            let cells = border(index, ground.width, is_in, &mut is_seen);
            budget.spend(STEP_WORK * cells.len()).await;
            rings.push(Ring {
                level: level as usize,
                cells,
            });
        }
    }
    rings
}

/// Follows the border of the cells that are in, with them on the left, from the lower edge of one.
fn border(start: usize, width: usize, is_in: impl Fn(usize) -> bool, is_seen: &mut [bool]) -> Vec<usize> {
    // East, north, west, south.
    let ahead = [1, width as isize, -1, -(width as isize)];
    let mut cells = vec![start];
    let (mut cell, mut heading) = (start, 0);
    loop {
        if heading == 0 {
            is_seen[cell] = true;
        }
        let left = cell.wrapping_add_signed(ahead[heading]);
        let right = left.wrapping_add_signed(ahead[(heading + 3) % 4]);
        if !is_in(left) {
            heading = (heading + 1) % 4;
        } else if !is_in(right) {
            cell = left;
            cells.push(cell);
        } else {
            cells.extend([left, right]);
            cell = right;
            heading = (heading + 3) % 4;
        }
        if cell == start && heading == 0 {
            break;
        }
    }
    if cells.len() > 1 {
        // The start, once more.
        cells.pop();
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::border;

    /// The border of the marked cells of a picture, its lowest line first, from the first cell that is marked.
    fn of(lines: &[&str]) -> Vec<usize> {
        let width = lines[0].len();
        let marked: Vec<bool> = lines.concat().chars().map(|mark| mark == '#').collect();
        let start = marked.iter().position(|marked| *marked).unwrap();
        border(start, width, |cell| marked[cell], &mut vec![false; marked.len()])
    }

    #[test]
    fn a_border_leads_round_its_cells_with_them_on_the_left() {
        assert_eq!(of(&["....", ".##.", ".##.", "...."]), [5, 6, 10, 9]);
        assert_eq!(of(&["...", ".#.", "..."]), [4]);
        // There and back.
        assert_eq!(of(&[".....", ".###.", "....."]), [6, 7, 8, 7]);
        // Round an inner corner, over the cell in it.
        assert_eq!(of(&["....", ".#..", ".##.", "...."]), [5, 9, 10, 9]);
    }
}
