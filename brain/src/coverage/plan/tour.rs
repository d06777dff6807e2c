//! In which order lanes are driven, and from which end.
//!
//! Terms. *End*: one end of a lane; end `2 * lane` is its `from`, `2 * lane + 1` its `to`. *Visit*: a lane with the end it
//! is entered at. Costs are seconds, turning included; the way back costs the same, so a part of a tour can be turned
//! round without changing what lies inside.

use super::lanes::Lane;
use super::settings::PlanSettings;
use super::timing::way_s;
use crate::mapping::CELL_M;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;
use crate::navigation::heading::heading_rad;
use crate::navigation::router::{Router, Spread};

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
/// Lanes of a later round are taken along where they sweep at least this share of what a lane over wholly open floor sweeps in
/// the time that they cost, and so often others are tried after that.
const TAKE_ALONG_SHARE: f64 = 0.2;
const TAKE_ALONG_PASSES: usize = 4;
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
    /// From the start to each end.
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

    /// Drives the lanes of one round after those of the other. Lanes of a later round that lie beside the way are driven with
    /// an earlier one: coming back for them would cost more.
    pub(super) async fn drive(&mut self, rounds: &[Vec<Lane>], budget: &mut StepBudget) {
        self.lanes = rounds.concat();
        if self.lanes.is_empty() {
            return;
        }
        let costs = self.costs(budget).await;
        let mut is_left = vec![true; self.lanes.len()];
        let mut round = 0..0;
        for lanes in rounds {
            round = round.end..round.end + lanes.len();
            let fixed = self.visits.len();
            nearest_first(
                &mut self.visits,
                (&mut is_left, round.clone()),
                (&costs, &mut *budget),
            )
            .await;
            improve(&mut self.visits, fixed, (&costs, &mut *budget)).await;
            if self.settings.takes_along
                && self
                    .take_along((&mut is_left, fixed), (&costs, &mut *budget))
                    .await
            {
                improve(&mut self.visits, fixed, (&costs, &mut *budget)).await;
            }
        }
    }

    /// Takes lanes along that lie beside the way and are worth the way round by them. `true` when any was.
    async fn take_along(
        &mut self,
        (is_left, fixed): (&mut [bool], usize),
        (costs, budget): (&Costs, &mut StepBudget),
    ) -> bool {
        let mut any = false;
        for _ in 0..TAKE_ALONG_PASSES {
            let mut more = false;
            for (lane, is_left) in is_left.iter_mut().enumerate().filter(|(_, is_left)| **is_left) {
                budget.spend(COMPARE_WORK * (self.visits.len() - fixed)).await;
                let Some((cost_s, position, enter)) = cheapest_place(&self.visits, (lane, fixed), costs)
                else {
                    continue;
                };
                if f64::from(cost_s) + self.lane_s(lane) < self.worth_s(lane) {
                    self.visits.insert(position, enter);
                    *is_left = false;
                    more = true;
                }
            }
            any |= more;
            if !more {
                break;
            }
        }
        any
    }

    /// Time that driving a lane takes.
    fn lane_s(&self, lane: usize) -> f64 {
        let Lane { from, to, .. } = self.lanes[lane];
        self.point(from).distance_m(self.point(to)) / self.settings.cruise_m_per_s
    }

    /// Time that a lane is worth on the way.
    fn worth_s(&self, lane: usize) -> f64 {
        let width = (2 * self.router.ground().reach + 1) as f64;
        let cells_per_s = width * self.settings.cruise_m_per_s / CELL_M;
        self.lanes[lane].swept as f64 / (TAKE_ALONG_SHARE * cells_per_s)
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

    async fn costs(&self, budget: &mut StepBudget) -> Costs {
        let (from, direction_rad) = (self.start_cell, self.start.heading_rad);
        let ends = 2 * self.lanes.len();
        let mut costs = Costs {
            ends,
            seconds: vec![0.0; ends * ends],
            first: vec![0.0; ends],
        };
        let cells: Vec<usize> = (0..ends).map(|end| self.cell(end)).collect();
        let points: Vec<Point2> = cells.iter().map(|cell| self.point(*cell)).collect();
        for a in 0..ends {
            for b in 0..ends {
                costs.seconds[a * ends + b] = self.guess_s(points[a], points[b]);
            }
            costs.first[a] = self.guess_s(self.point(from), points[a]);
            budget.spend(GUESS_WORK * ends).await;
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
            let out = (!self.is_point(a)).then(|| self.out_rad(a));
            for b in self.near(cells[a], &at_block, (&mut spread, &mut *budget)).await {
                // The way back is as long; it was looked for already if the other end found this one.
                if b / 2 == a / 2 || is_known[b * ends + a] {
                    continue;
                }
                is_known[a * ends + b] = true;
                let way = self.router.way(&spread, cells[a], cells[b]);
                let back = (!self.is_point(b)).then(|| self.out_rad(b));
                let seconds = self.way_s(&way, out, back);
                costs.seconds[a * ends + b] = seconds;
                costs.seconds[b * ends + a] = seconds;
                budget.spend(WAY_WORK).await;
            }
        }
        for b in self.near(from, &at_block, (&mut spread, &mut *budget)).await {
            let way = self.router.way(&spread, from, cells[b]);
            costs.first[b] = self.way_s(&way, Some(direction_rad), Some(self.out_rad(b)));
            budget.spend(WAY_WORK).await;
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
        (spread, budget): (&mut Spread, &mut StepBudget),
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
        self.router.explore(from, (spread, budget), enough).await;
        found
    }

    fn way_s(&self, way: &[usize], out_rad: Option<f64>, back_rad: Option<f64>) -> f32 {
        way_s(self.router.ground(), way, (out_rad, back_rad), self.settings)
    }

    /// The corners of the whole way.
    pub(super) async fn corners(&self, budget: &mut StepBudget) -> Vec<Point2> {
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
            self.router
                .explore(at, (&mut spread, &mut *budget), is_there)
                .await;
            for cell in self.router.way(&spread, at, enter) {
                push(cell);
            }
            push(leave);
            at = leave;
            budget.spend(WAY_WORK).await;
        }
        corners
    }
}

