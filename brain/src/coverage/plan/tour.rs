//! In which order lanes are driven, and from which end.
//!
//! Terms. *End*: one end of a lane; end `2 * lane` is its `from`, `2 * lane + 1` its `to`. *Visit*: a lane with the end it
//! is entered at. Costs are seconds, turning included; the way back costs the same, so a part of a tour can be turned
//! round without changing what lies inside.

use super::PlanSettings;
use super::heading::{heading_rad, way_s};
use super::lanes::Lane;
use super::route::{Router, Spread};
use crate::geometry::{Point2, Pose2};
use crate::gradual::Pace;

/// Nearest ends to which the way is really looked for; ways to others are guessed.
const NEAR_ENDS: usize = 20;
/// How much longer than straight a guessed way is.
const GUESS: f64 = 1.6;
/// Turning on a guessed way.
const GUESS_RAD: f64 = 4.0;
/// Most rounds of improvement.
const PASSES_MAX: usize = 30;
/// Lanes moved together.
const MOVED_MAX: usize = 3;
/// Work of a guess, of the search for a way beyond that for its end, and of comparing two orders of lanes.
const GUESS_WORK: usize = 5;
const WAY_WORK: usize = 3_000;
const COMPARE_WORK: usize = 3;

/// A lane and the end at which it is entered (0 = `from`, 1 = `to`).
type End = usize;

/// Orders lanes.
pub(super) struct Tour<'plan> {
    router: &'plan Router<'plan>,
    settings: &'plan PlanSettings,
    start: Pose2,
    start_cell: usize,
    lanes: Vec<Lane>,
    /// The end at which each lane is entered, in the order of driving.
    visits: Vec<End>,
}

/// Seconds between ends.
struct Costs {
    ends: usize,
    seconds: Vec<f32>,
    /// From the start of this round to each end.
    first: Vec<f32>,
}

impl<'plan> Tour<'plan> {
    pub(super) fn new(
        router: &'plan Router<'plan>,
        settings: &'plan PlanSettings,
        start: Pose2,
        start_cell: usize,
    ) -> Self {
        Self {
            router,
            settings,
            start,
            start_cell,
            lanes: Vec::new(),
            visits: Vec::new(),
        }
    }

    /// Drives these lanes after those that are in the tour already.
    pub(super) async fn extend(&mut self, lanes: &[Lane], pace: &mut Pace) {
        if lanes.is_empty() {
            return;
        }
        let base = self.lanes.len();
        let (from, direction) = self.last_place();
        self.lanes.extend_from_slice(lanes);
        let costs = self.costs(base, (from, direction), pace).await;
        let mut order = nearest_first(&costs, pace).await;
        improve(&mut order, &costs, pace).await;
        self.visits.extend(order.into_iter().map(|end| end + 2 * base));
    }

    /// Where the tour ends so far, and in which direction.
    fn last_place(&self) -> (usize, f64) {
        match self.visits.last() {
            Some(end) => (self.cell(end ^ 1), self.out_rad(end ^ 1)),
            None => (self.start_cell, self.start.heading_rad),
        }
    }

    fn cell(&self, end: End) -> usize {
        let lane = self.lanes[end / 2];
        if end.is_multiple_of(2) { lane.from } else { lane.to }
    }

    fn point(&self, cell: usize) -> Point2 {
        self.router.ground().point(cell)
    }

    /// Direction in which the robot leaves its lane at this end.
    fn out_rad(&self, end: End) -> f64 {
        let lane = self.lanes[end / 2];
        if lane.from == lane.to {
            return 0.0;
        }
        heading_rad(self.point(self.cell(end ^ 1)), self.point(self.cell(end)))
    }

    fn is_point(&self, end: End) -> bool {
        let lane = self.lanes[end / 2];
        lane.from == lane.to
    }

