//! How much of the floor of an order the robot can reach, and what shuts it off: a virtual wall, a no-go zone, a door, something new.
//! Admission, the estimate and the end of a job ask the same question here, so that they never disagree.

use super::parameters::REACH;
use crate::mapping::{
    CELL_M, Cell, CellKnowledge, Door, HomeFloor, Map, Raster, covered_in_steps, reachable_in_steps,
};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::job_refusal::JobRefusal;
use crate::model::no_go::NoGoShape;
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::model::room_settings::Pattern;
use crate::navigation::Situation;

/// Work to count a cell.
const COUNT_WORK: usize = 1;

/// Floor of an order, square metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct OrderFloor {
    asked_m2: f64,
    reached_m2: f64,
}

impl OrderFloor {
    /// Whether too little of it can be reached to begin a job.
    fn is_out_of_reach(self) -> bool {
        self.asked_m2 > 0.0
            && (self.reached_m2 < REACH.least_m2.min(0.5 * self.asked_m2)
                || self.reached_m2 < REACH.least_share * self.asked_m2)
    }
}

/// Why an order is refused, and what of the home's own no-go zones and virtual walls is in its way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OrderRefusal {
    /// Why.
    pub reason: JobRefusal,
    /// Numbers of those each of which alone shuts off what is ordered; of other reasons there are none.
    pub in_the_way: Vec<u16>,
}

impl From<JobRefusal> for OrderRefusal {
    fn from(reason: JobRefusal) -> Self {
        Self {
            reason,
            in_the_way: Vec::new(),
        }
    }
}

/// An order, asked of the floor of a home by a robot with this radius at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReachQuestion<'a> {
    pub(crate) order: &'a CleaningOrder,
    pub(crate) home: &'a HomeFloor,
    pub(crate) from: Point2,
    pub(crate) radius_m: f64,
}

impl<'a> ReachQuestion<'a> {
    /// Whether the robot can reach enough of what is ordered.
    ///
    /// # Errors
    /// What keeps it from there.
    pub(crate) async fn admit(self, budget: &mut StepBudget) -> Result<(), JobRefusal> {
        let home = self.home;
        // From within a no-go zone nothing says how the robot gets out of it.
        let stands_in_no_go = home.knowledge().get(Cell::under(self.from)) == Some(&CellKnowledge::NoGo);
        if self.order.is_for_whole_home() || stands_in_no_go {
            return Ok(());
        }
        let judge = self.judge(Enough::ToBegin, budget).await;
        let knowledge = home.avoiding(self.order.avoid(), budget).await;
        if judge.is_enough(&knowledge, budget).await {
            return Ok(());
        }
        let barrier = judge.barrier(budget).await;
        Err(barrier.map_or(JobRefusal::RestOutOfReach, Barrier::refusal))
    }

    /// Why the order is refused, with what is in its way.
    pub(crate) async fn refusal(self, reason: JobRefusal, budget: &mut StepBudget) -> OrderRefusal {
        let in_the_way = match reason {
            JobRefusal::NoGoInTheWay | JobRefusal::VirtualWallInTheWay => self.in_the_way(budget).await,
            _ => Vec::new(),
        };
        OrderRefusal { reason, in_the_way }
    }

    /// Numbers of the no-go zones and virtual walls each of which alone shuts off what is ordered.
    async fn in_the_way(self, budget: &mut StepBudget) -> Vec<u16> {
        let judge = self.judge(Enough::ToBegin, budget).await;
        let no_gos = || self.home.annotations().no_go();
        let mut groups: Vec<Vec<u16>> = vec![no_gos().map(|(number, _)| number).collect()];
        let mut numbers = Vec::new();
        // Without a group there is at least as much within reach as without one of it: where that is not enough, none of it is asked alone.
        while let Some(group) = groups.pop() {
            let others = no_gos().filter(|(number, _)| !group.contains(number));
            let forbidden = others.map(|(_, no_go)| no_go).chain(self.order.avoid());
            let knowledge = self.home.forbidding(forbidden, budget).await;
            if !judge.is_enough(&knowledge, budget).await {
                continue;
            }
            match group.as_slice() {
                [] => {}
                [number] => numbers.push(*number),
                _ => {
                    let (low, high) = group.split_at(group.len() / 2);
                    groups.extend([high.to_vec(), low.to_vec()]);
                }
            }
        }
        numbers
    }

