//! Free strips: where lanes can lie.

use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::{Axis, ConfigurationSpace};

/// Work to read a cell.
const READ_WORK: usize = 1;

/// Consecutive free cells on a line. Every lane lies within one.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeStrip {
    pub(super) axis: Axis,
    /// Row of a strip along x, column of one along y.
    pub(super) line: usize,
    /// First position along the line.
    pub(super) first: usize,
    /// Last position along the line.
    pub(super) last: usize,
    /// Counts the searches for its best lane after its gain grew.
    pub(super) version: u32,
    /// Its floor changed since the last search for its best lane.
    pub(super) is_changed: bool,
}

impl FreeStrip {
    /// Its number of cells.
    pub(super) const fn places(&self) -> usize {
        self.last + 1 - self.first
    }
}

/// All strips, grouped by line.
#[derive(Clone, Debug)]
pub(super) struct FreeStrips {
    pub(super) all: Vec<FreeStrip>,
    /// For each axis the index of the first strip of each line, and one past the last strip.
    starts: [Vec<usize>; 2],
}

impl FreeStrips {
    pub(super) async fn of(space: &ConfigurationSpace, budget: &mut StepBudget) -> Self {
        let mut strips = Self {
            all: Vec::new(),
            starts: [Vec::new(), Vec::new()],
        };
        for axis in [Axis::X, Axis::Y] {
            for line in 0..space.length(axis.other()) {
                strips.starts[axis as usize].push(strips.all.len());
                strips.add_line(space, axis, line);
                budget.spend(READ_WORK * space.length(axis)).await;
            }
            strips.starts[axis as usize].push(strips.all.len());
        }
        strips
    }

    fn add_line(&mut self, space: &ConfigurationSpace, axis: Axis, line: usize) {
        let mut first = None;
        for along in 0..space.length(axis) {
            let index = match axis {
                Axis::X => line * space.width + along,
                Axis::Y => along * space.width + line,
            };
            match (space.free[index], first) {
                (true, None) => first = Some(along),
                (false, Some(start)) => {
                    self.all.push(FreeStrip {
                        axis,
                        line,
                        first: start,
                        last: along - 1,
                        version: 0,
                        is_changed: false,
                    });
                    first = None;
                }
                _ => {}
            }
        }
    }

    /// Indices of the strips on a line.
    pub(super) fn on(&self, axis: Axis, line: usize) -> core::ops::Range<usize> {
        let starts = &self.starts[axis as usize];
        match (starts.get(line), starts.get(line + 1)) {
            (Some(first), Some(end)) => *first..*end,
            _ => 0..0,
        }
    }
}
