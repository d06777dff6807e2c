//! The order and direction of lanes: a travelling-salesman tour.
//!
//! Terms. *End*: one end of a lane; end `2 * lane` is its `from`, `2 * lane + 1` its `to`. A *visit* is a lane with the end at
//! which it is entered. Costs are seconds, turning included. They are symmetric, so reversing a part of a tour does not
//! change the cost inside it.

use super::lanes::Lane;
use super::settings::PlanSettings;
use super::timing::{EndHeadings, path_s};
use crate::coverage::plan::parameters::TOUR;
use crate::mapping::CELL_M;
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::StepBudget;
use crate::navigation::heading::heading_rad;
use crate::navigation::router::{CostField, PATH_WORK, Router};

/// Work of a guess, and of comparing two orders of lanes.
const GUESS_WORK: usize = 5;
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
    /// The end at which each lane is entered, in driving order.
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

    /// Appends the lanes of one round after another. Lanes of a later round that lie beside the path are driven with an
    /// earlier one, since returning for them would cost more.
    pub(super) async fn drive(&mut self, rounds: &[Vec<Lane>], budget: &mut StepBudget) {
        self.lanes = rounds.concat();
        if self.lanes.is_empty() {
            return;
        }
        let costs = self.costs(budget).await;
        let mut is_left = vec![true; self.lanes.len()];
        let mut order = Order {
            visits: core::mem::take(&mut self.visits),
            fixed: 0,
            costs: &costs,
        };
        let mut round = 0..0;
        for lanes in rounds {
            round = round.end..round.end + lanes.len();
            order.fixed = order.visits.len();
            order.append_nearest(&mut is_left, round.clone(), budget).await;
            order.improve(budget).await;
            if self.settings.takes_along && self.take_along(&mut order, &mut is_left, budget).await {
                order.improve(budget).await;
            }
        }
        self.visits = order.visits;
    }

    /// Inserts lanes that lie beside the path and are worth the detour. `true` when any was inserted.
    async fn take_along(&self, order: &mut Order<'_>, is_left: &mut [bool], budget: &mut StepBudget) -> bool {
        let mut any = false;
        for _ in 0..TOUR.take_along_passes {
            let mut more = false;
            for (lane, is_left) in is_left.iter_mut().enumerate().filter(|(_, is_left)| **is_left) {
                budget
                    .spend(COMPARE_WORK * (order.visits.len() - order.fixed))
                    .await;
                let Some(insertion) = order.cheapest_insertion(lane) else {
                    continue;
                };
                if f64::from(insertion.cost_s) + self.lane_s(lane) < self.worth_s(lane) {
                    order.visits.insert(insertion.position, insertion.enter);
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

    /// Driving time of a lane.
    fn lane_s(&self, lane: usize) -> f64 {
        let Lane { from, to, .. } = self.lanes[lane];
        self.point(from).distance_m(self.point(to)) / self.settings.cruise_m_per_s
    }

    /// Time that a lane is worth.
    fn worth_s(&self, lane: usize) -> f64 {
        let width = (2 * self.router.space().reach + 1) as f64;
        let cells_per_s = width * self.settings.cruise_m_per_s / CELL_M;
        self.lanes[lane].swept as f64 / (TOUR.take_along_share * cells_per_s)
    }

    fn cell(&self, end: End) -> usize {
        let lane = self.lanes[end / 2];
        if end.is_multiple_of(2) { lane.from } else { lane.to }
    }

    fn point(&self, cell: usize) -> Point2 {
        self.router.space().point(cell)
    }

    /// Heading in which the robot leaves its lane at this end.
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
        let mut nearest_ends = NearestEnds::new(self.router, &cells);
        let mut is_known = vec![false; ends * ends];
        for a in 0..ends {
            let start_rad = (!self.is_point(a)).then(|| self.out_rad(a));
            for b in nearest_ends.to(cells[a], budget).await {
                // Costs are symmetric: the other end may have found this one already.
                if b / 2 == a / 2 || is_known[b * ends + a] {
                    continue;
                }
                is_known[a * ends + b] = true;
                let path = nearest_ends.path(cells[b]);
                let leave_rad = (!self.is_point(b)).then(|| self.out_rad(b));
                let seconds = self.path_s(&path, EndHeadings { start_rad, leave_rad });
                costs.seconds[a * ends + b] = seconds;
                costs.seconds[b * ends + a] = seconds;
                budget.spend(PATH_WORK).await;
            }
        }
        for b in nearest_ends.to(from, budget).await {
            let path = nearest_ends.path(cells[b]);
            let ends = EndHeadings {
                start_rad: Some(direction_rad),
                leave_rad: Some(self.out_rad(b)),
            };
            costs.first[b] = self.path_s(&path, ends);
            budget.spend(PATH_WORK).await;
        }
        costs
    }

    fn guess_s(&self, from: Point2, to: Point2) -> f32 {
        let drive_s = TOUR.guess * from.distance_m(to) / self.settings.cruise_m_per_s;
        (drive_s + TOUR.guess_turn_rad / self.settings.turn_rad_per_s) as f32
    }

    fn path_s(&self, path: &[usize], ends: EndHeadings) -> f32 {
        path_s(self.router.space(), path, ends, self.settings)
    }

    /// The corners of the whole path.
    pub(super) async fn corners(&self, budget: &mut StepBudget) -> Vec<Point2> {
        let mut cost_field = self.router.cost_field();
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
            cost_field.explore(at, is_there, budget).await;
            for cell in cost_field.path(enter) {
                push(cell);
            }
            push(leave);
            at = leave;
            budget.spend(PATH_WORK).await;
        }
        corners
    }
}

impl Costs {
    /// From the exit of one lane to the entry of another; `None` is the start.
    fn between(&self, leave: Option<End>, enter: Option<End>) -> f32 {
        match (leave, enter) {
            (Some(leave), Some(enter)) => self.seconds[leave * self.ends + enter],
            (None, Some(enter)) => self.first[enter],
            // The tour may end anywhere.
            (_, None) => 0.0,
        }
    }
}

/// Finds the ends nearest to a cell, and the paths there.
struct NearestEnds<'plan> {
    /// The block of each end and the end, in the order of blocks.
    at_block: Vec<(usize, End)>,
    cost_field: CostField<'plan>,
}

