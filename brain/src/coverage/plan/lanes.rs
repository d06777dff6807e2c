//! Which lanes are worth driving.
//!
//! A greedy search takes one lane after another, always the one with the best gain for its time. The gain counts swept
//! cells and how much shorter the border of the open floor becomes. A lane along a wall or along another lane therefore
//! beats one through the middle, and no narrow strips are left behind that no lane would pay for.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::bit_grid::BitGrid;
use super::free_strips::{FreeStrip, FreeStrips};
use super::settings::PlanSettings;
use crate::coverage::plan::parameters::LANES;
use crate::mapping::CELL_M;
use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::{Axis, ConfigurationSpace};

/// Work to weigh a position, to read it for the best lane, and to close the floor around it.
const WEIGH_WORK: usize = 3;
const READ_WORK: usize = 2;
const CLOSE_WORK: usize = 80;

/// A straight part of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lane {
    /// Index of the free cell at one end.
    pub(super) from: usize,
    /// Index of the free cell at the other end.
    pub(super) to: usize,
    /// Cells of open floor that it sweeps when lanes are driven in the order of selection.
    pub(super) swept: usize,
}

/// Selects lanes and closes the floor that they sweep.
pub(super) struct Picker<'space> {
    space: &'space mut ConfigurationSpace,
    bits: [BitGrid; 2],
    masks: GainMasks,
    /// The gain of each position of a lane, in cells; positions along a line are adjacent.
    gains: [Vec<i16>; 2],
    strips: FreeStrips,
    queue: BinaryHeap<LaneCandidate>,
    cell_s: f64,
    enter_s: f64,
    disc: Vec<(isize, usize)>,
}

/// Positions along a line.
#[derive(Clone, Copy, Debug)]
struct Span {
    first: usize,
    last: usize,
}

/// A part of a line.
#[derive(Clone, Copy, Debug)]
struct LinePart {
    axis: Axis,
    /// Row along x, column along y.
    line: usize,
    span: Span,
}

/// The best lane of one strip.
#[derive(Clone, Copy, Debug)]
struct LaneCandidate {
    /// Gain per second.
    rate: f64,
    strip: usize,
    span: Span,
    version: u32,
}

impl<'space> Picker<'space> {
    pub(super) async fn new(
        space: &'space mut ConfigurationSpace,
        settings: &PlanSettings,
        budget: &mut StepBudget,
    ) -> Self {
        let cells = space.free.len();
        let mut picker = Self {
            bits: [
                BitGrid::of_open(space, Axis::X, budget).await,
                BitGrid::of_open(space, Axis::Y, budget).await,
            ],
            masks: GainMasks::new(space.reach),
            gains: [vec![0; cells], vec![0; cells]],
            strips: FreeStrips::of(space, budget).await,
            queue: BinaryHeap::new(),
            cell_s: CELL_M / settings.cruise_m_per_s,
            enter_s: LANES.enter_rad / settings.turn_rad_per_s,
            disc: space.disc(),
            space,
        };
        for number in 0..picker.strips.all.len() {
            let strip = picker.strips.all[number];
            picker.weigh(LinePart {
                axis: strip.axis,
                line: strip.line,
                span: Span {
                    first: strip.first,
                    last: strip.last,
                },
            });
            budget.spend(WEIGH_WORK * strip.places()).await;
        }
        picker
    }

    /// The lanes of the first rounds, up to this number.
    pub(super) async fn rounds(&mut self, most: usize, budget: &mut StepBudget) -> Vec<Vec<Lane>> {
        let mut rounds = Vec::with_capacity(LANES.round_shares.len());
        for share in LANES.round_shares.into_iter().take(most) {
            rounds.push(self.round(share, budget).await);
        }
        rounds
    }

    async fn round(&mut self, share: f64, budget: &mut StepBudget) -> Vec<Lane> {
        let full = (2 * self.space.reach + 1) as f64 / self.cell_s;
        let least = share * full;
        self.queue.clear();
        for number in 0..self.strips.all.len() {
            self.offer(number, least);
            budget.spend(READ_WORK * self.strips.all[number].places()).await;
        }
        let mut lanes = Vec::new();
        while let Some(candidate) = self.next(least, budget).await {
            let strip = self.strips.all[candidate.strip];
            lanes.push(self.take(&strip, candidate.span, budget).await);
            self.refresh(
                LinePart {
                    axis: strip.axis,
                    line: strip.line,
                    span: candidate.span,
                },
                least,
                budget,
            )
            .await;
        }
        lanes
    }

