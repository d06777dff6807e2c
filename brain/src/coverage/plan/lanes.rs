//! Which lanes are worth driving.
//!
//! Lanes are taken one after the other, each time the one with the best gain for its time. Gain counts swept cells, and
//! also how much shorter the border of the open floor becomes: a lane along a wall or along another lane leaves a simpler
//! rest than one through the middle, and narrow strips that no lane would pay for are not left behind.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::bit_grid::BitGrid;
use super::settings::PlanSettings;
use super::stretches::{Stretch, Stretches};
use crate::mapping::CELL_M;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::{Axis, Ground};

/// Cells that one edge less of border is worth.
const BORDER_CELLS: i16 = 1;
/// Least share of what a lane over wholly open floor gains in the same time, for each round.
const ROUND_SHARES: [f64; 2] = [0.35, 0.07];
/// What it costs to enter and leave a lane, in radians of turning: added to a lane's time. Besides the turns themselves it
/// stands for the braking and for the way between lanes.
const ENTER_RAD: f64 = 6.0;
/// Work of weighing a place, of looking at it for the best lane, and of closing the floor around it.
const WEIGH_WORK: usize = 3;
const LOOK_WORK: usize = 2;
const CLOSE_WORK: usize = 80;

/// A straight piece of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lane {
    /// Index of the free cell at one end.
    pub(super) from: usize,
    /// Index of the free cell at the other end.
    pub(super) to: usize,
    /// Cells of open floor that it sweeps when lanes are driven in the order in which they were chosen.
    pub(super) swept: usize,
}

/// Chooses lanes and closes the floor that they sweep.
pub(super) struct Picker<'ground> {
    ground: &'ground mut Ground,
    bits: [BitGrid; 2],
    window: Window,
    /// What sweeping each place of a lane gains, in cells; the places along a line lie side by side.
    gains: [Vec<i16>; 2],
    stretches: Stretches,
    queue: BinaryHeap<Candidate>,
    cell_s: f64,
    enter_s: f64,
    disc: Vec<(isize, usize)>,
}

/// The best lane of one stretch.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Gain for each second.
    rate: f64,
    stretch: usize,
    /// First and last place along the line.
    span: (usize, usize),
    version: u32,
}

impl<'ground> Picker<'ground> {
    pub(super) async fn new(
        ground: &'ground mut Ground,
        settings: &PlanSettings,
        budget: &mut StepBudget,
    ) -> Self {
        let cells = ground.free.len();
        let mut picker = Self {
            bits: [
                BitGrid::of_open(ground, Axis::X, budget).await,
                BitGrid::of_open(ground, Axis::Y, budget).await,
            ],
            window: Window::new(ground.reach),
            gains: [vec![0; cells], vec![0; cells]],
            stretches: Stretches::of(ground, budget).await,
            queue: BinaryHeap::new(),
            cell_s: CELL_M / settings.cruise_m_per_s,
            enter_s: ENTER_RAD / settings.turn_rad_per_s,
            disc: ground.disc(),
            ground,
        };
        for number in 0..picker.stretches.all.len() {
            let stretch = picker.stretches.all[number];
            picker.weigh(stretch.axis, stretch.line, (stretch.first, stretch.last));
            budget.spend(WEIGH_WORK * stretch.places()).await;
        }
        picker
    }

    /// The lanes of each round.
    pub(super) async fn rounds(&mut self, budget: &mut StepBudget) -> Vec<Vec<Lane>> {
        let mut rounds = Vec::with_capacity(ROUND_SHARES.len());
        for share in ROUND_SHARES {
            rounds.push(self.round(share, budget).await);
        }
        rounds
    }

    async fn round(&mut self, share: f64, budget: &mut StepBudget) -> Vec<Lane> {
        let full = (2 * self.ground.reach + 1) as f64 / self.cell_s;
        let least = share * full;
        self.queue.clear();
        for number in 0..self.stretches.all.len() {
            self.offer(number, least);
            budget
                .spend(LOOK_WORK * self.stretches.all[number].places())
                .await;
        }
        let mut lanes = Vec::new();
        while let Some(candidate) = self.next(least, budget).await {
            let stretch = self.stretches.all[candidate.stretch];
            lanes.push(self.take(&stretch, candidate.span, budget).await);
            self.refresh(&stretch, candidate.span, (least, &mut *budget))
                .await;
        }
        lanes
    }