impl<'plan> NearestEnds<'plan> {
    /// Of ends in these cells.
    fn new(router: &'plan Router<'plan>, cells: &[usize]) -> Self {
        let mut at_block: Vec<(usize, End)> = cells
            .iter()
            .enumerate()
            .map(|(end, cell)| (router.block(*cell), end))
            .collect();
        at_block.sort_unstable();
        Self {
            at_block,
            cost_field: router.cost_field(),
        }
    }

    /// The ends nearest to a cell.
    async fn to(&mut self, from: usize, budget: &mut StepBudget) -> Vec<End> {
        let at_block = &self.at_block;
        let mut found = Vec::with_capacity(TOUR.near_ends + 8);
        let enough = |block| {
            let start = at_block.partition_point(|(other, _)| *other < block);
            found.extend(
                at_block[start..]
                    .iter()
                    .take_while(|(other, _)| *other == block)
                    .map(|(_, end)| *end),
            );
            found.len() >= TOUR.near_ends
        };
        self.cost_field.explore(from, enough, budget).await;
        found
    }

    /// The path from that cell to a cell.
    fn path(&self, cell: usize) -> Vec<usize> {
        self.cost_field.path(cell)
    }
}

/// The lanes in driving order.
struct Order<'costs> {
    /// The end at which each lane is entered.
    visits: Vec<End>,
    /// The first visits, which stay as they are.
    fixed: usize,
    costs: &'costs Costs,
}

/// Where a lane can be inserted into an order.
struct Insertion {
    /// Additional time on links, seconds.
    cost_s: f32,
    position: usize,
    enter: End,
}

