//! Which lanes are worth driving.
//!
//! Lanes are taken one after the other, each time the one with the best gain for its time. Gain counts swept cells, and
//! also how much shorter the border of the open floor becomes: a lane along a wall or along another lane leaves a simpler
//! rest than one through the middle, and narrow strips that no lane would pay for are not left behind.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::PlanSettings;
use super::bits::BitGrid;
use super::ground::{Axis, Ground};
use crate::mapping::CELL_M;

/// Cells that one edge less of border is worth.
const BORDER_CELLS: f64 = 2.0;
/// Least share of what a lane over wholly open floor gains in the same time, for each round.
const ROUND_SHARES: [f64; 2] = [0.35, 0.12];
/// Turning to enter and leave a lane, in radians: added to a lane's time.
const ENTER_RAD: f64 = 4.0;

/// A straight piece of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lane {
    /// Index of the free cell at one end.
    pub(super) from: usize,
    /// Index of the free cell at the other end.
    pub(super) to: usize,
}

/// Chooses lanes and closes the floor that they sweep.
pub(super) struct Picker<'ground> {
    ground: &'ground mut Ground,
    bits: [BitGrid; 2],
    versions: [Vec<u32>; 2],
    queue: BinaryHeap<Candidate>,
    cell_s: f64,
    enter_s: f64,
    disc: Vec<(isize, usize)>,
}

/// The best lane of one line.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Gain for each second.
    rate: f64,
    axis: Axis,
    /// Row of lanes along x, column of lanes along y.
    line: usize,
    /// First and last place along the line.
    span: (usize, usize),
    version: u32,
}

impl<'ground> Picker<'ground> {
    pub(super) fn new(ground: &'ground mut Ground, settings: &PlanSettings) -> Self {
        Self {
            bits: [
                BitGrid::of_open(ground, Axis::X),
                BitGrid::of_open(ground, Axis::Y),
            ],
            versions: [vec![0; ground.height], vec![0; ground.width]],
            queue: BinaryHeap::new(),
            cell_s: CELL_M / settings.cruise_m_per_s,
            enter_s: ENTER_RAD / settings.turn_rad_per_s,
            disc: ground.disc(),
            ground,
        }
    }

    /// The lanes of each round.
    pub(super) fn rounds(&mut self) -> Vec<Vec<Lane>> {
        ROUND_SHARES.iter().map(|share| self.round(*share)).collect()
    }

    fn round(&mut self, share: f64) -> Vec<Lane> {
        let full = (2 * self.ground.reach + 1) as f64 / self.cell_s;
        let least = share * full;
        self.queue.clear();
        let margin = self.ground.reach + 2;
        for line in margin..self.ground.height - margin {
            self.offer(Axis::X, line, least);
        }
        for line in margin..self.ground.width - margin {
            self.offer(Axis::Y, line, least);
        }
        let mut lanes = Vec::new();
        while let Some(candidate) = self.next(least) {
            lanes.push(self.take(candidate));
            self.refresh(candidate, least);
        }
        lanes
    }

    /// The best candidate whose figures are of now.
    fn next(&mut self, least: f64) -> Option<Candidate> {
        while let Some(old) = self.queue.pop() {
            if old.version != self.versions[old.axis as usize][old.line] {
                continue;
            }
            let Some(now) = self.best_of(old.axis, old.line, least) else {
                continue;
            };
            if self.queue.peek().is_none_or(|second| second.rate <= now.rate) {
                return Some(now);
            }
            self.queue.push(now);
        }
        None
    }

    /// Closes the floor that a lane sweeps.
    fn take(&mut self, candidate: Candidate) -> Lane {
        let (first, last) = candidate.span;
        let index = |along: usize| match candidate.axis {
            Axis::X => candidate.line * self.ground.width + along,
            Axis::Y => along * self.ground.width + candidate.line,
        };
        let (from, to) = (index(first), index(last));
        for along in first..=last {
            self.close_disc(match candidate.axis {
                Axis::X => candidate.line * self.ground.width + along,
                Axis::Y => along * self.ground.width + candidate.line,
            });
        }
        Lane { from, to }
    }