    /// The best candidate whose figures are of now.
    async fn next(&mut self, least: f64, budget: &mut StepBudget) -> Option<Candidate> {
        while let Some(old) = self.queue.pop() {
            let stretch = &mut self.stretches.all[old.stretch];
            if old.version != stretch.version {
                continue;
            }
            if !stretch.is_changed {
                return Some(old);
            }
            stretch.is_changed = false;
            budget.spend(LOOK_WORK * stretch.places()).await;
            let Some(now) = self.best_of(old.stretch, least) else {
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
    async fn take(
        &mut self,
        stretch: &Stretch,
        (first, last): (usize, usize),
        budget: &mut StepBudget,
    ) -> Lane {
        let index = |along: usize| match stretch.axis {
            Axis::X => stretch.line * self.ground.width + along,
            Axis::Y => along * self.ground.width + stretch.line,
        };
        let (from, to, step) = (index(first), index(last), index(1) - index(0));
        let mut swept = 0;
        for index in (from..=to).step_by(step) {
            swept += self.close_disc(index);
            budget.spend(CLOSE_WORK).await;
        }
        Lane { from, to, swept }
    }

    /// Closes the floor around a place; gives how many cells were open.
    fn close_disc(&mut self, index: usize) -> usize {
        let mut closed = 0;
        for position in 0..self.disc.len() {
            let (row, half) = self.disc[position];
            let centre = self.ground.shifted(index, row);
            for cell in centre - half..=centre + half {
                if self.ground.open[cell] {
                    self.ground.open[cell] = false;
                    closed += 1;
                    let (column, row) = self.ground.place(cell);
                    self.bits[Axis::X as usize].clear(column, row);
                    self.bits[Axis::Y as usize].clear(row, column);
                }
            }
        }
        closed
    }

    /// Weighs all places anew whose surroundings a lane has changed. Offers the stretches again that gained by it, which lie
    /// beside it and beyond its ends; those that lost are found out when their turn comes.
    async fn refresh(
        &mut self,
        taken: &Stretch,
        (first, last): (usize, usize),
        (least, budget): (f64, &mut StepBudget),
    ) {
        let reach = self.ground.reach;
        let around = 2 * reach + 2;
        let (low, high) = (first.saturating_sub(around), last + around);
        for line in taken.line.saturating_sub(around)..=taken.line + around {
            let work = self.renew((taken.axis, line), (low, high), Some(least));
            budget.spend(work).await;
        }
        let span = (taken.line.saturating_sub(around), taken.line + around);
        for line in low..=high {
            let is_beyond = line < first || line > last;
            let work = self.renew((taken.axis.other(), line), span, is_beyond.then_some(least));
            budget.spend(work).await;
        }
    }

    /// Weighs a part of a line anew and offers its stretches again, or notes that they changed. Gives how much work it was.
    fn renew(
        &mut self,
        (axis, line): (Axis, usize),
        (low, high): (usize, usize),
        offer: Option<f64>,
    ) -> usize {
        let mut work = 0;
        for number in self.stretches.on(axis, line) {
            let stretch = self.stretches.all[number];
            if stretch.last < low || stretch.first > high {
                continue;
            }
            let span = (stretch.first.max(low), stretch.last.min(high));
            self.weigh(axis, line, span);
            work += WEIGH_WORK * (span.1 + 1 - span.0);
            match offer {
                Some(least) => {
                    self.offer(number, least);
                    work += LOOK_WORK * stretch.places();
                }
                None => self.stretches.all[number].is_changed = true,
            }
        }
        work
    }

    /// Finds what the places of a line gain.
    fn weigh(&mut self, axis: Axis, line: usize, (first, last): (usize, usize)) {
        let bits = &self.bits[axis as usize];
        let low = line - self.ground.reach - 1;
        let start = line * self.ground.length(axis);
        let mut ahead = bits.window(first, low);
        for along in first..=last {
            let here = ahead;
            ahead = bits.window(along + 1, low);
            self.gains[axis as usize][start + along] = self.window.gain(here, ahead);
        }
    }

    fn offer(&mut self, number: usize, least: f64) {
        let stretch = &mut self.stretches.all[number];
        stretch.version += 1;
        stretch.is_changed = false;
        if let Some(candidate) = self.best_of(number, least) {
            self.queue.push(candidate);
        }
    }

    /// The lane of a stretch with most gain beyond `least` for each second.
    fn best_of(&self, number: usize, least: f64) -> Option<Candidate> {
        let stretch = &self.stretches.all[number];
        let start = stretch.line * self.ground.length(stretch.axis);
        let cost = least * self.cell_s;
        let (mut most, mut best) = (least * self.enter_s, None);
        let (mut profit, mut gain, mut first) = (0.0, 0, stretch.first);
        let gains = &self.gains[stretch.axis as usize][start + stretch.first..=start + stretch.last];
        for (along, more) in (stretch.first..).zip(gains) {
            gain += i32::from(*more);
            profit += f64::from(*more) - cost;
            if profit <= 0.0 {
                (profit, gain, first) = (0.0, 0, along + 1);
            } else if profit > most {
                most = profit;
                best = Some((gain, (first, along)));
            }
        }
        let (gain, span) = best?;
        let cells = (span.1 - span.0 + 1) as f64;
        Some(Candidate {
            rate: f64::from(gain) / (cells * self.cell_s + self.enter_s),
            stretch: number,
            span,
            version: stretch.version,
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
    fn gain(&self, here: u64, ahead: u64) -> i16 {
        let swept = (here & self.swath).count_ones();
        if swept == 0 {
            return 0;
        }
        let gone =
            ((here ^ here >> 1) & self.pairs).count_ones() + ((here ^ ahead) & self.swath).count_ones();
        let new = (here & self.sides).count_ones();
        // At most a few hundred cells: a window has 64.
        swept as i16 + BORDER_CELLS * (gone as i16 - new as i16)
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
            .then_with(|| other.stretch.cmp(&self.stretch))
            .then_with(|| self.version.cmp(&other.version))
    }
}
