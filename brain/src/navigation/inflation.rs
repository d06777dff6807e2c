//! What the middle of the body can reach of a home that is known.

use super::lane_frame::LaneFrame;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Work of looking at a cell, and of a row of a disc.
const LOOK_WORK: usize = 3;
const FILL_WORK: usize = 6;
/// Less than this is rounding, cells.
const HAIR: f64 = 1e-9;

/// Cells of `frame` that the middle of a body of `radius_m` can take without coming over anything but free floor, nor over one of
/// the `blocked` points of the map. In the map's own frame the window is that of the knowledge.
pub(crate) async fn reachable(
    knowledge: &Raster<CellKnowledge>,
    frame: &LaneFrame,
    (radius_m, blocked): (f64, &[Point2]),
    budget: &mut StepBudget,
) -> Raster<bool> {
    let inner = Inner::of(knowledge);
    let mut reachable = floor_in(frame, &inner, budget).await;
    // From the middle of a cell to the border of the next one is half a cell.
    let radius = radius_m / CELL_M + 0.5;
    for row in 0..knowledge.height() {
        for column in 0..inner.width {
            let index = row * inner.width + column;
            if inner.is_edge(index) {
                blank(
                    &mut reachable,
                    (frame.point(knowledge.cell(index).middle()), radius),
                );
                budget.spend(FILL_WORK * 2 * radius as usize).await;
            }
        }
        budget.spend(LOOK_WORK * inner.width).await;
    }
    for point in blocked {
        let cell = Cell::under(frame.point(*point));
        blank(&mut reachable, (cell.middle(), radius_m / CELL_M));
    }
    reachable
}

/// Free floor of the map that does not lie at the rim of its window, beyond which nothing is known.
struct Inner {
    origin: Cell,
    width: usize,
    is_free: Vec<bool>,
    is_inner: Vec<bool>,
}

impl Inner {
    fn of(knowledge: &Raster<CellKnowledge>) -> Self {
        let (width, height) = (knowledge.width(), knowledge.height());
        let is_free: Vec<bool> = knowledge
            .values()
            .iter()
            .map(|cell| *cell == CellKnowledge::Free)
            .collect();
        let mut is_inner = is_free.clone();
        for (row, cells) in is_inner.chunks_exact_mut(width.max(1)).enumerate() {
            if row == 0 || row + 1 == height {
                cells.fill(false);
            }
            if let Some(first) = cells.first_mut() {
                *first = false;
            }
            if let Some(last) = cells.last_mut() {
                *last = false;
            }
        }
        Self {
            origin: knowledge.origin(),
            width,
            is_free,
            is_inner,
        }
    }

    /// Whether a cell is none of the inner floor, but lies beside free floor.
    fn is_edge(&self, index: usize) -> bool {
        let is_free = |beside: usize| self.is_free.get(beside).copied().unwrap_or(false);
        let column = index % self.width;
        !self.is_inner[index]
            && ((column > 0 && is_free(index - 1))
                || (column + 1 < self.width && is_free(index + 1))
                || (index >= self.width && is_free(index - self.width))
                || is_free(index + self.width))
    }

    fn contains(&self, cell: Cell) -> bool {
        let column = i64::from(cell.x) - i64::from(self.origin.x);
        let row = i64::from(cell.y) - i64::from(self.origin.y);
        let index = row * self.width as i64 + column;
        (0..self.width as i64).contains(&column)
            && row >= 0
            && self.is_inner.get(index as usize).copied().unwrap_or(false)
    }

    /// The lowest and the highest cell of a frame that may hold any of it.
    fn bounds(&self, frame: &LaneFrame) -> (Cell, Cell) {
        let (mut low, mut high) = (
            (f64::INFINITY, f64::INFINITY),
            (f64::NEG_INFINITY, f64::NEG_INFINITY),
        );
        for (row, cells) in self.is_inner.chunks(self.width.max(1)).enumerate() {
            let first = cells.iter().position(|cell| *cell);
            let last = cells.iter().rposition(|cell| *cell);
            for column in [first, last].into_iter().flatten() {
                let at = frame.point(
                    Cell {
                        x: self.origin.x.saturating_add(column as i32),
                        y: self.origin.y.saturating_add(row as i32),
                    }
                    .middle(),
                );
                low = (low.0.min(at.x_m), low.1.min(at.y_m));
                high = (high.0.max(at.x_m), high.1.max(at.y_m));
            }
        }
        let cell = |(x_m, y_m): (f64, f64), more: i32| {
            let Cell { x, y } = Cell::under(Point2 { x_m, y_m });
            Cell {
                x: x.saturating_add(more),
                y: y.saturating_add(more),
            }
        };
        (cell(low, -2), cell(high, 2))
    }
}

