//! Distance to the nearest occupied cell, exact on the grid up to [`FAR_M`] and updated incrementally.
//!
//! Two passes after Felzenszwalb and Huttenlocher (2012): along columns, then the lower envelope of parabolas along rows.
//! Distances saturate at [`FAR_M`], so a changed cell affects only its surroundings.

use super::occupancy_grid::CellBox;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// Largest exact distance, cells.
pub(super) const FAR_CELLS: i32 = 32;
/// Distances saturate at this value, metres.
pub const FAR_M: f64 = FAR_CELLS as f64 * CELL_M;
const FAR_MM: i16 = (FAR_M * 1000.0) as i16;
/// Work per cell: along its column, and along its row.
const COLUMN_WORK: usize = 3;
const ENVELOPE_WORK: usize = 8;
/// Half a cell in millimetres: from the centre of a cell to its border.
const HALF_MM: f64 = 500.0 * CELL_M;

/// Signed distance to the border of the nearest occupied cell: positive outside of obstacles, negative inside. Outside of the
/// mapped window it is [`FAR_M`].
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

    /// Lower left cell, columns and rows of the field.
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

    /// Bounds of [`Self::at`] within a radius of a point, metres: nowhere is it less than the first, or more than the second. It changes
    /// by at most a metre for each metre of way, but for the edge of the window.
    #[must_use]
    pub(crate) fn around(&self, point: Point2, radius_m: f64) -> (f64, f64) {
        // Interpolation between cells can be steeper, by less than a cell in all.
        let reach_m = radius_m + CELL_M;
        let (origin, width, height) = self.window();
        let x = AxisPlace::of(point.x_m, origin.x, width);
        let y = AxisPlace::of(point.y_m, origin.y, height);
        if x.inside_m.min(y.inside_m) < -reach_m {
            return (FAR_M, FAR_M);
        }
        let here_m = self.at(Point2 {
            x_m: x.nearest_m,
            y_m: y.nearest_m,
        });
        let stays_inside = x.inside_m.min(y.inside_m) >= reach_m;
        let greatest_m = if stays_inside { here_m + reach_m } else { FAR_M };
        ((here_m - reach_m).min(FAR_M), greatest_m.min(FAR_M))
    }

    /// Gradient along x and y at a point, metres per metre: it points away from the nearest obstacle, and is 0 far from all.
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

    /// Millimetres at the centres of four cells, the lower left of which is `low`.
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

    /// Extends the field to a larger window; new cells are far from everything until [`Self::renew`].
    pub(super) fn cover(&mut self, window: CellBox) {
        self.millimetres = grown(&self.millimetres, window, FAR_MM);
    }

    /// Updates all cells that changes in `changed` may affect.
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

/// Where a coordinate is along the window of a field.
#[derive(Clone, Copy, Debug)]
struct AxisPlace {
    /// The nearest coordinate between the middles of the first and the last cell, metres.
    nearest_m: f64,
    /// Distance from the nearer of these two, metres; negative outside of them.
    inside_m: f64,
}

impl AxisPlace {
    fn of(coordinate_m: f64, first: i32, cells: usize) -> Self {
        let low_m = (f64::from(first) + 0.5) * CELL_M;
        let high_m = low_m + (cells as f64 - 1.0) * CELL_M;
        Self {
            nearest_m: coordinate_m.max(low_m).min(high_m),
            inside_m: (coordinate_m - low_m).min(high_m - coordinate_m),
        }
    }
}

/// The lower left of the four cells whose centres surround a point, and the interpolation weights towards the others.
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

/// Intersection of two boxes.
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

/// A raster over `window` with the values of `raster` where it has any.
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

/// Squared distance in cells from each cell's centre to the centre of the nearest source cell in the box; at least [`FAR_CELLS`]
/// squared where there is none that near.
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

/// Whether a source lies within `squared_max` squared cells of each cell of `window`, row after row. Where only that is asked it is found
/// several times faster than by [`squared_cells`].
pub(super) async fn near(
    window: CellBox,
    is_source: impl Fn(Cell) -> bool,
    squared_max: i32,
    budget: &mut StepBudget,
) -> Vec<bool> {
    let (width, height) = window.size();
    let mut near = vec![false; width * height];
    let mut cells = column_distances(window, is_source, budget).await;
    let rows = cells.chunks_exact_mut(width.max(1));
    for (heights, row) in rows.zip(near.chunks_exact_mut(width.max(1))) {
        heights.iter_mut().for_each(|height| *height *= *height);
        mark_near(row, heights, squared_max);
        budget.spend(ENVELOPE_WORK * width).await;
    }
    near
}

/// Marks the cells of a row that have a source so near, from the squared distances along the columns.
fn mark_near(row: &mut [bool], squared: &[f32], squared_max: i32) {
    let sideways = (0_usize..row.len()).map(|aside| (aside, aside as f32 * aside as f32));
    for (aside, aside_squared) in sideways.take_while(|(_, squared)| *squared <= squared_max as f32) {
        let most = squared_max as f32 - aside_squared;
        let to_the_right = squared.get(aside..).unwrap_or_default();
        for (place, there) in row.iter_mut().zip(to_the_right) {
            *place |= *there <= most;
        }
        let beyond = row.get_mut(aside..).unwrap_or_default();
        for (place, there) in beyond.iter_mut().zip(squared) {
            *place |= *there <= most;
        }
    }
}

/// Distance in cells to the nearest source in the same column, limited to one more than [`FAR_CELLS`].
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
    /// Start of the interval in which each is lowest.
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
            let offset = column as f32 - apex as f32;
            *value = offset * offset + heights.get(apex).copied().unwrap_or_default();
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

#[cfg(test)]
mod tests {
    use super::DistanceField;
    use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
    use crate::model::geometry::Point2;
    use crate::model::random::Random;

    /// A window with obstacles up to its edges.
    fn field(random: &mut Random) -> DistanceField {
        let mut knowledge = Raster::filled(Cell { x: -20, y: 10 }, 90, 70, CellKnowledge::Free);
        for value in knowledge.values_mut() {
            if random.between(0.0, 1.0) < 0.004 {
                *value = CellKnowledge::Occupied;
            }
        }
        DistanceField::new(&knowledge)
    }

    #[test]
    fn no_value_around_a_point_is_out_of_its_bounds() {
        let mut random = Random::new(5);
        let mut narrow = 0;
        for _ in 0..20 {
            let field = field(&mut random);
            for _ in 0..400 {
                // From a metre outside of the window to a metre beyond it.
                let middle = Point2 {
                    x_m: random.between(-60.0, 110.0) * CELL_M,
                    y_m: random.between(-30.0, 120.0) * CELL_M,
                };
                let radius_m = random.between(0.0, 0.5);
                let (least_m, greatest_m) = field.around(middle, radius_m);
                narrow += u32::from(greatest_m - least_m < 0.4);
                for _ in 0..20 {
                    let angle_rad = random.between(0.0, core::f64::consts::TAU);
                    let away_m = random.between(0.0, radius_m);
                    let value_m = field.at(Point2 {
                        x_m: middle.x_m + away_m * libm::cos(angle_rad),
                        y_m: middle.y_m + away_m * libm::sin(angle_rad),
                    });
                    assert!(
                        (least_m..=greatest_m).contains(&value_m),
                        "{value_m} is not in {least_m}..={greatest_m} within {radius_m} of {middle:?}"
                    );
                }
            }
        }
        assert!(narrow > 1_000, "only {narrow} bounds of 8,000 say anything");
    }
}