    /// The best candidate that is up to date.
    async fn next(&mut self, least: f64, budget: &mut StepBudget) -> Option<LaneCandidate> {
        while let Some(old) = self.queue.pop() {
            let strip = &mut self.strips.all[old.strip];
            if old.version != strip.version {
                continue;
            }
            if !strip.is_changed {
                return Some(old);
            }
            strip.is_changed = false;
            budget.spend(READ_WORK * strip.places()).await;
            let Some(now) = self.best_of(old.strip, least) else {
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
    async fn take(&mut self, strip: &FreeStrip, span: Span, budget: &mut StepBudget) -> Lane {
        let index = |along: usize| match strip.axis {
            Axis::X => strip.line * self.space.width + along,
            Axis::Y => along * self.space.width + strip.line,
        };
        let (from, to, step) = (index(span.first), index(span.last), index(1) - index(0));
        let mut swept = 0;
        for index in (from..=to).step_by(step) {
            swept += self.close_disc(index);
            budget.spend(CLOSE_WORK).await;
        }
        Lane { from, to, swept }
    }

    /// Closes the floor around a cell; gives how many cells were open.
    fn close_disc(&mut self, index: usize) -> usize {
        let mut closed = 0;
        for position in 0..self.disc.len() {
            let (row, half) = self.disc[position];
            let centre = self.space.shifted(index, row);
            for cell in centre - half..=centre + half {
                if self.space.open[cell] {
                    self.space.open[cell] = false;
                    closed += 1;
                    let (column, row) = self.space.column_and_row(cell);
                    self.bits[Axis::X as usize].clear(column, row);
                    self.bits[Axis::Y as usize].clear(row, column);
                }
            }
        }
        closed
    }

    /// Weighs all positions again whose surroundings a lane has changed. Offers the strips again whose gain grew, which lie
    /// beside it and beyond its ends. Strips whose gain fell are updated when their turn comes.
    async fn refresh(&mut self, taken: LinePart, least: f64, budget: &mut StepBudget) {
        let Span { first, last } = taken.span;
        let around = 2 * self.space.reach + 2;
        let beside = taken.line.saturating_sub(around)..=taken.line + around;
        let along = Span {
            first: first.saturating_sub(around),
            last: last + around,
        };
        for line in beside.clone() {
            let part = LinePart {
                axis: taken.axis,
                line,
                span: along,
            };
            let work = self.renew(part, Some(least));
            budget.spend(work).await;
        }
        let span = Span {
            first: *beside.start(),
            last: *beside.end(),
        };
        for line in along.first..=along.last {
            let is_beyond = line < first || line > last;
            let part = LinePart {
                axis: taken.axis.other(),
                line,
                span,
            };
            let work = self.renew(part, is_beyond.then_some(least));
            budget.spend(work).await;
        }
    }

    /// Weighs a part of a line again and offers its strips again, or marks them as changed. Gives the work done.
    fn renew(&mut self, part: LinePart, offer: Option<f64>) -> usize {
        let mut work = 0;
        for number in self.strips.on(part.axis, part.line) {
            let strip = self.strips.all[number];
            if strip.last < part.span.first || strip.first > part.span.last {
                continue;
            }
            let span = Span {
                first: strip.first.max(part.span.first),
                last: strip.last.min(part.span.last),
            };
            self.weigh(LinePart { span, ..part });
            work += WEIGH_WORK * (span.last + 1 - span.first);
            match offer {
                Some(least) => {
                    self.offer(number, least);
                    work += READ_WORK * strip.places();
                }
                None => self.strips.all[number].is_changed = true,
            }
        }
        work
    }

    /// Computes the gains of the positions of a line.
    fn weigh(&mut self, part: LinePart) {
        let LinePart { axis, line, span } = part;
        let bits = &self.bits[axis as usize];
        let low = line - self.space.reach - 1;
        let start = line * self.space.length(axis);
        let mut ahead = bits.window(span.first, low);
        for along in span.first..=span.last {
            let here = ahead;
            ahead = bits.window(along + 1, low);
            self.gains[axis as usize][start + along] = self.masks.gain(here, ahead);
        }
    }

    fn offer(&mut self, number: usize, least: f64) {
        let strip = &mut self.strips.all[number];
        strip.version += 1;
        strip.is_changed = false;
        if let Some(candidate) = self.best_of(number, least) {
            self.queue.push(candidate);
        }
    }

    /// The lane of a strip with the highest gain beyond `least` per second.
    fn best_of(&self, number: usize, least: f64) -> Option<LaneCandidate> {
        let strip = &self.strips.all[number];
        let start = strip.line * self.space.length(strip.axis);
        let cost = least * self.cell_s;
        let (mut most, mut best) = (least * self.enter_s, None);
        let (mut profit, mut gain, mut first) = (0.0, 0, strip.first);
        let gains = &self.gains[strip.axis as usize][start + strip.first..=start + strip.last];
        for (along, more) in (strip.first..).zip(gains) {
            gain += i32::from(*more);
            profit += f64::from(*more) - cost;
            if profit <= 0.0 {
                (profit, gain, first) = (0.0, 0, along + 1);
            } else if profit > most {
                most = profit;
                best = Some((gain, Span { first, last: along }));
            }
        }
        let (gain, span) = best?;
        let cells = (span.last - span.first + 1) as f64;
        Some(LaneCandidate {
            rate: f64::from(gain) / (cells * self.cell_s + self.enter_s),
            strip: number,
            span,
            version: strip.version,
        })
    }
}

/// Masks for the cells across a lane; bit 0 lies just beside the swath.
struct GainMasks {
    swath: u64,
    pairs: u64,
    sides: u64,
}

impl GainMasks {
    fn new(reach: usize) -> Self {
        let swath = ((1_u64 << (2 * reach + 1)) - 1) << 1;
        Self {
            swath,
            pairs: (1 << (2 * reach + 2)) - 1,
            sides: 1 | 1 << (2 * reach + 2),
        }
    }

    /// The gain of sweeping one position of a lane, in cells.
    fn gain(&self, here: u64, ahead: u64) -> i16 {
        let swept = (here & self.swath).count_ones();
        if swept == 0 {
            return 0;
        }
        let gone =
            ((here ^ here >> 1) & self.pairs).count_ones() + ((here ^ ahead) & self.swath).count_ones();
        let new = (here & self.sides).count_ones();
        // At most a few hundred cells: a word has 64.
        swept as i16 + LANES.border_cells * (gone as i16 - new as i16)
    }
}

impl PartialEq for LaneCandidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for LaneCandidate {}

impl PartialOrd for LaneCandidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for LaneCandidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rate
            .total_cmp(&other.rate)
            .then_with(|| other.strip.cmp(&self.strip))
            .then_with(|| self.version.cmp(&other.version))
    }
}
