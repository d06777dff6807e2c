//! Distance to the nearest cell of a kind, exact on the grid (Felzenszwalb and Huttenlocher 2012), read by bilinear
//! interpolation.

/// Signed distance in metres from a place to the border of the nearest cell of a kind: positive outside of such cells,
/// negative inside.
#[derive(Clone, Debug)]
pub(crate) struct DistanceField {
    cells_per_m: f64,
    cell_m: f64,
    width: usize,
    column_max: f64,
    row_max: f64,
    values: Vec<f32>,
}

/// Stands for "no such cell": farther than any grid is wide, small enough for exact squares in `f64`.
const NOWHERE: f64 = 1e7;

impl DistanceField {
    /// Field of the cells for which `is_kind` holds. The grid needs at least 2 x 2 cells.
    pub(crate) fn new(cell_m: f64, width: usize, height: usize, is_kind: impl Fn(usize) -> bool) -> Self {
        debug_assert!(
            width >= 2 && height >= 2,
            "interpolation needs two rows and columns"
        );
        let outward = squared_distances(width, height, &is_kind);
        let inward = squared_distances(width, height, |index| !is_kind(index));
        let half = 0.5 * cell_m;
        let values = outward
            .iter()
            .zip(&inward)
            .map(|(out, inside)| {
                let signed = if *out > 0.0 {
                    out.sqrt() * cell_m as f32 - half as f32
                } else {
                    half as f32 - inside.sqrt() * cell_m as f32
                };
                signed.clamp(-1e4, 1e4)
            })
            .collect();
        Self {
            cells_per_m: 1.0 / cell_m,
            cell_m,
            width,
            column_max: (width - 2) as f64,
            row_max: (height - 2) as f64,
            values,
        }
    }

    /// Distance at a place in metres; a place outside of the grid is taken at the nearest place of the grid.
    #[inline]
    pub(crate) fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let column = x_m * self.cells_per_m - 0.5;
        let row = y_m * self.cells_per_m - 0.5;
        let left = (column as u32 as f64).min(self.column_max);
        let low = (row as u32 as f64).min(self.row_max);
        let across = (column - left).clamp(0.0, 1.0) as f32;
        let up = (row - low).clamp(0.0, 1.0) as f32;
        let index = low as usize * self.width + left as usize;
        let (Some(lower), Some(upper)) = (
            self.values.get(index..index + 2),
            self.values.get(index + self.width..index + self.width + 2),
        ) else {
            return 0.0;
        };
        let below = lower[0] + (lower[1] - lower[0]) * across;
        let above = upper[0] + (upper[1] - upper[0]) * across;
        f64::from(below + (above - below) * up)
    }

    /// Unit vector along which the distance grows fastest; x when it grows nowhere.
    pub(crate) fn away(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let step = self.cell_m;
        let x = self.at(x_m + step, y_m) - self.at(x_m - step, y_m);
        let y = self.at(x_m, y_m + step) - self.at(x_m, y_m - step);
        let length = libm::sqrt(x * x + y * y);
        if length > 1e-9 {
            (x / length, y / length)
        } else {
            (1.0, 0.0)
        }
    }

    /// Value of one cell's centre.
    pub(crate) fn cell(&self, index: usize) -> f32 {
        self.values.get(index).copied().unwrap_or(-1e4)
    }
}

/// Squared distance in cells from each cell's centre to the centre of the nearest source cell.
pub(crate) fn squared_distances(width: usize, height: usize, is_source: impl Fn(usize) -> bool) -> Vec<f32> {
    let mut squared = column_distances(width, height, is_source);
    let mut row = vec![0.0; width];
    let mut envelope = ParabolaEnvelope::with_capacity(width);
    for cells in squared.chunks_exact_mut(width) {
        for (value, cell) in row.iter_mut().zip(cells.iter()) {
            *value = f64::from(*cell) * f64::from(*cell);
        }
        envelope.transform(&row, cells);
    }
    squared
}

