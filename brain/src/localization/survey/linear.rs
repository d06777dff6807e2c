//! A symmetric positive system of equations whose rows begin late: a chain of poses and, below it, the things that many
//! of them saw. Cholesky's factor of such a matrix begins no earlier in any row (skyline storage).

use core::task::Poll;

use super::work::Work;

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

    /// Begins to solve it.
    pub(super) fn solve(self) -> Solving {
        Solving {
            stage: Stage::Factor { column: None },
            row: 0,
            system: self,
        }
    }

    /// Makes entries of a row of the factor from `column` on, `None` = from its first. Gives the column of the next one; none
    /// is left when that is beyond the row.
    fn factor_row(&mut self, row: usize, column: Option<usize>, work: &mut Work) -> Option<usize> {
        let first = *self.first.get(row)?;
        let start = *self.start.get(row)?;
        for column in column.unwrap_or(first)..=row {
            if !work.is_left() {
                return Some(column);
            }
            let their_first = *self.first.get(column)?;
            let from = first.max(their_first);
            let length = column.saturating_sub(from);
            let own = self.values.get(start + from - first..)?.get(..length)?;
            let theirs = self.row(column).get(from - their_first..)?.get(..length)?;
            let place = start + column - first;
            let left = *self.values.get(place)? - dot(own, theirs);
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
            work.spend(length + ENTRY_WORK);
        }
        Some(row + 1)
    }

    /// One row of the way from the first unknown to the last.
    fn substitute_forward(&mut self, row: usize, work: &mut Work) -> Option<()> {
        let first = *self.first.get(row)?;
        let (diagonal, before) = self.row(row).split_last()?;
        let known = self.right.get(first..)?.get(..before.len())?;
        let value = (self.right.get(row)? - dot(before, known)) / diagonal;
        work.spend(before.len() + ENTRY_WORK);
        *self.right.get_mut(row)? = value;
        Some(())
    }

    /// One row of the way back.
    fn substitute_back(&mut self, row: usize, work: &mut Work) -> Option<()> {
        let first = *self.first.get(row)?;
        let start = *self.start.get(row)?;
        let (diagonal, before) = self.values.get(start..=start + row - first)?.split_last()?;
        let value = self.right.get(row)? / diagonal;
        *self.right.get_mut(row)? = value;
        for (factor, left) in before.iter().zip(self.right.get_mut(first..)?) {
            *left -= factor * value;
        }
        work.spend(before.len() + ENTRY_WORK);
        Some(())
    }
}

/// What an entry takes besides the multiplications.
const ENTRY_WORK: usize = 10;

/// Sum of the products, in four sums side by side: processors wait for one.
fn dot(one: &[f64], other: &[f64]) -> f64 {
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

/// A system that is being solved, piece by piece.
#[derive(Clone, Debug)]
pub(super) struct Solving {
    system: System,
    stage: Stage,
    row: usize,
}

/// What solves a system.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Solution {
    pub(super) values: Vec<f64>,
    /// Standard deviation of the last unknown, if weights are inverse variances: all others are free to follow it.
    pub(super) last_sigma: f64,
}

#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Cholesky's factor; `None` = a row begins.
    Factor {
        column: Option<usize>,
    },
    Forward,
    Back,
}

impl Solving {
    /// Goes on while work is left. Gives the solution, or `None` when the matrix is not positive.
    pub(super) fn go_on(&mut self, work: &mut Work) -> Poll<Option<Solution>> {
        while work.is_left() {
            match self.piece(work) {
                Some(true) => {
                    let last = self.system.values.last();
                    return Poll::Ready(Some(Solution {
                        last_sigma: last.map_or(f64::INFINITY, |last| 1.0 / last),
                        values: core::mem::take(&mut self.system.right),
                    }));
                }
                Some(false) => {}
                None => return Poll::Ready(None),
            }
        }
        Poll::Pending
    }

    /// Does a piece; `true` when it was the last one.
    fn piece(&mut self, work: &mut Work) -> Option<bool> {
        let count = self.system.first.len();
        match self.stage {
            Stage::Factor { .. } if self.row == count => (self.stage, self.row) = (Stage::Forward, 0),
            Stage::Factor { column } => {
                let next = self.system.factor_row(self.row, column, work)?;
                if next > self.row {
                    (self.stage, self.row) = (Stage::Factor { column: None }, self.row + 1);
                } else {
                    self.stage = Stage::Factor { column: Some(next) };
                }
            }
            Stage::Forward if self.row == count => self.stage = Stage::Back,
            Stage::Forward => {
                self.system.substitute_forward(self.row, work)?;
                self.row += 1;
            }
            Stage::Back if self.row == 0 => return Some(true),
            Stage::Back => {
                self.row -= 1;
                self.system.substitute_back(self.row, work)?;
            }
        }
        Some(false)
    }
}

#[cfg(test)]
mod tests {
    use super::{Solution, System, Work};
    use crate::model::random::Random;
    use core::task::Poll;

    /// The solution, made in steps of so much work, and how many steps that took.
    fn solved(system: System, step: usize) -> (Option<Solution>, u32) {
        let mut solving = system.solve();
        let mut steps = 1;
        loop {
            match solving.go_on(&mut Work::of(step)) {
                Poll::Ready(found) => return (found, steps),
                Poll::Pending => steps += 1,
            }
        }
    }

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
        let (in_steps, steps) = solved(system.clone(), 40);
        assert!(steps > 30, "{steps} steps");
        let (found, _) = solved(system, usize::MAX);
        assert_eq!(in_steps, found, "steps change nothing");
        let found = found.unwrap().values;
        for (found, truth) in found.iter().zip(&truth) {
            assert!((found - truth).abs() < 1e-9, "{found} instead of {truth}");
        }
    }

    #[test]
    fn the_last_unknown_is_as_sure_as_all_that_leads_to_it() {
        let mut system = System::new(vec![0, 0]);
        system.add_residual(&[(0, 1.0)], -3.0, 1.0 / 16.0);
        system.add_residual(&[(0, -1.0), (1, 1.0)], -2.0, 1.0 / 9.0);
        let found = solved(system, usize::MAX).0.unwrap();
        assert!((found.values[1] - 5.0).abs() < 1e-9, "{found:?}");
        assert!((found.last_sigma - 5.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn what_is_not_determined_has_no_solution() {
        let mut system = System::new(vec![0, 0]);
        system.add_residual(&[(0, 1.0), (1, 1.0)], 1.0, 1.0);
        assert_eq!(solved(system, 1_000).0, None);
        let mut system = System::new(vec![0]);
        system.add_residual(&[(0, f64::NAN)], 1.0, 1.0);
        assert_eq!(solved(system, 1_000).0, None);
    }
}