    async fn costs(&self, base: usize, (from, direction_rad): (usize, f64), pace: &mut Pace) -> Costs {
        let ends = 2 * (self.lanes.len() - base);
        let mut costs = Costs {
            ends,
            seconds: vec![0.0; ends * ends],
            first: vec![0.0; ends],
        };
        let cells: Vec<usize> = (0..ends).map(|end| self.cell(2 * base + end)).collect();
        let points: Vec<Point2> = cells.iter().map(|cell| self.point(*cell)).collect();
        for a in 0..ends {
            for b in 0..ends {
                costs.seconds[a * ends + b] = self.guess_s(points[a], points[b]);
            }
            costs.first[a] = self.guess_s(self.point(from), points[a]);
            pace.spend(GUESS_WORK * ends).await;
        }
        let mut at_block: Vec<(usize, usize)> = cells
            .iter()
            .enumerate()
            .map(|(end, cell)| (self.router.block(*cell), end))
            .collect();
        at_block.sort_unstable();
        let mut spread = self.router.spread();
        let mut is_known = vec![false; ends * ends];
        for a in 0..ends {
            let out = (!self.is_point(2 * base + a)).then(|| self.out_rad(2 * base + a));
            for b in self.near(cells[a], &at_block, (&mut spread, &mut *pace)).await {
                // The way back is as long; it was looked for already if the other end found this one.
                if b / 2 == a / 2 || is_known[b * ends + a] {
                    continue;
                }
                is_known[a * ends + b] = true;
                let way = self.router.way(&spread, cells[a], cells[b]);
                let back = (!self.is_point(2 * base + b)).then(|| self.out_rad(2 * base + b));
                let seconds = self.way_s(&way, out, back);
                costs.seconds[a * ends + b] = seconds;
                costs.seconds[b * ends + a] = seconds;
                pace.spend(WAY_WORK).await;
            }
        }
        for b in self.near(from, &at_block, (&mut spread, &mut *pace)).await {
            let way = self.router.way(&spread, from, cells[b]);
            costs.first[b] = self.way_s(&way, Some(direction_rad), Some(self.out_rad(2 * base + b)));
            pace.spend(WAY_WORK).await;
        }
        costs
    }

    fn guess_s(&self, from: Point2, to: Point2) -> f32 {
        let drive_s = GUESS * from.distance_m(to) / self.settings.cruise_m_per_s;
        (drive_s + GUESS_RAD / self.settings.turn_rad_per_s) as f32
    }

    /// The ends nearest to a cell; `spread` then knows the ways.
    async fn near(
        &self,
        from: usize,
        at_block: &[(usize, usize)],
        (spread, pace): (&mut Spread, &mut Pace),
    ) -> Vec<usize> {
        let mut found = Vec::with_capacity(NEAR_ENDS + 8);
        let enough = |block| {
            let start = at_block.partition_point(|(other, _)| *other < block);
            found.extend(
                at_block[start..]
                    .iter()
                    .take_while(|(other, _)| *other == block)
                    .map(|(_, end)| *end),
            );
            found.len() >= NEAR_ENDS
        };
        self.router.explore(from, (spread, pace), enough).await;
        found
    }

    fn way_s(&self, way: &[usize], out_rad: Option<f64>, back_rad: Option<f64>) -> f32 {
        way_s(self.router.ground(), way, (out_rad, back_rad), self.settings)
    }

    /// The corners of the whole way.
    pub(super) async fn corners(&self, pace: &mut Pace) -> Vec<Point2> {
        let mut spread = self.router.spread();
        let mut corners = vec![self.point(self.start_cell)];
        let mut at = self.start_cell;
        let mut push = |cell: usize| {
            let point = self.point(cell);
            if corners.last() != Some(&point) {
                corners.push(point);
            }
        };
        for end in &self.visits {
            let (enter, leave) = (self.cell(*end), self.cell(end ^ 1));
            let goal = self.router.block(enter);
            let is_there = |block| block == goal;
            self.router.explore(at, (&mut spread, &mut *pace), is_there).await;
            for cell in self.router.way(&spread, at, enter) {
                push(cell);
            }
            push(leave);
            at = leave;
            pace.spend(WAY_WORK).await;
        }
        corners
    }
}

impl Costs {
    /// From leaving at one end to entering at another; `None` is the start of the round.
    fn between(&self, leave: Option<End>, enter: Option<End>) -> f32 {
        match (leave, enter) {
            (Some(leave), Some(enter)) => self.seconds[leave * self.ends + enter],
            (None, Some(enter)) => self.first[enter],
            // The end of a tour is free.
            (_, None) => 0.0,
        }
    }
}

