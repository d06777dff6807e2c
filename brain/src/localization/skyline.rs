//! Cholesky solver for symmetric positive definite systems in skyline storage. The rows of such systems begin late: a chain of
//! poses and, below it, the things that many poses observe. The Cholesky factor begins no earlier in any row.

use crate::model::gradual::StepBudget;

/// Work of an entry besides the multiplications.
const ENTRY_WORK: usize = 10;

/// How products are summed up. It determines the last bits of a solution.
#[derive(Clone, Copy, Debug)]
pub(super) enum Summation {
    /// One after the other.
    InOrder,
    /// In four parallel sums, because a single sum makes processors wait: for long rows.
    Interleaved,
}

/// The lower half of a symmetric matrix, each row from its first entry to the diagonal.
#[derive(Clone, Debug)]
struct Skyline {
    summation: Summation,
    /// Column in which each row begins.
    first: Vec<usize>,
    /// Index of each row's first entry in `values`.
    start: Vec<usize>,
    values: Vec<f64>,
}

/// The system `matrix * x = right`.
#[derive(Clone, Debug)]
pub(super) struct System {
    matrix: Skyline,
    right: Vec<f64>,
}

/// The Cholesky factor of a matrix.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    matrix: Skyline,
}

/// The solution of a system, and the factor for other right sides.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub(super) values: Vec<f64>,
    pub(super) factor: Factor,
}

impl Skyline {
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

    fn dot(&self, one: &[f64], other: &[f64]) -> f64 {
        match self.summation {
            Summation::InOrder => one.iter().zip(other).map(|(one, other)| one * other).sum(),
            Summation::Interleaved => interleaved_dot(one, other),
        }
    }

    /// Computes an entry of the factor; all entries before it must be done. Returns the number of multiplications; `None` when the
    /// matrix is not positive definite.
    fn factor_entry(&mut self, row: usize, column: usize) -> Option<usize> {
        let first = *self.first.get(row)?;
        let start = *self.start.get(row)?;
        let their_first = *self.first.get(column)?;
        let from = first.max(their_first);
        let length = column.saturating_sub(from);
        let own = self.values.get(start + from - first..)?.get(..length)?;
        let theirs = self.row(column).get(from - their_first..)?.get(..length)?;
        let place = start + column - first;
        let left = *self.values.get(place)? - self.dot(own, theirs);
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
        Some(length)
    }
}

impl System {
    /// All zero; row `r` begins in column `first[r]`.
    pub(super) fn new(first: Vec<usize>, summation: Summation) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut length = 0;
        for (row, column) in first.iter().enumerate() {
            start.push(length);
            length += (row + 1).saturating_sub(*column);
        }
        Self {
            right: vec![0.0; first.len()],
            matrix: Skyline {
                summation,
                values: vec![0.0; length],
                first,
                start,
            },
        }
    }

    /// Adds the squared residual `value + sum(slopes * x)` with this weight.
    pub(super) fn add_residual(&mut self, slopes: &[(usize, f64)], value: f64, weight: f64) {
        for (row, slope) in slopes {
            if let Some(right) = self.right.get_mut(*row) {
                *right -= weight * slope * value;
            }
            for (column, other) in slopes {
                if column <= row
                    && let Some(place) = self.matrix.place(*row, *column)
                    && let Some(entry) = self.matrix.values.get_mut(place)
                {
                    *entry += weight * slope * other;
                }
            }
        }
    }

    /// Solves it; `None` when the residuals do not determine all unknowns.
    pub(super) async fn solve(self, budget: &mut StepBudget) -> Option<Solution> {
        let mut matrix = self.matrix;
        for row in 0..self.right.len() {
            for column in *matrix.first.get(row)?..=row {
                let multiplications = matrix.factor_entry(row, column)?;
                budget.spend(multiplications + ENTRY_WORK).await;
            }
        }
        let factor = Factor { matrix };
        let values = factor.solve(self.right, budget).await?;
        Some(Solution { values, factor })
    }
}

impl Factor {
    /// The solution for a right side.
    pub(super) async fn solve(&self, right: Vec<f64>, budget: &mut StepBudget) -> Option<Vec<f64>> {
        let mut values = right;
        for row in 0..values.len() {
            let length = self.substitute_forward(row, &mut values)?;
            budget.spend(length + ENTRY_WORK).await;
        }
        for row in (0..values.len()).rev() {
            let length = self.substitute_back(row, &mut values)?;
            budget.spend(length + ENTRY_WORK).await;
        }
        Some(values)
    }

    /// Standard deviation of the last unknown if weights are inverse variances. All other unknowns are marginalized.
    pub(super) fn last_sigma(&self) -> f64 {
        let last = self.matrix.values.last();
        last.map_or(f64::INFINITY, |last| 1.0 / last)
    }

    /// One row of the forward substitution. Returns the number of multiplications.
    fn substitute_forward(&self, row: usize, values: &mut [f64]) -> Option<usize> {
        let first = *self.matrix.first.get(row)?;
        let (diagonal, before) = self.matrix.row(row).split_last()?;
        let known = values.get(first..)?.get(..before.len())?;
        let value = (values.get(row)? - self.matrix.dot(before, known)) / diagonal;
        *values.get_mut(row)? = value;
        Some(before.len())
    }