    /// As [`left_most`].
    async fn left_most(self, map: &Map, budget: &mut StepBudget) -> Option<Reason> {
        let asked_floor = asked_floor(self.order, self.home, budget).await;
        let (mut asked, mut swept) = (0_u32, 0_u32);
        for (index, _) in asked_floor.iter().enumerate().filter(|(_, is_asked)| **is_asked) {
            asked += 1;
            swept += u32::from(map.is_swept(self.home.knowledge().cell(index).middle()));
        }
        if asked == 0 || f64::from(swept) >= REACH.finished_share * f64::from(asked) {
            return None;
        }
        let [swept_m2, left_m2] = [swept, asked - swept].map(|cells| f64::from(cells) * CELL_M * CELL_M);
        let more_than = |m2: f64| Enough::MoreThan(m2 + REACH.finished_share * left_m2);
        let mut judge = ReachJudge {
            question: self,
            asked: asked_floor,
            enough: more_than(swept_m2),
        };
        let shut = self.home.avoiding(self.order.avoid(), budget).await;
        let reached = judge.floor(&shut, budget).await;
        let barrier = if judge.enough.is_met_by(reached) {
            // The map holds the way open, and the robot did not get there. A first run has nothing to compare with.
            let knows = !self.order.is_for_whole_home() || map.knows_home();
            match knows {
                true => Some(judge.met(map, &shut, budget).await),
                false => None,
            }
        } else {
            judge.enough = more_than(reached.reached_m2);
            judge.barrier(budget).await
        };
        Some(barrier.map_or(Reason::MostOutOfReach, Barrier::reason))
    }

    /// Who judges by what is asked for: known floor that is ordered and not forbidden.
    async fn judge(self, enough: Enough, budget: &mut StepBudget) -> ReachJudge<'a> {
        ReachJudge {
            question: self,
            asked: asked_floor(self.order, self.home, budget).await,
            enough,
        }
    }
}

/// How much floor is enough.
#[derive(Clone, Copy, Debug)]
enum Enough {
    /// To begin a job.
    ToBegin,
    /// More than so many square metres within reach.
    MoreThan(f64),
}

impl Enough {
    fn is_met_by(self, floor: OrderFloor) -> bool {
        match self {
            Self::ToBegin => !floor.is_out_of_reach(),
            Self::MoreThan(reached_m2) => floor.reached_m2 > reached_m2,
        }
    }
}

/// Judges how much of what is asked for can be reached.
struct ReachJudge<'a> {
    question: ReachQuestion<'a>,
    /// Whether each cell of the home's knowledge is asked for, row after row.
    asked: Vec<bool>,
    enough: Enough,
}

