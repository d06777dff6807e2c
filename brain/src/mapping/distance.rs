//! Distance to the nearest occupied cell, exact on the grid up to [`FAR_M`] and brought up to date piece by piece.
//!
//! Two passes after Felzenszwalb and Huttenlocher (2012): along columns, then the lower envelope of parabolas along rows.
//! What lies farther away than [`FAR_M`] is cut off, so a changed cell concerns only its surroundings.

use super::layers::CellBox;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// Cells up to which distances are exact.
pub(super) const FAR_CELLS: i32 = 32;
/// Distance in metres that stands for itself and everything farther.
pub const FAR_M: f64 = FAR_CELLS as f64 * CELL_M;
const FAR_MM: i16 = (FAR_M * 1000.0) as i16;
/// Work of a cell: along its column, and along its row.
const COLUMN_WORK: usize = 3;
const ENVELOPE_WORK: usize = 8;
/// Half a cell in millimetres: from the centre of a cell to its border.
const HALF_MM: f64 = 500.0 * CELL_M;

/// Signed distance from a place to the border of the nearest occupied cell: positive outside of obstacles, negative inside.
/// Outside of the mapped window it is [`FAR_M`].
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    millimetres: Raster<i16>,
}

impl Default for DistanceField {
    fn default() -> Self {
        Self {
            millimetres: Raster::filled(Cell::default(), 0, 0, FAR_MM),
        }
    }
}

impl DistanceField {
    /// The field of the occupied cells of `knowledge`.
    #[must_use]
    pub fn new(knowledge: &Raster<CellKnowledge>) -> Self {
        at_once(Self::in_steps(knowledge, &mut StepBudget::unlimited()))
    }

    /// As [`Self::new`], in steps.
    pub(crate) async fn in_steps(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Self {
        let mut millimetres =
            Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), FAR_MM);
        if let Some(all) = window(knowledge) {
            let is_occupied = |cell: Cell| knowledge.get(cell) == Some(&CellKnowledge::Occupied);
            let outward = squared_cells(all, is_occupied, budget).await;
            let inward = squared_cells(all, |cell| !is_occupied(cell), budget).await;
            let squared = outward.iter().zip(&inward);
            for (value, (out, inside)) in millimetres.values_mut().iter_mut().zip(squared) {
                *value = signed_mm(*out, *inside);
                budget.spend(1).await;
            }
        }
        Self { millimetres }
    }

    /// Lower left cell, columns and rows of the window that has values.
    #[must_use]
    pub fn window(&self) -> (Cell, usize, usize) {
        (
            self.millimetres.origin(),
            self.millimetres.width(),
            self.millimetres.height(),
        )
    }

    /// Distance at the centre of a cell in metres, -[`FAR_M`]..=[`FAR_M`].
    #[must_use]
    pub fn cell_m(&self, cell: Cell) -> f64 {
        f64::from(self.millimetres.get(cell).copied().unwrap_or(FAR_MM)) * 1e-3
    }

    /// Distance at a point in metres, interpolated between cells.
    #[must_use]
    pub fn at(&self, point: Point2) -> f64 {
        let (low, across, up) = between(point);
        let [lower_left, lower_right, upper_left, upper_right] = self.corners(low);
        let below = lower_left + (lower_right - lower_left) * across;
        let above = upper_left + (upper_right - upper_left) * across;
        (below + (above - below) * up) * 1e-3
    }

    /// How the distance grows along x and y at a point, metres per metre: away from the nearest obstacle, and 0 where
    /// everything is far.
    #[must_use]
    pub fn gradient(&self, point: Point2) -> Point2 {
        let (low, across, up) = between(point);
        let [lower_left, lower_right, upper_left, upper_right] = self.corners(low);
        let per_m = 1e-3 / CELL_M;
        Point2 {
            x_m: ((lower_right - lower_left) * (1.0 - up) + (upper_right - upper_left) * up) * per_m,
            y_m: ((upper_left - lower_left) * (1.0 - across) + (upper_right - lower_right) * across) * per_m,
        }
    }

    /// Millimetres at the centres of the four cells from `low` on.
    fn corners(&self, low: Cell) -> [f64; 4] {
        let values = self.millimetres.values();
        let width = self.millimetres.width();
        let far = f64::from(FAR_MM);
        let value = |index: usize| values.get(index).map_or(far, |value| f64::from(*value));
        let column = i64::from(low.x) - i64::from(self.millimetres.origin().x);
        if let Some(index) = self.millimetres.index(low)
            && column + 1 < width as i64
        {
            return [
                value(index),
                value(index + 1),
                value(index + width),
                value(index + width + 1),
            ];
        }
        let single = |x: i32, y: i32| {
            let cell = Cell {
                x: low.x.saturating_add(x),
                y: low.y.saturating_add(y),
            };
            self.millimetres.get(cell).map_or(far, |value| f64::from(*value))
        };
        [single(0, 0), single(1, 0), single(0, 1), single(1, 1)]
    }

    /// Takes up a window that has grown; what is new is far until [`Self::renew`].
    pub(super) fn cover(&mut self, window: CellBox) {
        self.millimetres = grown(&self.millimetres, window, FAR_MM);
    }

    /// Brings up to date what cells of `changed` may have to do with.
    pub(super) fn renew(&mut self, knowledge: &Raster<CellKnowledge>, changed: CellBox) {
        let Some(all) = window(knowledge) else { return };
        let Some(target) = meet(changed.grown(FAR_CELLS), all) else {
            return;
        };
        let Some(source) = meet(changed.grown(2 * FAR_CELLS), all) else {
            return;
        };
        let is_occupied = |cell: Cell| {
            knowledge
                .get(cell)
                .is_some_and(|kind| *kind == CellKnowledge::Occupied)
        };
        let budget = &mut StepBudget::unlimited();
        let outward = at_once(squared_cells(source, is_occupied, budget));
        let inward = at_once(squared_cells(source, |cell| !is_occupied(cell), budget));
        let (width, _) = source.size();
        for y in target.low.y..=target.high.y {
            for x in target.low.x..=target.high.x {
                let row = y.abs_diff(source.low.y) as usize;
                let place = row * width + x.abs_diff(source.low.x) as usize;
                let (Some(out), Some(inside)) = (outward.get(place), inward.get(place)) else {
                    continue;
                };
                if let Some(value) = self.millimetres.get_mut(Cell { x, y }) {
                    *value = signed_mm(*out, *inside);
                }
            }
        }
    }

    /// Bytes of the values.
    pub(super) fn memory_bytes(&self) -> usize {
        size_of_val(self.millimetres.values())
    }
}