    /// One row of the back substitution.
    fn substitute_back(&self, row: usize, values: &mut [f64]) -> Option<usize> {
        let first = *self.matrix.first.get(row)?;
        let (diagonal, before) = self.matrix.row(row).split_last()?;
        let value = values.get(row)? / diagonal;
        *values.get_mut(row)? = value;
        for (factor, left) in before.iter().zip(values.get_mut(first..)?) {
            *left -= factor * value;
        }
        Some(before.len())
    }
}

fn interleaved_dot(one: &[f64], other: &[f64]) -> f64 {
    let (ones, others) = (one.chunks_exact(4), other.chunks_exact(4));
    let rest: f64 = ones
        .remainder()
        .iter()
        .zip(others.remainder())
        .map(|(one, other)| one * other)
        .sum();
    let mut sums = [0.0; 4];
    for (one, other) in ones.zip(others) {
        for ((sum, one), other) in sums.iter_mut().zip(one).zip(other) {
            *sum += one * other;
        }
    }
    rest + (sums[0] + sums[1]) + (sums[2] + sums[3])
}

#[cfg(test)]
mod tests {
    use super::{Solution, Summation, System};
    use crate::model::gradual::{Gradual, StepBudget, at_once};
    use crate::model::random::Random;
    use core::task::Poll;

    fn solved(system: System) -> Option<Solution> {
        at_once(system.solve(&mut StepBudget::unlimited()))
    }

    /// The solution in steps of so much work, and the number of steps.
    fn solved_in_steps(system: System, step: usize) -> (Option<Solution>, u32) {
        let mut solving = Gradual::new(async move { system.solve(&mut StepBudget::of(step)).await });
        let mut steps = 1;
        loop {
            match solving.go_on() {
                Poll::Ready(found) => return (found, steps),
                Poll::Pending => steps += 1,
            }
        }
    }

    #[test]
    fn the_solution_minimizes_the_residuals() {
        minimizes_the_residuals(Summation::InOrder);
        minimizes_the_residuals(Summation::Interleaved);
    }

    fn minimizes_the_residuals(summation: Summation) {
        let mut random = Random::new(7);
        let count = 30;
        // A chain, and every fifth unknown observed by all before it.
        let first = (0..count).map(|row| if row % 5 == 4 { 0 } else { usize::max(row, 2) - 2 });
        let mut system = System::new(first.collect(), summation);
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
        let (in_steps, steps) = solved_in_steps(system.clone(), 40);
        assert!(steps > 30, "{steps} steps");
        let found = solved(system).unwrap().values;
        assert_eq!(in_steps.unwrap().values, found, "steps change nothing");
        for (found, truth) in found.iter().zip(&truth) {
            assert!((found - truth).abs() < 1e-9, "{found} instead of {truth}");
        }
    }

    #[test]
    fn the_deviation_of_the_last_unknown_is_marginal() {
        let mut system = System::new(vec![0, 0], Summation::Interleaved);
        system.add_residual(&[(0, 1.0)], -3.0, 1.0 / 16.0);
        system.add_residual(&[(0, -1.0), (1, 1.0)], -2.0, 1.0 / 9.0);
        let found = solved(system).unwrap();
        assert!((found.values[1] - 5.0).abs() < 1e-9, "{found:?}");
        assert!((found.factor.last_sigma() - 5.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn an_underdetermined_system_has_no_solution() {
        let mut system = System::new(vec![0, 0], Summation::Interleaved);
        system.add_residual(&[(0, 1.0), (1, 1.0)], 1.0, 1.0);
        assert!(solved(system).is_none());
        let mut system = System::new(vec![0], Summation::Interleaved);
        system.add_residual(&[(0, f64::NAN)], 1.0, 1.0);
        assert!(solved(system).is_none());
    }

    #[test]
    fn a_chain_with_a_common_unknown_is_solved() {
        // Ten unknowns in a chain, each 1 more than the one before plus the last unknown, which is 0.5.
        let first = (0..11_usize).map(|row| if row == 10 { 0 } else { row.saturating_sub(1) });
        let mut system = System::new(first.collect(), Summation::InOrder);
        system.add_residual(&[(0, 1.0)], 0.0, 1.0);
        for row in 1..10 {
            system.add_residual(&[(row, 1.0), (row - 1, -1.0), (10, -1.0)], -1.0, 1.0);
        }
        system.add_residual(&[(9, 1.0)], -13.5, 1.0);
        let Solution { values, factor } = solved(system).unwrap();
        assert!((values[10] - 0.5).abs() < 1e-9, "{values:?}");
        assert!((values[4] - 6.0).abs() < 1e-9, "{values:?}");
        let mut unit = vec![0.0; 11];
        unit[10] = 1.0;
        let column = at_once(factor.solve(unit, &mut StepBudget::unlimited())).unwrap();
        assert!(column[10] > 0.0, "a variance");
    }
}
