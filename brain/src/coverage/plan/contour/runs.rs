//! Which parts of a ring are worth driving.

use super::rings::Ring;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::Ground;

/// Least share of what a ring sweeps over wholly open floor that makes it worth driving: as that of a lane of the first round.
const WORTH_PERCENT: usize = 35;
/// Work of looking at the floor around a cell.
const COUNT_WORK: usize = 40;

/// A part of a ring.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) level: usize,
    pub(super) cells: Vec<usize>,
    /// It can be entered anywhere: its last cell lies beside its first.
    pub(super) is_closed: bool,
}

/// Weighs cells by the floor that is open around them, and closes it.
pub(super) struct Sweeper {
    pub(super) open: Vec<bool>,
    disc: Vec<(isize, usize)>,
    width: usize,
    /// Cells across a swath.
    swath: usize,
    /// Open cells around a cell from which on a run begins there.
    begin: usize,
}

impl Sweeper {
    pub(super) fn new(ground: &Ground) -> Self {
        let disc = ground.disc();
        let cells: usize = disc.iter().map(|(_, half)| 2 * half + 1).sum();
        Self {
            open: ground.open.clone(),
            width: ground.width,
            swath: 2 * ground.reach + 1,
            begin: WORTH_PERCENT * cells / 100,
            disc,
        }
    }

    /// The parts of a ring that are worth it.
    pub(super) async fn runs(&self, ring: Ring, budget: &mut StepBudget) -> Vec<Run> {
        let whole = Run {
            level: ring.level,
            cells: ring.cells,
            is_closed: true,
        };
        self.parts(whole, budget).await
    }

    /// The parts of a run that are still worth it: that run itself, shorter ones or none. Gaps of less than a swath are
    /// driven through; what is shorter than two is left to lanes.
    pub(super) async fn parts(&self, run: Run, budget: &mut StepBudget) -> Vec<Run> {
        let count = run.cells.len();
        budget.spend(COUNT_WORK * count).await;
        let is_worth: Vec<bool> = run
            .cells
            .iter()
            .map(|cell| self.open_around(*cell) >= self.begin)
            .collect();
        let Some(first) = is_worth
            .iter()
            .position(|worth| *worth)
            .filter(|_| count >= 2 * self.swath)
        else {
            return Vec::new();
        };
        // From one cell that is worth it; a closed run comes back to it.
        let mut spans: Vec<(usize, usize)> = Vec::new();
        for place in (first..first + count).filter(|place| is_worth[place % count]) {
            if place >= count && !run.is_closed {
                break;
            }
            match spans.last_mut() {
                Some((_, last)) if place - *last <= self.swath => *last = place,
                _ => spans.push((place, place)),
            }
        }
        if run.is_closed {
            self.close_up(&mut spans, (first, count));
        }
        if run.is_closed && spans == [(first, first + count)] {
            return vec![run];
        }
        spans
            .into_iter()
            .filter(|(from, to)| to - from + 1 >= 2 * self.swath)
            .map(|(from, to)| Run {
                level: run.level,
                cells: (from..=to).map(|place| run.cells[place % count]).collect(),
                is_closed: false,
            })
            .collect()
    }

    /// Joins the last part with the first one where the gap between them is small: one turn later is the same place.
    fn close_up(&self, spans: &mut Vec<(usize, usize)>, (first, count): (usize, usize)) {
        let Some((_, last)) = spans
            .last()
            .copied()
            .filter(|(_, last)| first + count - last <= self.swath)
        else {
            return;
        };
        if let [only] = spans.as_mut_slice() {
            *only = (first, first + count);
        } else {
            let (_, end) = spans.remove(0);
            if let Some(joined) = spans.last_mut() {
                debug_assert_eq!(joined.1, last);
                joined.1 = end + count;
            }
        }
    }

    /// Drives along a run and closes what that sweeps. Gives how many of its cells are driven: it ends where more than a
    /// swath's length would bring next to nothing.
    pub(super) async fn sweep(&mut self, run: &Run, budget: &mut StepBudget) -> usize {
        let (mut driven, mut vain) = (0, 0_usize);
        for (place, cell) in run.cells.iter().enumerate() {
            let worth = WORTH_PERCENT * self.swath * (vain + 1).min(self.swath) / 100;
            if self.open_around(*cell) >= worth.max(1) {
                for cell in &run.cells[driven..=place] {
                    self.close_around(*cell);
                }
                (driven, vain) = (place + 1, 0);
            } else {
                vain += 1;
            }
            if vain > self.swath {
                break;
            }
            budget.spend(2 * COUNT_WORK).await;
        }
        driven
    }

    fn open_around(&self, index: usize) -> usize {
        let row = |(rows, half): &(isize, usize)| {
            let centre = self.shifted(index, *rows);
            let cells = &self.open[centre - half..=centre + half];
            cells.iter().filter(|open| **open).count()
        };
        self.disc.iter().map(row).sum()
    }

    fn close_around(&mut self, index: usize) {
        for place in 0..self.disc.len() {
            let (rows, half) = self.disc[place];
            let centre = self.shifted(index, rows);
            self.open[centre - half..=centre + half].fill(false);
        }
    }

    fn shifted(&self, index: usize, rows: isize) -> usize {
        index.wrapping_add_signed(rows * self.width as isize)
    }
}