impl ReachJudge<'_> {
    async fn is_enough(&self, knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> bool {
        self.enough.is_met_by(self.floor(knowledge, budget).await)
    }

    async fn floor(&self, knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> OrderFloor {
        let ReachQuestion { from, radius_m, .. } = self.question;
        let reached = reachable_in_steps(knowledge, (from, radius_m), budget).await;
        let passed = covered_in_steps(&reached, radius_m, budget).await;
        let mut floor = OrderFloor::default();
        for (is_asked, is_passed) in self.asked.iter().zip(passed.values()) {
            if *is_asked {
                floor.asked_m2 += CELL_M * CELL_M;
                floor.reached_m2 += if *is_passed { CELL_M * CELL_M } else { 0.0 };
            }
        }
        budget.spend(COUNT_WORK * self.asked.len()).await;
        floor
    }

    /// What stands between the robot and floor that it would reach otherwise: without it there would be enough.
    async fn barrier(&self, budget: &mut StepBudget) -> Option<Barrier> {
        let ReachQuestion { order, home, .. } = self.question;
        let no_gos = home.annotations().no_go().map(|(_, no_go)| no_go);
        let all = no_gos.chain(order.avoid());
        let zones = all.filter(|no_go| no_go.shape() == NoGoShape::Zone);
        let open = home.forbidding(core::iter::empty(), budget).await;
        if self.is_enough(&open, budget).await {
            let without_walls = home.forbidding(zones, budget).await;
            let is_wall = self.is_enough(&without_walls, budget).await;
            return Some(if is_wall {
                Barrier::VirtualWall
            } else {
                Barrier::NoGoZone
            });
        }
        let shut = home.avoiding(order.avoid(), budget).await;
        let doors = home.rooms().doors();
        let is_in_door = |cell: Cell| doors.iter().any(|door| stands_in(door, cell.middle()));
        let mut open = shut.clone();
        home.open_past_floor(&mut open, is_in_door, budget).await;
        if self.is_enough(&open, budget).await {
            return Some(Barrier::Door);
        }
        let mut open = shut;
        home.open_past_floor(&mut open, |_| true, budget).await;
        self.is_enough(&open, budget)
            .await
            .then_some(Barrier::NewObstacle)
    }

    /// What the robot met on a way that `knowledge` holds open: something in a door that leads there, or something elsewhere.
    async fn met(&self, map: &Map, knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Barrier {
        let hazards = map.snapshot().hazards;
        let was_touched = |door: &&Door| {
            let mut near = hazards.iter();
            near.any(|hazard| {
                hazard.at.distance_m(door.at) < REACH.touched_share * door.width_m + REACH.door_m
            })
        };
        for door in map.rooms().doors().iter().filter(was_touched) {
            let leads_there = !self.is_enough(&with_door_shut(knowledge, door), budget).await;
            if leads_there {
                return Barrier::Door;
            }
        }
        Barrier::NewObstacle
    }
}

/// What stands between the robot and floor that it would reach otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Barrier {
    VirtualWall,
    NoGoZone,
    Door,
    NewObstacle,
}

impl Barrier {
    const fn refusal(self) -> JobRefusal {
        match self {
            Self::VirtualWall => JobRefusal::VirtualWallInTheWay,
            Self::NoGoZone => JobRefusal::NoGoInTheWay,
            Self::Door => JobRefusal::DoorShut,
            Self::NewObstacle => JobRefusal::NewObstacleInTheWay,
        }
    }

    const fn reason(self) -> Reason {
        match self {
            Self::VirtualWall => Reason::VirtualWallInTheWay,
            Self::NoGoZone => Reason::NoGoInTheWay,
            Self::Door => Reason::DoorShut,
            Self::NewObstacle => Reason::NewObstacleInTheWay,
        }
    }
}

/// Whether what is at this place stands in a door.
fn stands_in(door: &Door, at: Point2) -> bool {
    door.at.distance_m(at) < 0.5 * door.width_m + REACH.door_m
}

/// The knowledge as if something filled a door.
fn with_door_shut(knowledge: &Raster<CellKnowledge>, door: &Door) -> Raster<CellKnowledge> {
    let mut shut = knowledge.clone();
    for index in 0..shut.values().len() {
        let at = shut.cell(index).middle();
        if stands_in(door, at)
            && let Some(kind) = shut.values_mut().get_mut(index)
        {
            *kind = CellKnowledge::Occupied;
        }
    }
    shut
}

/// Why a job that ends now is not finished: it has swept less than half of what was asked. `None` when it has swept more, and for orders
/// that are for the edges of rooms only. A first run asks for the floor that it has found.
pub(crate) fn left_most(order: &CleaningOrder, map: &Map, from: Point2, radius_m: f64) -> Option<Reason> {
    if sweeps_edges_only(order, map) {
        return None;
    }
    let home = &map.home_floor();
    let question = ReachQuestion {
        order,
        home,
        from,
        radius_m,
    };
    at_once(question.left_most(map, &mut StepBudget::unlimited()))
}

/// Whether rooms of the order are swept at their edges only.
fn sweeps_edges_only(order: &CleaningOrder, map: &Map) -> bool {
    let words = map.annotations();
    let is_contour = |part| words.pattern_over(order, part) == Pattern::Contour;
    let mut parts = order.parts().iter();
    if order.is_for_whole_home() {
        is_contour(None) || !words.contour_rooms(order).is_empty()
    } else {
        parts.any(|part| is_contour(Some(part)))
    }
}

/// Whether the robot is over floor that belongs to no part of the order; `None` while it does not know where it is. Lanes at the edge of
/// a part may lie half a swath outside.
pub(crate) fn is_off_order(order: &CleaningOrder, situation: &Situation<'_>) -> Option<bool> {
    if order.is_for_whole_home() {
        return Some(false);
    }
    if !situation.estimate.is_sure() {
        return None;
    }
    let here = situation.pose.position();
    let near_m = situation.config.body.swath_m;
    let offsets = [
        (0.0, 0.0),
        (near_m, 0.0),
        (-near_m, 0.0),
        (0.0, near_m),
        (0.0, -near_m),
    ];
    let is_ordered = |(x_m, y_m): (f64, f64)| {
        let cell = Cell::under(Point2 {
            x_m: here.x_m + x_m,
            y_m: here.y_m + y_m,
        });
        let mut parts = order.parts().iter();
        parts.any(|part| situation.map.rooms().is_in_part(cell, part))
    };
    Some(!offsets.into_iter().any(is_ordered))
}

/// Known floor that is ordered and not forbidden: whether each cell of the home's knowledge is, row after row.
async fn asked_floor(order: &CleaningOrder, home: &HomeFloor, budget: &mut StepBudget) -> Vec<bool> {
    let cells = home.knowledge().values();
    if order.is_for_whole_home() {
        return cells.iter().map(|kind| *kind == CellKnowledge::Free).collect();
    }
    let mut asked = vec![false; cells.len()];
    for part in order.parts() {
        home.mark_asked(part, &mut asked, budget).await;
    }
    asked
}
