//! How much of the floor of an order the robot can reach, and whether people's no-go zones shut it off. Admission, the estimate and the end
//! of a job ask the same question here, so that they never disagree.

use super::parameters::REACH;
use crate::mapping::{CELL_M, Cell, CellKnowledge, Map, Raster, covered, reachable};
use crate::model::geometry::Point2;
use crate::model::job_refusal::JobRefusal;
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
    let open = without_no_go(map);
    Err(
        if floor_of(order, map, &open, (from, radius_m)).is_out_of_reach() {
            JobRefusal::RestOutOfReach
        } else {
            JobRefusal::NoGoInTheWay
        },
    )
}

/// Why a job that ends now is not finished: it has swept less than half of what was asked. `None` when it has swept more, and for orders
/// that are for the edges of rooms only.
pub(crate) fn left_most(order: &CleaningOrder, map: &Map, from: Point2, radius_m: f64) -> Option<Reason> {
    let words = map.annotations();
    let is_contour = |part| words.pattern_over(order, part) == Pattern::Contour;
    if order.is_for_whole_home() || order.parts().iter().any(|part| is_contour(Some(part))) {
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
    let open = floor_of(order, map, &without_no_go(map), (from, radius_m));
    let shut = floor_of(
        order,
        map,
        &map.knowledge_avoiding(order.avoid()),
        (from, radius_m),
    );
    let is_by_no_go = open.reached_m2 > shut.reached_m2 + REACH.finished_share * open.asked_m2;
    Some(if is_by_no_go {
        Reason::NoGoInTheWay
    } else {
        Reason::MostOutOfReach
    })
}

/// Whether the robot is surely over floor that belongs to no part of the order. Lanes at the edge of a part may lie half a swath outside.
pub(crate) fn is_off_order(order: &CleaningOrder, situation: &Situation<'_>) -> bool {
    if order.is_for_whole_home() || !situation.estimate.is_sure() {
        return false;
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
    !offsets.into_iter().any(is_ordered)
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

/// The knowledge as it would be without any no-go zone.
fn without_no_go(map: &Map) -> Raster<CellKnowledge> {
    let mut knowledge = map.knowledge().clone();
    for kind in knowledge.values_mut() {
        if *kind == CellKnowledge::NoGo {
            *kind = CellKnowledge::Free;
        }
    }
    knowledge
}
