//! Which parts of a ring are worth driving.

use super::rings::Ring;
use crate::coverage::plan::parameters::RINGS;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::ConfigurationSpace;

/// Work to count the open floor around a cell.
const COUNT_WORK: usize = 40;

/// A part of a ring.
#[derive(Clone, Debug)]
pub(super) struct RingSection {
    pub(super) level: usize,
    pub(super) cells: Vec<usize>,
    /// It can be entered anywhere: its last cell is adjacent to its first.
    pub(super) is_closed: bool,
}

/// Counts the open floor around cells, and closes it.
pub(super) struct Sweeper {
    pub(super) open: Vec<bool>,
    disc: Vec<(isize, usize)>,
    width: usize,
    /// Cells across a swath.
    swath: usize,
    /// Open cells around a cell that make a section begin there.
    begin: usize,
}

impl Sweeper {
    pub(super) fn new(space: &ConfigurationSpace) -> Self {
        let disc = space.disc();
        let cells: usize = disc.iter().map(|(_, half)| 2 * half + 1).sum();
        Self {
            open: space.open.clone(),
            width: space.width,
            swath: 2 * space.reach + 1,
            begin: RINGS.worth_percent * cells / 100,
            disc,
        }
    }

    /// The parts of a ring that are worth driving.
    pub(super) async fn sections(&self, ring: Ring, budget: &mut StepBudget) -> Vec<RingSection> {
        let whole = RingSection {
            level: ring.level,
            cells: ring.cells,
            is_closed: true,
        };
        self.parts(whole, budget).await
    }

    /// The parts of a section that are still worth driving: the whole section, shorter ones or none. Gaps of less than a
    /// swath are driven through. Parts shorter than two swaths are left to lanes.
    pub(super) async fn parts(&self, section: RingSection, budget: &mut StepBudget) -> Vec<RingSection> {
        let count = section.cells.len();
        budget.spend(COUNT_WORK * count).await;
        let is_worth: Vec<bool> = section
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
        // Starts at a cell that is worth driving; a closed section returns to it.
        let mut spans: Vec<(usize, usize)> = Vec::new();
        for place in (first..first + count).filter(|place| is_worth[place % count]) {
            if place >= count && !section.is_closed {
                break;
            }
            match spans.last_mut() {
                Some((_, last)) if place - *last <= self.swath => *last = place,
                _ => spans.push((place, place)),
            }
        }
        if section.is_closed {
            self.close_up(&mut spans, first, count);
        }
        if section.is_closed && spans == [(first, first + count)] {
            return vec![section];
        }
        spans
            .into_iter()
            .filter(|(from, to)| to - from + 1 >= 2 * self.swath)
            .map(|(from, to)| RingSection {
                level: section.level,
                cells: (from..=to).map(|place| section.cells[place % count]).collect(),
                is_closed: false,
            })
            .collect()
    }

    /// Joins the last part with the first one where the gap between them is small: indices wrap round a closed section.
    fn close_up(&self, spans: &mut Vec<(usize, usize)>, first: usize, count: usize) {
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

    /// Drives along a section and closes the floor that it sweeps. Gives how many of its cells are driven. It ends where
    /// more than a swath's length would sweep next to nothing.
    pub(super) async fn sweep(&mut self, section: &RingSection, budget: &mut StepBudget) -> usize {
        let (mut driven, mut unproductive) = (0, 0_usize);
        for (place, cell) in section.cells.iter().enumerate() {
            let worth = RINGS.worth_percent * self.swath * (unproductive + 1).min(self.swath) / 100;
            if self.open_around(*cell) >= worth.max(1) {
                for cell in &section.cells[driven..=place] {
                    self.close_around(*cell);
                }
                (driven, unproductive) = (place + 1, 0);
            } else {
                unproductive += 1;
            }
            if unproductive > self.swath {
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