    fn close_disc(&mut self, index: usize) {
        for position in 0..self.disc.len() {
            let (row, half) = self.disc[position];
            let centre = self.ground.shifted(index, row);
            for cell in centre - half..=centre + half {
                if self.ground.open[cell] {
                    self.ground.open[cell] = false;
                    let (column, row) = self.ground.place(cell);
                    self.bits[Axis::X as usize].clear(column, row);
                    self.bits[Axis::Y as usize].clear(row, column);
                }
            }
        }
    }

    /// Offers the lanes again that gained by a lane beside them; those that lost are found out when their turn comes.
    fn refresh(&mut self, taken: Candidate, least: f64) {
        let reach = self.ground.reach;
        let lines = self.versions[taken.axis as usize].len();
        self.offer(taken.axis, taken.line, least);
        for away in reach + 1..=2 * reach + 2 {
            if taken.line >= away + reach + 2 {
                self.offer(taken.axis, taken.line - away, least);
            }
            if taken.line + away + reach + 2 < lines {
                self.offer(taken.axis, taken.line + away, least);
            }
        }
    }

    fn offer(&mut self, axis: Axis, line: usize, least: f64) {
        self.versions[axis as usize][line] += 1;
        if let Some(candidate) = self.best_of(axis, line, least) {
            self.queue.push(candidate);
        }
    }

    /// The lane of a line with most gain beyond `least` for each second.
    fn best_of(&self, axis: Axis, line: usize, least: f64) -> Option<Candidate> {
        let bits = &self.bits[axis as usize];
        let window = Window::new(self.ground.reach);
        let (length, start, step) = match axis {
            Axis::X => (self.ground.width, line * self.ground.width, 1),
            Axis::Y => (self.ground.height, line, self.ground.width),
        };
        let low = line - self.ground.reach - 1;
        let mut best: Option<(f64, f64, (usize, usize))> = None;
        let (mut profit, mut gain, mut first) = (0.0, 0.0, 0);
        let mut ahead = bits.window(0, low);
        for along in 0..length - 1 {
            let here = ahead;
            ahead = bits.window(along + 1, low);
            if !self.ground.free[start + along * step] {
                (profit, gain, first) = (0.0, 0.0, along + 1);
                continue;
            }
            let more = window.gain(here, ahead);
            gain += more;
            profit += more - least * self.cell_s;
            if profit <= 0.0 {
                (profit, gain, first) = (0.0, 0.0, along + 1);
            } else if best.is_none_or(|(most, _, _)| profit > most) {
                best = Some((profit, gain, (first, along)));
            }
        }
        let (profit, gain, span) = best?;
        let cells = (span.1 - span.0 + 1) as f64;
        (profit > least * self.enter_s).then(|| Candidate {
            rate: gain / (cells * self.cell_s + self.enter_s),
            axis,
            line,
            span,
            version: self.versions[axis as usize][line],
        })
    }
}

/// Masks for the cells across a lane; bit 0 lies just beside the swath.
struct Window {
    swath: u64,
    pairs: u64,
    sides: u64,
}

impl Window {
    fn new(reach: usize) -> Self {
        let swath = ((1_u64 << (2 * reach + 1)) - 1) << 1;
        Self {
            swath,
            pairs: (1 << (2 * reach + 2)) - 1,
            sides: 1 | 1 << (2 * reach + 2),
        }
    }

    /// What sweeping one place of a lane gains in cells.
    fn gain(&self, here: u64, ahead: u64) -> f64 {
        let swept = (here & self.swath).count_ones();
        if swept == 0 {
            return 0.0;
        }
        let gone =
            ((here ^ here >> 1) & self.pairs).count_ones() + ((here ^ ahead) & self.swath).count_ones();
        let new = (here & self.sides).count_ones();
        f64::from(swept) + BORDER_CELLS * (f64::from(gone) - f64::from(new))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rate
            .total_cmp(&other.rate)
            .then_with(|| other.line.cmp(&self.line))
            .then_with(|| (other.axis as u8).cmp(&(self.axis as u8)))
            .then_with(|| self.version.cmp(&other.version))
    }
}
