//! Stretches: where a lane can lie at all.

use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::{Axis, Ground};

/// Work of looking at a cell.
const LOOK_WORK: usize = 1;

/// Free cells one after the other on a line: all lanes lie on one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) axis: Axis,
    /// Row of a stretch along x, column of one along y.
    pub(super) line: usize,
    /// First place along the line.
    pub(super) first: usize,
    /// Last place along the line.
    pub(super) last: usize,
    /// Counts how often its best lane was looked for because it gained something.
    pub(super) version: u32,
    /// Its floor changed since its best lane was looked for.
    pub(super) is_changed: bool,
}

impl Stretch {
    /// Cells of it.
    pub(super) const fn places(&self) -> usize {
        self.last + 1 - self.first
    }
}

/// All stretches, those of a line side by side.
#[derive(Clone, Debug)]
pub(super) struct Stretches {
    pub(super) all: Vec<Stretch>,
    /// For each axis the number of the first stretch of each line, and that after the last one.
    starts: [Vec<usize>; 2],
}

impl Stretches {
    pub(super) async fn of(ground: &Ground, budget: &mut StepBudget) -> Self {
        let mut stretches = Self {
            all: Vec::new(),
            starts: [Vec::new(), Vec::new()],
        };
        for axis in [Axis::X, Axis::Y] {
            for line in 0..ground.length(axis.other()) {
                stretches.starts[axis as usize].push(stretches.all.len());
                stretches.add_line(ground, axis, line);
                budget.spend(LOOK_WORK * ground.length(axis)).await;
            }
            stretches.starts[axis as usize].push(stretches.all.len());
        }
        stretches
    }

    fn add_line(&mut self, ground: &Ground, axis: Axis, line: usize) {
        let mut first = None;
        for along in 0..ground.length(axis) {
            let index = match axis {
                Axis::X => line * ground.width + along,
                Axis::Y => along * ground.width + line,
            };
            match (ground.free[index], first) {
                (true, None) => first = Some(along),
                (false, Some(start)) => {
                    self.all.push(Stretch {
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

    /// Numbers of the stretches on a line.
    pub(super) fn on(&self, axis: Axis, line: usize) -> core::ops::Range<usize> {
        let starts = &self.starts[axis as usize];
        match (starts.get(line), starts.get(line + 1)) {
            (Some(first), Some(end)) => *first..*end,
            _ => 0..0,
        }
    }
}