async fn nearest_first(costs: &Costs, pace: &mut Pace) -> Vec<End> {
    let mut left: Vec<bool> = vec![true; costs.ends / 2];
    let mut order = Vec::with_capacity(left.len());
    let mut leave = None;
    for _ in 0..left.len() {
        let mut best: Option<(f32, End)> = None;
        for enter in (0..costs.ends).filter(|end| left[end / 2]) {
            let cost = costs.between(leave, Some(enter));
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, enter));
            }
        }
        let Some((_, enter)) = best else { break };
        left[enter / 2] = false;
        order.push(enter);
        leave = Some(enter ^ 1);
        pace.spend(COMPARE_WORK * costs.ends).await;
    }
    order
}

async fn improve(order: &mut Vec<End>, costs: &Costs, pace: &mut Pace) {
    for _ in 0..PASSES_MAX {
        let turned = turn_parts(order, costs, pace).await;
        let moved = move_parts(order, costs, pace).await;
        if !turned && !moved {
            return;
        }
    }
}

/// The end at which the tour leaves the lane before a position.
fn leave_before(order: &[End], position: usize) -> Option<End> {
    position
        .checked_sub(1)
        .and_then(|before| order.get(before))
        .map(|end| end ^ 1)
}

/// Turns parts of the tour round where that saves time (2-opt).
async fn turn_parts(order: &mut [End], costs: &Costs, pace: &mut Pace) -> bool {
    let mut any = false;
    for first in 0..order.len() {
        for last in first..order.len() {
            let before = leave_before(order, first);
            let after = order.get(last + 1).copied();
            let now = costs.between(before, Some(order[first])) + costs.between(Some(order[last] ^ 1), after);
            let then =
                costs.between(before, Some(order[last] ^ 1)) + costs.between(Some(order[first]), after);
            if then < now - 1e-3 {
                order[first..=last].reverse();
                for end in &mut order[first..=last] {
                    *end ^= 1;
                }
                any = true;
            }
        }
        pace.spend(COMPARE_WORK * (order.len() - first)).await;
    }
    any
}

/// Moves few lanes elsewhere, either way round, where that saves time (Or-opt).
async fn move_parts(order: &mut Vec<End>, costs: &Costs, pace: &mut Pace) -> bool {
    let mut any = false;
    for count in 1..=MOVED_MAX {
        let mut first = 0;
        while first + count <= order.len() {
            any |= move_part(order, first, count, costs);
            first += 1;
            pace.spend(COMPARE_WORK * order.len()).await;
        }
    }
    any
}

fn move_part(order: &mut Vec<End>, first: usize, count: usize, costs: &Costs) -> bool {
    let (enter, leave) = (order[first], order[first + count - 1] ^ 1);
    let before = leave_before(order, first);
    let after = order.get(first + count).copied();
    let saved =
        costs.between(before, Some(enter)) + costs.between(Some(leave), after) - costs.between(before, after);
    let mut best: Option<(f32, usize, bool)> = None;
    for position in (0..=order.len()).filter(|position| *position < first || *position > first + count) {
        let (left, right) = (leave_before(order, position), order.get(position).copied());
        let open = costs.between(left, right);
        let ahead = costs.between(left, Some(enter)) + costs.between(Some(leave), right) - open;
        let round = costs.between(left, Some(leave)) + costs.between(Some(enter), right) - open;
        for (cost, turned) in [(ahead, false), (round, true)] {
            if cost < saved - 1e-3 && best.is_none_or(|(least, _, _)| cost < least) {
                best = Some((cost, position, turned));
            }
        }
    }
    let Some((_, position, turned)) = best else {
        return false;
    };
    let mut part: Vec<End> = order.drain(first..first + count).collect();
    if turned {
        part.reverse();
        for end in &mut part {
            *end ^= 1;
        }
    }
    let target = if position > first {
        position - count
    } else {
        position
    };
    order.splice(target..target, part);
    true
}
