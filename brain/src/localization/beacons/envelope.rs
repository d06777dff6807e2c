//! A symmetric, positive definite system of equations most of whose entries are 0: each row is kept from its first entry
//! to the diagonal, and solving it (Cholesky) fills in no more than that.

/// The system `matrix * x = right`.
#[derive(Clone, Debug)]
pub(super) struct Envelope {
    /// Row by row, from the first column that is not 0 to the diagonal.
    rows: Vec<Row>,
    right: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Row {
    first: usize,
    values: Vec<f64>,
}

impl Row {
    fn at(&self, column: usize) -> f64 {
        column
            .checked_sub(self.first)
            .and_then(|place| self.values.get(place))
            .copied()
            .unwrap_or(0.0)
    }

    /// Values of the columns from `column` on.
    fn from(&self, column: usize) -> &[f64] {
        column
            .checked_sub(self.first)
            .and_then(|place| self.values.get(place..))
            .unwrap_or_default()
    }
}

/// The system, solved for any right side.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    rows: Vec<Row>,
}

impl Envelope {
    /// All 0, with rows that begin at these columns.
    pub(super) fn new(first: impl Iterator<Item = usize>) -> Self {
        let rows: Vec<Row> = first
            .enumerate()
            .map(|(number, first)| Row {
                first: first.min(number),
                values: vec![0.0; number - first.min(number) + 1],
            })
            .collect();
        Self {
            right: vec![0.0; rows.len()],
            rows,
        }
    }

    /// Adds a measurement: it is off by `off` standard deviations, and these are the derivatives of that by the unknowns.
    pub(super) fn measure(&mut self, off: f64, derivatives: &[(usize, f64)]) {
        for &(row, by_row) in derivatives {
            if let Some(right) = self.right.get_mut(row) {
                *right -= by_row * off;
            }
            for &(column, by_column) in derivatives.iter().filter(|(column, _)| *column <= row) {
                let place = self.rows.get_mut(row).and_then(|kept| {
                    let place = column.checked_sub(kept.first)?;
                    kept.values.get_mut(place)
                });
                if let Some(value) = place {
                    *value += by_row * by_column;
                }
            }
        }
    }

    /// The change of the unknowns that explains the measurements best; `None` when they do not determine it.
    pub(super) fn solve(self) -> Option<(Vec<f64>, Factor)> {
        let right = self.right;
        let factor = Factor::of(self.rows)?;
        let solution = factor.solve(right);
        Some((solution, factor))
    }
}

impl Factor {
    fn of(rows: Vec<Row>) -> Option<Self> {
        let mut done: Vec<Row> = Vec::with_capacity(rows.len());
        for (number, mut row) in rows.into_iter().enumerate() {
            for column in row.first..number {
                let other = done.get(column)?;
                let begin = row.first.max(other.first);
                let sum: f64 = row
                    .from(begin)
                    .iter()
                    .zip(other.from(begin))
                    .take(column.saturating_sub(begin))
                    .map(|(one, two)| one * two)
                    .sum();
                let diagonal = other.at(column);
                let value = row.values.get_mut(column - row.first)?;
                *value = (*value - sum) / diagonal;
            }
            let squares: f64 = row
                .values
                .iter()
                .take(number - row.first)
                .map(|value| value * value)
                .sum();
            let diagonal = row.values.last_mut()?;
            let left = *diagonal - squares;
            // Written so that NaN is no solution.
            let definite = left > 1e-12;
            if !definite {
                return None;
            }
            *diagonal = libm::sqrt(left);
            done.push(row);
        }
        Some(Self { rows: done })
    }

    /// The solution for another right side.
    pub(super) fn solve(&self, right: Vec<f64>) -> Vec<f64> {
        let mut solution = right;
        for (number, row) in self.rows.iter().enumerate() {
            let (before, rest) = solution.split_at_mut(number);
            let known = before.get(row.first..).unwrap_or_default();
            let sum: f64 = row.values.iter().zip(known).map(|(one, two)| one * two).sum();
            if let Some(value) = rest.first_mut() {
                *value = (*value - sum) / row.at(number);
            }
        }
        for (number, row) in self.rows.iter().enumerate().rev() {
            let (before, rest) = solution.split_at_mut(number);
            let Some(value) = rest.first_mut() else { continue };
            *value /= row.at(number);
            let known = before.get_mut(row.first..).unwrap_or_default();
            for (one, two) in known.iter_mut().zip(&row.values) {
                *one -= two * *value;
            }
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::Envelope;

    #[test]
    fn a_chain_with_a_common_unknown_is_solved() {
        // Ten unknowns in a chain, each 1 more than the one before plus the last unknown, which is 0.5.
        let mut system =
            Envelope::new((0..11_usize).map(|row| if row == 10 { 0 } else { row.saturating_sub(1) }));
        system.measure(0.0, &[(0, 1.0)]);
        for row in 1..10 {
            system.measure(-1.0, &[(row, 1.0), (row - 1, -1.0), (10, -1.0)]);
        }
        system.measure(-13.5, &[(9, 1.0)]);
        let (solution, factor) = system.solve().unwrap();
        assert!((solution[10] - 0.5).abs() < 1e-9, "{solution:?}");
        assert!((solution[4] - 6.0).abs() < 1e-9, "{solution:?}");
        let mut unit = vec![0.0; 11];
        unit[10] = 1.0;
        assert!(factor.solve(unit)[10] > 0.0, "a variance");
    }

    #[test]
    fn what_is_not_determined_has_no_solution() {
        let mut system = Envelope::new(0..2_usize);
        system.measure(1.0, &[(0, 1.0)]);
        assert!(system.solve().is_none());
    }
}