/// The inner floor in the cells of a frame.
async fn floor_in(frame: &LaneFrame, inner: &Inner, budget: &mut StepBudget) -> Raster<bool> {
    if *frame == LaneFrame::OF_MAP {
        let height = inner.is_inner.len().checked_div(inner.width).unwrap_or(0);
        let mut floor = Raster::filled(inner.origin, inner.width, height, false);
        floor.values_mut().copy_from_slice(&inner.is_inner);
        return floor;
    }
    if !inner.is_inner.contains(&true) {
        return Raster::filled(inner.origin, 0, 0, false);
    }
    let (low, high) = inner.bounds(frame);
    let cells = |low: i32, high: i32| usize::try_from(i64::from(high) - i64::from(low) + 1).unwrap_or(0);
    let mut floor = Raster::filled(low, cells(low.x, high.x), cells(low.y, high.y), false);
    for row in 0..floor.height() {
        for index in row * floor.width()..(row + 1) * floor.width() {
            floor.values_mut()[index] = inner.contains(frame.cell_in_map(floor.cell(index)));
        }
        budget.spend(LOOK_WORK * floor.width()).await;
    }
    floor
}

/// Sets the cells to false whose middles are nearer than so many cells to a place.
fn blank(cells: &mut Raster<bool>, (at, radius): (Point2, f64)) {
    let (width, height) = (cells.width() as i64, cells.height() as i64);
    // In cells, counted from the middle of the window's first one.
    let column = at.x_m / CELL_M - 0.5 - f64::from(cells.origin().x);
    let row = at.y_m / CELL_M - 0.5 - f64::from(cells.origin().y);
    let span = |middle: f64, half: f64, count: i64| {
        let first = libm::floor(middle - half + HAIR) as i64 + 1;
        let last = libm::ceil(middle + half - HAIR) as i64 - 1;
        (first.max(0), last.min(count - 1))
    };
    let (low, high) = span(row, radius, height);
    for y in low..=high {
        let rise = y as f64 - row;
        let half = libm::sqrt((radius * radius - rise * rise).max(0.0));
        let (first, last) = span(column, half, width);
        if first <= last
            && let Some(cells) = cells
                .values_mut()
                .get_mut((y * width + first) as usize..=(y * width + last) as usize)
        {
            cells.fill(false);
        }
    }
}

/// Rows of a disc and half the cells of each.
#[derive(Debug)]
pub(crate) struct Disc {
    rows: Vec<(i64, i64)>,
}

impl Disc {
    /// Cells whose middles are nearer than `radius` cells.
    pub(crate) fn of_radius(radius: f64) -> Self {
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

    /// Sets the cells around a place (column and row of the raster).
    pub(crate) fn fill(&self, raster: &mut Raster<bool>, (column, row): (i64, i64), value: bool) {
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
    use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
    use crate::model::geometry::Point2;
    use crate::model::gradual::{StepBudget, at_once};
    use crate::navigation::lane_frame::LaneFrame;

    fn reachable(knowledge: &Raster<CellKnowledge>, radius_m: f64, blocked: &[Point2]) -> Raster<bool> {
        at_once(super::reachable(
            knowledge,
            &LaneFrame::OF_MAP,
            (radius_m, blocked),
            &mut StepBudget::unlimited(),
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

    #[test]
    fn in_a_turned_frame_the_middle_keeps_the_same_radius_from_the_same_walls() {
        let mut knowledge = Raster::filled(Cell { x: -1, y: -1 }, 122, 82, CellKnowledge::Occupied);
        for x in 0..120 {
            (0..80).for_each(|y| *knowledge.get_mut(Cell { x, y }).unwrap() = CellKnowledge::Free);
        }
        let frame = LaneFrame::along(0.5);
        let met = Point2 { x_m: 1.01, y_m: 1.01 };
        let free = at_once(super::reachable(
            &knowledge,
            &frame,
            (0.175, &[met]),
            &mut StepBudget::unlimited(),
        ));
        let mut count = 0;
        for index in (0..free.values().len()).filter(|index| free.values()[*index]) {
            let at = frame.point_in_map(free.cell(index).middle());
            let wall_m = at.x_m.min(at.y_m).min(3.0 - at.x_m).min(2.0 - at.y_m);
            // Between the middles of two cells a wall seen askew is thinner by a fraction of a millimetre.
            assert!(wall_m > 0.174, "{at:?}");
            assert!(at.distance_m(met) > 0.175 - CELL_M, "{at:?}");
            count += 1;
        }
        let expected_m2 = 2.65 * 1.65 - core::f64::consts::PI * 0.175 * 0.175;
        let found_m2 = f64::from(count) * CELL_M * CELL_M;
        assert!(
            (found_m2 / expected_m2 - 1.0).abs() < 0.02,
            "{found_m2} of {expected_m2}"
        );
    }
}