impl Costs {
    /// From leaving at one end to entering at another; `None` is the start.
    fn between(&self, leave: Option<End>, enter: Option<End>) -> f32 {
        match (leave, enter) {
            (Some(leave), Some(enter)) => self.seconds[leave * self.ends + enter],
            (None, Some(enter)) => self.first[enter],
            // The end of a tour is free.
            (_, None) => 0.0,
        }
    }
}

/// Appends the lanes of a round, each time the one that is nearest.
async fn nearest_first(
    order: &mut Vec<End>,
    (is_left, round): (&mut [bool], core::ops::Range<usize>),
    (costs, budget): (&Costs, &mut StepBudget),
) {
    let mut leave = order.last().map(|end| end ^ 1);
    let ends = 2 * round.start..2 * round.end;
    for _ in round {
        let mut best: Option<(f32, End)> = None;
        for enter in ends.clone().filter(|end| is_left[end / 2]) {
            let cost = costs.between(leave, Some(enter));
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, enter));
            }
        }
        let Some((_, enter)) = best else { break };
        is_left[enter / 2] = false;
        order.push(enter);
        leave = Some(enter ^ 1);
        budget.spend(COMPARE_WORK * ends.len()).await;
    }
}

/// Where in the tour, after so many visits, a lane costs least, and from which end.
fn cheapest_place(order: &[End], (lane, fixed): (usize, usize), costs: &Costs) -> Option<(f32, usize, End)> {
    let mut best: Option<(f32, usize, End)> = None;
    for position in fixed..=order.len() {
        let (left, right) = (leave_before(order, position), order.get(position).copied());
        let open = costs.between(left, right);
        for enter in [2 * lane, 2 * lane + 1] {
            let cost = costs.between(left, Some(enter)) + costs.between(Some(enter ^ 1), right) - open;
            if best.is_none_or(|(least, _, _)| cost < least) {
                best = Some((cost, position, enter));
            }
        }
    }
    best
}

