//! A symmetric positive system of equations whose rows begin late: a chain of poses and, below it, the things that many
//! of them saw. Cholesky's factor of such a matrix begins no earlier in any row (skyline storage).

/// `matrix * x = right`, with the lower half of the matrix.
#[derive(Clone, Debug, Default)]
pub(super) struct System {
    /// Column in which each row begins.
    first: Vec<usize>,
    /// Where each row begins in `values`.
    start: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl System {
    /// All zero; row `r` begins in column `first[r]`.
    pub(super) fn new(first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut length = 0;
        for (row, column) in first.iter().enumerate() {
            start.push(length);
            length += (row + 1).saturating_sub(*column);
        }
        Self {
            right: vec![0.0; first.len()],
            values: vec![0.0; length],
            first,
            start,
        }
    }

    /// Adds the square of a residual `value + sum(slopes * x)` of this weight: it wants to become zero.
    pub(super) fn add_residual(&mut self, slopes: &[(usize, f64)], value: f64, weight: f64) {
        for (row, slope) in slopes {
            if let Some(right) = self.right.get_mut(*row) {
                *right -= weight * slope * value;
            }
            for (column, other) in slopes {
                if column <= row
                    && let Some(place) = self.place(*row, *column)
                    && let Some(entry) = self.values.get_mut(place)
                {
                    *entry += weight * slope * other;
                }
            }
        }
    }

    fn place(&self, row: usize, column: usize) -> Option<usize> {
        let offset = column.checked_sub(*self.first.get(row)?)?;
        Some(self.start.get(row)? + offset)
    }

    fn row(&self, row: usize) -> &[f64] {
        let (Some(start), Some(first)) = (self.start.get(row), self.first.get(row)) else {
            return &[];
        };
        let end = start + (row + 1).saturating_sub(*first);
        self.values.get(*start..end).unwrap_or_default()
    }

    /// The solution; `None` when the matrix is not positive.
    pub(super) fn solve(mut self) -> Option<Vec<f64>> {
        for row in 0..self.first.len() {
            self.factor_row(row)?;
        }
        self.substitute()
    }

    fn factor_row(&mut self, row: usize) -> Option<()> {
        let first = *self.first.get(row)?;
        let start = *self.start.get(row)?;
        for column in first..=row {
            let their_first = *self.first.get(column)?;
            let from = first.max(their_first);
            let length = column.saturating_sub(from);
            let own = self.values.get(start + from - first..)?.get(..length)?;
            let theirs = self.row(column).get(from - their_first..)?.get(..length)?;
            let dot: f64 = own.iter().zip(theirs).map(|(one, other)| one * other).sum();
            let place = start + column - first;
            let left = *self.values.get(place)? - dot;
            let value = if column == row {
                // Written so that NaN is not positive.
                let is_positive = left > 1e-12;
                if !is_positive {
                    return None;
                }
                libm::sqrt(left)
            } else {
                left / self.row(column).last()?
            };
            *self.values.get_mut(place)? = value;
        }
        Some(())
    }

    fn substitute(mut self) -> Option<Vec<f64>> {
        let mut x = core::mem::take(&mut self.right);
        for row in 0..x.len() {
            let first = *self.first.get(row)?;
            let (diagonal, before) = self.row(row).split_last()?;
            let dot: f64 = before
                .iter()
                .zip(x.get(first..)?)
                .map(|(factor, known)| factor * known)
                .sum();
            *x.get_mut(row)? = (x.get(row)? - dot) / diagonal;
        }
        for row in (0..x.len()).rev() {
            let first = *self.first.get(row)?;
            let (diagonal, before) = self.row(row).split_last()?;
            let value = x.get(row)? / diagonal;
            *x.get_mut(row)? = value;
            for (factor, left) in before.iter().zip(x.get_mut(first..)?) {
                *left -= factor * value;
            }
        }
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::System;
    use crate::random::Random;

    #[test]
    fn the_solution_makes_all_residuals_least() {
        let mut random = Random::new(7);
        let count = 30;
        // A chain, and every fifth unknown seen by all before it.
        let first = (0..count).map(|row| if row % 5 == 4 { 0 } else { usize::max(row, 2) - 2 });
        let mut system = System::new(first.collect());
        let truth: Vec<f64> = (0..count).map(|_| random.normal()).collect();
        let mut residuals = Vec::new();
        for row in 0..count {
            residuals.push((vec![(row, 1.0)], -truth[row]));
            for column in (if row % 5 == 4 { 0 } else { usize::max(row, 2) - 2 })..row {
                let slope = random.normal();
                residuals.push((
                    vec![(row, slope), (column, 1.0)],
                    -slope * truth[row] - truth[column],
                ));
            }
        }
        for (slopes, value) in &residuals {
            system.add_residual(slopes, *value, 3.0);
        }
        let found = system.solve().unwrap();
        for (found, truth) in found.iter().zip(&truth) {
            assert!((found - truth).abs() < 1e-9, "{found} instead of {truth}");
        }
    }

    #[test]
    fn what_is_not_determined_has_no_solution() {
        let mut system = System::new(vec![0, 0]);
        system.add_residual(&[(0, 1.0), (1, 1.0)], 1.0, 1.0);
        assert_eq!(system.solve(), None);
        let mut system = System::new(vec![0]);
        system.add_residual(&[(0, f64::NAN)], 1.0, 1.0);
        assert_eq!(system.solve(), None);
    }
}