/// The lower left of the four cells whose centres surround a point, and the shares towards the others.
fn between(point: Point2) -> (Cell, f64, f64) {
    let (column, row) = (point.x_m / CELL_M - 0.5, point.y_m / CELL_M - 0.5);
    let (left, low) = (libm::floor(column), libm::floor(row));
    let cell = Cell {
        x: left as i32,
        y: low as i32,
    };
    (cell, column - left, row - low)
}

fn signed_mm(outward: f32, inward: f32) -> i16 {
    let side = if outward > 0.0 { outward } else { inward };
    let millimetres = 1000.0 * CELL_M * libm::sqrt(f64::from(side)) - HALF_MM;
    let bounded = millimetres.min(f64::from(FAR_MM)) as i16;
    if outward > 0.0 { bounded } else { -bounded }
}

/// All cells of a raster; `None` if it has none.
pub(super) fn window<T>(raster: &Raster<T>) -> Option<CellBox> {
    let last = raster.values().len().checked_sub(1)?;
    Some(CellBox {
        low: raster.origin(),
        high: raster.cell(last),
    })
}

/// The cells that two boxes share.
pub(super) fn meet(one: CellBox, other: CellBox) -> Option<CellBox> {
    let both = CellBox {
        low: Cell {
            x: one.low.x.max(other.low.x),
            y: one.low.y.max(other.low.y),
        },
        high: Cell {
            x: one.high.x.min(other.high.x),
            y: one.high.y.min(other.high.y),
        },
    };
    (both.low.x <= both.high.x && both.low.y <= both.high.y).then_some(both)
}