/// Distance in cells to the nearest source cell of the same column.
fn column_distances(width: usize, height: usize, is_source: impl Fn(usize) -> bool) -> Vec<f32> {
    let mut distances = vec![NOWHERE as f32; width * height];
    for index in 0..width * height {
        let above = if index >= width {
            distances[index - width] + 1.0
        } else {
            NOWHERE as f32
        };
        distances[index] = if is_source(index) {
            0.0
        } else {
            above.min(NOWHERE as f32)
        };
    }
    for index in (0..width * height.saturating_sub(1)).rev() {
        distances[index] = distances[index].min(distances[index + width] + 1.0);
    }
    distances
}

/// Lower envelope of the parabolas `(x - apex)^2 + height`.
struct ParabolaEnvelope {
    apexes: Vec<usize>,
    starts: Vec<f64>,
}

impl ParabolaEnvelope {
    fn with_capacity(width: usize) -> Self {
        Self {
            apexes: Vec::with_capacity(width),
            starts: Vec::with_capacity(width),
        }
    }

    fn transform(&mut self, heights: &[f64], lowest: &mut [f32]) {
        self.build(heights);
        let mut parabola = 0;
        for (x, out) in lowest.iter_mut().enumerate() {
            while self
                .starts
                .get(parabola + 1)
                .is_some_and(|start| *start <= x as f64)
            {
                parabola += 1;
            }
            let apex = self.apexes[parabola];
            let dx = x as f64 - apex as f64;
            *out = (dx * dx + heights[apex]) as f32;
        }
    }

    fn build(&mut self, heights: &[f64]) {
        self.apexes.clear();
        self.starts.clear();
        for (apex, height) in heights.iter().enumerate() {
            let mut start = f64::NEG_INFINITY;
            while let (Some(last), Some(last_start)) = (self.apexes.last(), self.starts.last()) {
                let (a, b) = (*last as f64, apex as f64);
                start = (height + b * b - heights[*last] - a * a) / (2.0 * (b - a));
                if start > *last_start {
                    break;
                }
                self.apexes.pop();
                self.starts.pop();
                start = f64::NEG_INFINITY;
            }
            self.apexes.push(apex);
            self.starts.push(start);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DistanceField, squared_distances};
    use crate::Pcg;

    #[test]
    fn squared_distances_agree_with_brute_force() {
        let mut random = Pcg::new(7, 0);
        for density in [2, 20, 200] {
            let (width, height) = (23, 17);
            let sources: Vec<bool> = (0..width * height).map(|_| random.below(density) == 0).collect();
            let fast = squared_distances(width, height, |index| sources[index]);
            for (index, found) in fast.iter().enumerate() {
                let (x, y) = ((index % width) as f32, (index / width) as f32);
                let brute = sources
                    .iter()
                    .enumerate()
                    .filter(|(_, source)| **source)
                    .map(|(other, _)| {
                        let (dx, dy) = ((other % width) as f32 - x, (other / width) as f32 - y);
                        dx * dx + dy * dy
                    })
                    .fold(f32::INFINITY, f32::min);
                assert!(
                    brute.is_infinite() || *found == brute,
                    "cell {index}: {found} {brute}"
                );
            }
        }
    }

    #[test]
    fn field_is_zero_on_the_border_of_a_wall_and_points_away_from_it() {
        let field = DistanceField::new(0.02, 50, 50, |index| index % 50 < 10);
        assert!(field.at(0.20, 0.5).abs() < 1e-6);
        assert!((field.at(0.33, 0.5) - 0.13).abs() < 1e-6);
        assert!((field.at(0.15, 0.5) + 0.05).abs() < 1e-6);
        assert_eq!(field.away(0.3, 0.5), (1.0, 0.0));
        assert!(field.at(-9.0, 99.0).is_finite());
    }
}
