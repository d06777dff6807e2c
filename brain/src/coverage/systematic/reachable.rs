//! What the middle of the body can reach of a home that is known.

use crate::geometry::Point2;
use crate::gradual::Pace;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};

/// Work of looking at a cell, and of a row of a disc.
const LOOK_WORK: usize = 3;
const FILL_WORK: usize = 6;

/// Cells that the middle of a body of `radius_m` can take without coming over anything but free floor, nor over one of the
/// `blocked` points. The window is that of the knowledge.
pub(crate) async fn reachable(
    knowledge: &Raster<CellKnowledge>,
    (radius_m, blocked): (f64, &[Point2]),
    pace: &mut Pace,
) -> Raster<bool> {
    let (width, height) = (knowledge.width(), knowledge.height());
    let is_free: Vec<bool> = knowledge
        .values()
        .iter()
        .map(|cell| *cell == CellKnowledge::Free)
        .collect();
    let mut reachable = Raster::filled(knowledge.origin(), width, height, true);
    // From the middle of a cell to the border of the next one is half a cell.
    let disc = Disc::of_radius(radius_m / CELL_M + 0.5);
    for row in 0..height {
        let start = row * width;
        for column in 0..width {
            let index = start + column;
            let is_rim = column == 0 || row == 0 || column + 1 == width || row + 1 == height;
            if is_free[index] && !is_rim {
                continue;
            }
            let beside_floor = (column > 0 && is_free[index - 1])
                || (column + 1 < width && is_free[index + 1])
                || (row > 0 && is_free[index - width])
                || (row + 1 < height && is_free[index + width]);
            if beside_floor {
                disc.blank(&mut reachable, (column as i64, row as i64));
                pace.spend(FILL_WORK * disc.rows.len()).await;
            } else if let Some(place) = reachable.values_mut().get_mut(index) {
                *place = false;
            }
        }
        pace.spend(LOOK_WORK * width).await;
    }
    let disc = Disc::of_radius(radius_m / CELL_M);
    for point in blocked {
        let cell = Cell::under(*point);
        let column = i64::from(cell.x) - i64::from(knowledge.origin().x);
        let row = i64::from(cell.y) - i64::from(knowledge.origin().y);
        disc.blank(&mut reachable, (column, row));
    }
    reachable
}

/// Rows of a disc and half the cells of each.
#[derive(Debug)]
pub(super) struct Disc {
    rows: Vec<(i64, i64)>,
}

impl Disc {
    /// Cells whose middles are nearer than `radius` cells.
    pub(super) fn of_radius(radius: f64) -> Self {
        let most = libm::ceil(radius) as i64 - 1;
        let rows = (-most..=most)
            .map(|row| {
                let rise = row as f64;
                let half = libm::sqrt(radius * radius - rise * rise);
                (row, libm::ceil(half) as i64 - 1)
            })
            .collect();
        Self { rows }
    }

    /// Sets the cells around a place to false.
    fn blank(&self, raster: &mut Raster<bool>, place: (i64, i64)) {
        self.fill(raster, place, false);
    }

    /// Sets the cells around a place (column and row of the raster).
    pub(super) fn fill(&self, raster: &mut Raster<bool>, (column, row): (i64, i64), value: bool) {
        let (width, height) = (raster.width() as i64, raster.height() as i64);
        for (rise, half) in &self.rows {
            let y = row + rise;
            let (first, last) = ((column - half).max(0), (column + half).min(width - 1));
            if (0..height).contains(&y) && first <= last {
                let (first, last) = ((y * width + first) as usize, (y * width + last) as usize);
                if let Some(cells) = raster.values_mut().get_mut(first..=last) {
                    cells.fill(value);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::Point2;
    use crate::gradual::{Pace, at_once};
    use crate::mapping::{Cell, CellKnowledge, Raster};

    fn reachable(knowledge: &Raster<CellKnowledge>, radius_m: f64, blocked: &[Point2]) -> Raster<bool> {
        at_once(super::reachable(
            knowledge,
            (radius_m, blocked),
            &mut Pace::at_once(),
        ))
    }

    #[test]
    fn the_middle_keeps_the_radius_from_walls_and_from_what_was_met() {
        let mut knowledge = Raster::filled(Cell { x: -1, y: -1 }, 82, 82, CellKnowledge::Occupied);
        for x in 0..80 {
            for y in 0..80 {
                *knowledge.get_mut(Cell { x, y }).unwrap() = CellKnowledge::Free;
            }
        }
        let free = reachable(&knowledge, 0.175, &[]);
        // The middle of cell 7 is 0.1875 m from the wall, that of cell 6 only 0.1625 m.
        assert_eq!(free.get(Cell { x: 7, y: 40 }), Some(&true));
        assert_eq!(free.get(Cell { x: 6, y: 40 }), Some(&false));
        let met = Point2 { x_m: 1.01, y_m: 1.01 };
        let free = reachable(&knowledge, 0.175, &[met]);
        assert_eq!(free.get(Cell { x: 40, y: 40 }), Some(&false));
        assert_eq!(free.get(Cell { x: 40, y: 32 }), Some(&true));
    }
}