/// A raster over `window` with the values of `raster` where it has some.
pub(super) fn grown<T: Clone>(raster: &Raster<T>, window: CellBox, empty: T) -> Raster<T> {
    let (width, height) = window.size();
    let mut larger = Raster::filled(window.low, width, height, empty);
    for (row, values) in raster.values().chunks_exact(raster.width().max(1)).enumerate() {
        let begin = larger.index(raster.cell(row * raster.width()));
        let end = begin.map_or(0, |begin| begin + values.len());
        if let Some(places) = begin.and_then(|begin| larger.values_mut().get_mut(begin..end)) {
            places.clone_from_slice(values);
        }
    }
    larger
}

/// Squared distance in cells from each cell's centre to the centre of the nearest source cell within the box; at least
/// [`FAR_CELLS`] squared where there is none so near.
pub(super) async fn squared_cells(
    window: CellBox,
    is_source: impl Fn(Cell) -> bool,
    budget: &mut StepBudget,
) -> Vec<f32> {
    let (width, height) = window.size();
    let mut cells = column_distances(window, is_source, budget).await;
    let mut row = vec![0.0_f32; width];
    let mut envelope = Envelope::with_capacity(width);
    debug_assert_eq!(cells.len(), width * height, "one value for each cell");
    for values in cells.chunks_exact_mut(width.max(1)) {
        for (squared, value) in row.iter_mut().zip(values.iter()) {
            *squared = value * value;
        }
        envelope.transform(&row, values);
        budget.spend(ENVELOPE_WORK * width).await;
    }
    cells
}

/// Distance in cells to the nearest source of the same column, cut off one beyond [`FAR_CELLS`].
async fn column_distances(
    window: CellBox,
    is_source: impl Fn(Cell) -> bool,
    budget: &mut StepBudget,
) -> Vec<f32> {
    const NONE: f32 = FAR_CELLS as f32 + 1.0;
    let (width, height) = window.size();
    let mut cells = Vec::with_capacity(width * height);
    for y in window.low.y..=window.high.y {
        for x in window.low.x..=window.high.x {
            let value = if is_source(Cell { x, y }) {
                0.0
            } else {
                let below: Option<&f32> = cells.len().checked_sub(width).and_then(|index| cells.get(index));
                below.map_or(NONE, |below| (below + 1.0).min(NONE))
            };
            cells.push(value);
        }
        budget.spend(COLUMN_WORK * width).await;
    }
    for row in (0..height.saturating_sub(1)).rev() {
        for index in row * width..(row + 1) * width {
            let above = cells[index + width] + 1.0;
            if above < cells[index] {
                cells[index] = above;
            }
        }
        budget.spend(width).await;
    }
    cells
}

/// Lower envelope of the parabolas of one row.
struct Envelope {
    /// Columns whose parabola is lowest somewhere.
    columns: Vec<usize>,
    /// Where each begins to be lowest.
    starts: Vec<f64>,
}

impl Envelope {
    fn with_capacity(width: usize) -> Self {
        Self {
            columns: Vec::with_capacity(width),
            starts: Vec::with_capacity(width),
        }
    }

    fn transform(&mut self, heights: &[f32], lowest: &mut [f32]) {
        self.columns.clear();
        self.starts.clear();
        for (column, height) in heights.iter().enumerate() {
            self.add(column, *height, heights);
        }
        let mut place = 0;
        for (column, value) in lowest.iter_mut().enumerate() {
            while self
                .starts
                .get(place + 1)
                .is_some_and(|start| *start <= column as f64)
            {
                place += 1;
            }
            let apex = self.columns.get(place).copied().unwrap_or(column);
            let way = column as f32 - apex as f32;
            *value = way * way + heights.get(apex).copied().unwrap_or_default();
        }
    }

    fn add(&mut self, column: usize, height: f32, heights: &[f32]) {
        let lifted = f64::from(height) + (column * column) as f64;
        while let Some(&apex) = self.columns.last() {
            let other = f64::from(heights.get(apex).copied().unwrap_or_default()) + (apex * apex) as f64;
            let cross = (lifted - other) / (2.0 * (column - apex) as f64);
            if self.starts.last().is_some_and(|start| cross <= *start) {
                self.columns.pop();
                self.starts.pop();
            } else {
                self.columns.push(column);
                self.starts.push(cross);
                return;
            }
        }
        self.columns.push(column);
        self.starts.push(f64::NEG_INFINITY);
    }
}