/// Improves the tour after so many visits.
async fn improve(order: &mut Vec<End>, fixed: usize, (costs, budget): (&Costs, &mut StepBudget)) {
    for _ in 0..PASSES_MAX {
        let turned = turn_parts(order, fixed, (costs, &mut *budget)).await;
        let moved = move_parts(order, fixed, (costs, &mut *budget)).await;
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
async fn turn_parts(order: &mut [End], fixed: usize, (costs, budget): (&Costs, &mut StepBudget)) -> bool {
    let mut any = false;
    for first in fixed..order.len() {
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
        budget.spend(COMPARE_WORK * (order.len() - first)).await;
    }
    any
}

/// Moves few lanes elsewhere, either way round, where that saves time (Or-opt).
async fn move_parts(order: &mut Vec<End>, fixed: usize, (costs, budget): (&Costs, &mut StepBudget)) -> bool {
    let mut any = false;
    for count in 1..=MOVED_MAX {
        let mut first = fixed;
        while first + count <= order.len() {
            any |= move_part(order, (fixed, first, count), costs);
            first += 1;
            budget.spend(COMPARE_WORK * (order.len() - fixed)).await;
        }
    }
    any
}

fn move_part(order: &mut Vec<End>, (fixed, first, count): (usize, usize, usize), costs: &Costs) -> bool {
    let (enter, leave) = (order[first], order[first + count - 1] ^ 1);
    let before = leave_before(order, first);
    let after = order.get(first + count).copied();
    let saved =
        costs.between(before, Some(enter)) + costs.between(Some(leave), after) - costs.between(before, after);
    let mut best: Option<(f32, usize, bool)> = None;
    for position in (fixed..=order.len()).filter(|position| *position < first || *position > first + count) {
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

#[cfg(test)]
mod tests {
    use super::{Costs, End, Lane, PlanSettings, Router, Tour, cheapest_place};
    use crate::mapping::{Cell, Raster};
    use crate::model::geometry::Pose2;
    use crate::model::gradual::{StepBudget, at_once};
    use crate::navigation::configuration_space::Ground;

    /// Lanes without length at these places of a line; the start is at 0.
    fn costs(places: &[f32]) -> Costs {
        let ends = 2 * places.len();
        let at = |end: End| places[end / 2];
        Costs {
            ends,
            seconds: (0..ends * ends)
                .map(|pair| (at(pair / ends) - at(pair % ends)).abs())
                .collect(),
            first: (0..ends).map(at).collect(),
        }
    }

    #[test]
    fn a_lane_costs_least_between_those_beside_it_and_nothing_is_put_among_visits_that_are_fixed() {
        let costs = costs(&[1.0, 5.0, 9.0, 3.0]);
        let order = [0, 2, 4];
        let place =
            |fixed| cheapest_place(&order, (3, fixed), &costs).map(|(cost, position, _)| (cost, position));
        assert_eq!(place(0), Some((0.0, 1)));
        assert_eq!(place(2), Some((4.0, 2)));
        assert_eq!(place(3), Some((6.0, 3)));
    }

    /// In which order lanes are driven in a hall of 10 x 2 m: two of the first round at its ends, and one of the second round
    /// beside the way between them, which sweeps this many cells.
    fn driven(swept: usize) -> Vec<usize> {
        let settings = PlanSettings {
            swath_m: 0.3,
            sigma_m: 0.01,
            cruise_m_per_s: 0.25,
            turn_rad_per_s: 1.2,
            takes_along: true,
        };
        let hall = Raster::filled(Cell { x: 0, y: 0 }, 400, 80, true);
        let budget = &mut StepBudget::unlimited();
        at_once(async {
            let mut ground = Ground::new(&hall, 5, budget).await;
            let start = Pose2 {
                x_m: 0.3,
                y_m: 0.3,
                heading_rad: 0.0,
            };
            let origin = ground.origin_near(start.position(), budget).await.unwrap();
            ground.keep_connected(origin, budget).await;
            let router = Router::new(&ground, budget).await;
            let lane = |column: usize, row: usize, swept: usize| {
                let from = origin + column + row * ground.width;
                Lane {
                    from,
                    to: from + 20,
                    swept,
                }
            };
            let rounds = [
                vec![lane(10, 0, 220), lane(340, 0, 220)],
                vec![lane(150, 30, swept)],
            ];
            let mut tour = Tour::new(&router, &settings, start, origin);
            tour.drive(&rounds, budget).await;
            tour.visits.iter().map(|end| end / 2).collect()
        })
    }

    #[test]
    fn what_lies_beside_the_way_is_taken_along_if_it_is_worth_it() {
        assert_eq!(driven(600), [0, 2, 1]);
        assert_eq!(driven(20), [0, 1, 2]);
    }
}