impl Order<'_> {
    /// Appends the lanes of a round by nearest neighbour.
    async fn append_nearest(
        &mut self,
        is_left: &mut [bool],
        round: core::ops::Range<usize>,
        budget: &mut StepBudget,
    ) {
        let mut leave = self.visits.last().map(|end| end ^ 1);
        let ends = 2 * round.start..2 * round.end;
        for _ in round {
            let mut best: Option<(f32, End)> = None;
            for enter in ends.clone().filter(|end| is_left[end / 2]) {
                let cost = self.costs.between(leave, Some(enter));
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, enter));
                }
            }
            let Some((_, enter)) = best else { break };
            is_left[enter / 2] = false;
            self.visits.push(enter);
            leave = Some(enter ^ 1);
            budget.spend(COMPARE_WORK * ends.len()).await;
        }
    }

    /// Where a lane costs least, and from which end.
    fn cheapest_insertion(&self, lane: usize) -> Option<Insertion> {
        let mut best: Option<Insertion> = None;
        for position in self.fixed..=self.visits.len() {
            let (left, right) = (self.leave_before(position), self.visits.get(position).copied());
            let open = self.costs.between(left, right);
            for enter in [2 * lane, 2 * lane + 1] {
                let cost_s =
                    self.costs.between(left, Some(enter)) + self.costs.between(Some(enter ^ 1), right) - open;
                if best.as_ref().is_none_or(|best| cost_s < best.cost_s) {
                    best = Some(Insertion {
                        cost_s,
                        position,
                        enter,
                    });
                }
            }
        }
        best
    }

    async fn improve(&mut self, budget: &mut StepBudget) {
        for _ in 0..TOUR.passes_max {
            let turned = self.reverse_parts(budget).await;
            let moved = self.move_parts(budget).await;
            if !turned && !moved {
                return;
            }
        }
    }

    /// The end at which the tour leaves the lane before a position.
    fn leave_before(&self, position: usize) -> Option<End> {
        position
            .checked_sub(1)
            .and_then(|before| self.visits.get(before))
            .map(|end| end ^ 1)
    }

    /// Reverses parts of the tour where that saves time (2-opt).
    async fn reverse_parts(&mut self, budget: &mut StepBudget) -> bool {
        let costs = self.costs;
        let mut any = false;
        for first in self.fixed..self.visits.len() {
            for last in first..self.visits.len() {
                let before = self.leave_before(first);
                let after = self.visits.get(last + 1).copied();
                let order = &mut self.visits;
                let now =
                    costs.between(before, Some(order[first])) + costs.between(Some(order[last] ^ 1), after);
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
            budget.spend(COMPARE_WORK * (self.visits.len() - first)).await;
        }
        any
    }

    /// Moves a few lanes elsewhere, in either direction, where that saves time (Or-opt).
    async fn move_parts(&mut self, budget: &mut StepBudget) -> bool {
        let mut any = false;
        for count in 1..=TOUR.moved_max {
            let mut first = self.fixed;
            while first + count <= self.visits.len() {
                any |= self.move_part(first, count);
                first += 1;
                budget
                    .spend(COMPARE_WORK * (self.visits.len() - self.fixed))
                    .await;
            }
        }
        any
    }

    fn move_part(&mut self, first: usize, count: usize) -> bool {
        let Some((position, turned)) = self.best_move(first, count) else {
            return false;
        };
        let mut part: Vec<End> = self.visits.drain(first..first + count).collect();
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
        self.visits.splice(target..target, part);
        true
    }

    /// The position to which moving some lanes saves most time, and whether they are reversed there.
    fn best_move(&self, first: usize, count: usize) -> Option<(usize, bool)> {
        let costs = self.costs;
        let order = &self.visits;
        let (enter, leave) = (order[first], order[first + count - 1] ^ 1);
        let before = self.leave_before(first);
        let after = order.get(first + count).copied();
        let saved = costs.between(before, Some(enter)) + costs.between(Some(leave), after)
            - costs.between(before, after);
        let mut best: Option<(f32, usize, bool)> = None;
        for position in
            (self.fixed..=order.len()).filter(|position| *position < first || *position > first + count)
        {
            let (left, right) = (self.leave_before(position), order.get(position).copied());
            let open = costs.between(left, right);
            let ahead = costs.between(left, Some(enter)) + costs.between(Some(leave), right) - open;
            let round = costs.between(left, Some(leave)) + costs.between(Some(enter), right) - open;
            for (cost, turned) in [(ahead, false), (round, true)] {
                if cost < saved - 1e-3 && best.is_none_or(|(least, _, _)| cost < least) {
                    best = Some((cost, position, turned));
                }
            }
        }
        best.map(|(_, position, turned)| (position, turned))
    }
}

#[cfg(test)]
mod tests {
    use super::{Costs, End, Lane, Order, PlanSettings, Router, Tour};
    use crate::mapping::{Cell, Raster};
    use crate::model::geometry::Pose2;
    use crate::model::gradual::{StepBudget, at_once};
    use crate::navigation::configuration_space::ConfigurationSpace;

    /// Lanes of zero length at these positions on a line; the start is at 0.
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
    fn a_lane_is_cheapest_between_its_neighbours_and_fixed_visits_stay_together() {
        let costs = costs(&[1.0, 5.0, 9.0, 3.0]);
        let place = |fixed| {
            let order = Order {
                visits: vec![0, 2, 4],
                fixed,
                costs: &costs,
            };
            order
                .cheapest_insertion(3)
                .map(|insertion| (insertion.cost_s, insertion.position))
        };
        assert_eq!(place(0), Some((0.0, 1)));
        assert_eq!(place(2), Some((4.0, 2)));
        assert_eq!(place(3), Some((6.0, 3)));
    }

    /// Driving order in a hall of 10 x 2 m: two lanes of the first round at its ends, and one of the second round beside
    /// the path between them, which sweeps this many cells.
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
            let mut space = ConfigurationSpace::new(&hall, 5, budget).await;
            let start = Pose2 {
                x_m: 0.3,
                y_m: 0.3,
                heading_rad: 0.0,
            };
            let origin = space.origin_near(start.position(), budget).await.unwrap();
            space.keep_connected(origin, budget).await;
            let router = Router::new(&space, budget).await;
            let lane = |column: usize, row: usize, swept: usize| {
                let from = origin + column + row * space.width;
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
    fn a_lane_beside_the_path_is_driven_early_if_it_is_worth_it() {
        assert_eq!(driven(600), [0, 2, 1]);
        assert_eq!(driven(20), [0, 1, 2]);
    }
}
