//! How much of the floor of an order the robot can reach, and what shuts it off: a virtual wall, a no-go zone, a door, something new.
//! Admission, the estimate and the end of a job ask the same question here, so that they never disagree.

use super::parameters::REACH;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Door, Map, Raster, covered, reachable};
use crate::model::geometry::Point2;
use crate::model::job_refusal::JobRefusal;
use crate::model::no_go::NoGoShape;
use crate::model::order::CleaningOrder;
use crate::model::reason::Reason;
use crate::model::room_settings::Pattern;
use crate::navigation::Situation;

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

/// Whether a robot at `from` with this radius can reach enough of what is ordered.
///
/// # Errors
/// What keeps it from there.
pub(crate) fn admit_reach(
    order: &CleaningOrder,
    map: &Map,
    from: Point2,
    radius_m: f64,
) -> Result<(), JobRefusal> {
    // From within a no-go zone nothing says how the robot gets out of it.
    let stands_in_no_go = map.knowledge().get(Cell::under(from)) == Some(&CellKnowledge::NoGo);
    if order.is_for_whole_home() || stands_in_no_go {
        return Ok(());
    }
    let knowledge = map.knowledge_avoiding(order.avoid());
    if !floor_of(order, map, &knowledge, (from, radius_m)).is_out_of_reach() {
        return Ok(());
    }
    let barrier = Barrier::that(order, map, |knowledge| {
        !floor_of(order, map, knowledge, (from, radius_m)).is_out_of_reach()
    });
    Err(barrier.map_or(JobRefusal::RestOutOfReach, Barrier::refusal))
}

/// Numbers of the no-go zones and virtual walls each of which alone shuts off what is ordered.
pub(crate) fn in_the_way(order: &CleaningOrder, map: &Map, from: Point2, radius_m: f64) -> Vec<u16> {
    let words = map.annotations();
    let shuts_off = |number: u16| {
        let others = words.no_go().filter(|(other, _)| *other != number);
        let forbidden = others.map(|(_, no_go)| no_go).chain(order.avoid());
        let knowledge = map.knowledge_forbidding(forbidden);
        !floor_of(order, map, &knowledge, (from, radius_m)).is_out_of_reach()
    };
    let numbers = words.no_go().map(|(number, _)| number);
    numbers.filter(|number| shuts_off(*number)).collect()
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
    /// The barrier without which `is_enough` holds of the knowledge.
    fn that(
        order: &CleaningOrder,
        map: &Map,
        is_enough: impl Fn(&Raster<CellKnowledge>) -> bool,
    ) -> Option<Self> {
        let zones = || {
            let all = map.annotations().no_go().map(|(_, no_go)| no_go);
            all.chain(order.avoid())
                .filter(|no_go| no_go.shape() == NoGoShape::Zone)
        };
        if is_enough(&map.knowledge_forbidding(core::iter::empty())) {
            let is_wall = is_enough(&map.knowledge_forbidding(zones()));
            return Some(if is_wall {
                Self::VirtualWall
            } else {
                Self::NoGoZone
            });
        }
        let shut = map.knowledge_avoiding(order.avoid());
        let doors = map.rooms().doors();
        let is_in_door = |cell: Cell| doors.iter().any(|door| stands_in(door, cell.middle()));
        if is_enough(&with_past_floor(map, &shut, is_in_door)) {
            Some(Self::Door)
        } else if is_enough(&with_past_floor(map, &shut, |_| true)) {
            Some(Self::NewObstacle)
        } else {
            None
        }
    }

    /// What the robot met on a way that `knowledge` holds open: something in a door that leads there, or something elsewhere.
    fn met(
        map: &Map,
        knowledge: &Raster<CellKnowledge>,
        is_enough: impl Fn(&Raster<CellKnowledge>) -> bool,
    ) -> Self {
        let hazards = map.snapshot().hazards;
        let was_touched = |door: &Door| {
            let mut near = hazards.iter();
            near.any(|hazard| {
                hazard.at.distance_m(door.at) < REACH.touched_share * door.width_m + REACH.door_m
            })
        };
        let leads_there = |door: &Door| !is_enough(&with_door_shut(knowledge, door));
        let mut doors = map.rooms().doors().iter();
        if doors.any(|door| was_touched(door) && leads_there(door)) {
            Self::Door
        } else {
            Self::NewObstacle
        }
    }

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

/// The knowledge with floor again where something stands now, and floor was before, as far as `is_asked`.
fn with_past_floor(
    map: &Map,
    knowledge: &Raster<CellKnowledge>,
    is_asked: impl Fn(Cell) -> bool,
) -> Raster<CellKnowledge> {
    let mut open = knowledge.clone();
    map.open_past_floor(&mut open, |open, index| is_asked(open.cell(index)));
    open
}

/// Why a job that ends now is not finished: it has swept less than half of what was asked. `None` when it has swept more, and for orders
/// that are for the edges of rooms only. A first run asks for the floor that it has found.
pub(crate) fn left_most(order: &CleaningOrder, map: &Map, from: Point2, radius_m: f64) -> Option<Reason> {
    if sweeps_edges_only(order, map) {
        return None;
    }
    let (mut asked, mut swept) = (0_u32, 0_u32);
    for cell in asked_cells(order, map) {
        asked += 1;
        swept += u32::from(map.is_swept(cell.middle()));
    }
    if asked == 0 || f64::from(swept) >= REACH.finished_share * f64::from(asked) {
        return None;
    }
    let reached_m2 =
        |knowledge: &Raster<CellKnowledge>| floor_of(order, map, knowledge, (from, radius_m)).reached_m2;
    let [swept_m2, left_m2] = [swept, asked - swept].map(|cells| f64::from(cells) * CELL_M * CELL_M);
    let shut = map.knowledge_avoiding(order.avoid());
    let shut_m2 = reached_m2(&shut);
    let opens_most = |from_m2: f64, to_m2: f64| to_m2 > from_m2 + REACH.finished_share * left_m2;
    let barrier = if opens_most(swept_m2, shut_m2) {
        // The map holds the way open, and the robot did not get there. A first run has nothing to compare with.
        let knows = !order.is_for_whole_home() || map.knows_home();
        knows.then(|| {
            Barrier::met(map, &shut, |knowledge| {
                opens_most(swept_m2, reached_m2(knowledge))
            })
        })
    } else {
        Barrier::that(order, map, |knowledge| opens_most(shut_m2, reached_m2(knowledge)))
    };
    Some(barrier.map_or(Reason::MostOutOfReach, Barrier::reason))
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

/// Known floor that is ordered and not forbidden.
fn asked_cells<'a>(order: &'a CleaningOrder, map: &'a Map) -> impl Iterator<Item = Cell> + 'a {
    let knowledge = map.knowledge();
    (0..knowledge.values().len())
        .filter(move |index| knowledge.values().get(*index) == Some(&CellKnowledge::Free))
        .map(move |index| knowledge.cell(index))
        .filter(move |cell| {
            let mut parts = order.parts().iter();
            order.is_for_whole_home() || parts.any(|part| map.rooms().is_in_part(*cell, part))
        })
}

fn floor_of(
    order: &CleaningOrder,
    map: &Map,
    knowledge: &Raster<CellKnowledge>,
    (from, radius_m): (Point2, f64),
) -> OrderFloor {
    let passed = covered(&reachable(knowledge, from, radius_m), radius_m);
    let mut floor = OrderFloor::default();
    for cell in asked_cells(order, map) {
        floor.asked_m2 += CELL_M * CELL_M;
        if passed.get(cell) == Some(&true) {
            floor.reached_m2 += CELL_M * CELL_M;
        }
    }
    floor
}
