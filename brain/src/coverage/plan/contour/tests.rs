//! Rings of small rooms.

use super::depth::depths;
use super::rings::{Ring, rings};
use crate::coverage::plan::{Course, CoveragePlan, Departure, PlanSettings, plan_area, reach_cells};
use crate::mapping::{CELL_M, Cell, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{StepBudget, at_once};
use crate::navigation::configuration_space::Ground;

const SETTINGS: PlanSettings = PlanSettings {
    swath_m: 0.25,
    sigma_m: 0.01,
    cruise_m_per_s: 0.25,
    turn_rad_per_s: 1.2,
    takes_along: true,
};

/// A room of 3 x 2.5 m, with a table of 0.5 m if it is furnished.
fn room(is_furnished: bool) -> Raster<bool> {
    let mut room = Raster::filled(Cell { x: -5, y: 3 }, 120, 100, true);
    for (x, y) in (50..70).flat_map(|x| (40..60).map(move |y| (x, y))) {
        if let Some(cell) = room.get_mut(Cell { x, y }) {
            *cell = !is_furnished;
        }
    }
    room
}

fn found(room: &Raster<bool>) -> (Ground, Vec<Ring>) {
    let budget = &mut StepBudget::unlimited();
    let mut ground = at_once(Ground::new(room, reach_cells(&SETTINGS), budget));
    let origin = at_once(ground.origin_near(Point2::default(), budget)).unwrap();
    at_once(ground.keep_connected(origin, budget));
    let ringed = ground.free.clone();
    let depths = at_once(depths(&ground, &ringed, budget));
    let rings = at_once(rings(&ground, &depths, budget));
    (ground, rings)
}

#[test]
fn rings_of_two_levels_lie_a_lane_apart() {
    let (ground, rings) = found(&room(true));
    let spacing_m = (2 * reach_cells(&SETTINGS) + 1) as f64 * CELL_M;
    let mut pairs = 0;
    for (place, ring) in rings.iter().enumerate() {
        for other in rings[place + 1..]
            .iter()
            .filter(|other| other.level != ring.level)
        {
            let levels = other.level.abs_diff(ring.level) as f64;
            let nearest_m = ring
                .cells
                .iter()
                .flat_map(|one| {
                    other
                        .cells
                        .iter()
                        .map(|two| ground.point(*one).distance_m(ground.point(*two)))
                })
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest_m > levels * (spacing_m - 1.5 * CELL_M),
                "{nearest_m} m, {levels} levels"
            );
            pairs += 1;
        }
    }
    assert!(pairs > 10, "{pairs} pairs");
}

#[test]
fn each_border_has_its_ring_and_each_ring_is_closed() {
    let around = |room: &Raster<bool>| found(room).1.iter().filter(|ring| ring.level == 0).count();
    assert_eq!((around(&room(false)), around(&room(true))), (1, 2));
    let (ground, rings) = found(&room(true));
    for ring in rings {
        let ends = [ring.cells[0], ring.cells[ring.cells.len() - 1]];
        let pairs = ring.cells.windows(2).map(|pair| [pair[0], pair[1]]).chain([ends]);
        for [one, other] in pairs {
            assert!(ground.free[one] && ground.neighbours(one).contains(&other));
        }
    }
}

fn planned(course: Course, start: Point2) -> CoveragePlan {
    let departure = Departure {
        start: Pose2 {
            x_m: start.x_m,
            y_m: start.y_m,
            heading_rad: 0.0,
        },
        settings: SETTINGS,
    };
    let whole = (|_: Cell| Some(course), |_: Cell| false);
    at_once(plan_area(
        &room(false),
        whole,
        departure,
        &mut StepBudget::unlimited(),
    ))
}

/// Distance of a place from the wall of the empty room.
fn off_wall_m(place: Point2) -> f64 {
    let (x, y) = (place.x_m / CELL_M + 5.0, place.y_m / CELL_M - 3.0);
    CELL_M * x.min(120.0 - x).min(y).min(100.0 - y)
}

#[test]
fn inwards_begins_at_the_wall_and_outwards_in_the_middle() {
    let middle = Point2 { x_m: 1.3, y_m: 1.3 };
    let wall = Point2 { x_m: 0.0, y_m: 0.2 };
    for start in [middle, wall] {
        let inwards = planned(Course::Inwards, start);
        let outwards = planned(Course::Outwards, start);
        // The way after the link to the first ring, and that before the lanes in the end.
        let early = |plan: &CoveragePlan| off_wall_m(plan.corners[4]);
        assert!(early(&inwards) < 0.3, "{:?}", inwards.corners);
        assert!(early(&outwards) > 0.7, "{:?}", outwards.corners);
        assert!(inwards.left_m2 < 0.02 * inwards.floor_m2 && outwards.left_m2 < 0.02 * outwards.floor_m2);
    }
}

#[test]
fn a_plan_made_in_steps_is_the_same() {
    let start = Pose2::default();
    let departure = Departure {
        start,
        settings: SETTINGS,
    };
    let in_steps = |budget: &mut StepBudget| {
        let whole = (|_: Cell| Some(Course::Inwards), |_: Cell| false);
        at_once(plan_area(&room(true), whole, departure, budget))
    };
    assert_eq!(
        in_steps(&mut StepBudget::unlimited()),
        in_steps(&mut StepBudget::limited())
    );
}
