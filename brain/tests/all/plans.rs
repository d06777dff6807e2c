//! Plans over known ground, and a robot that follows them in a paper world.

use crate::passed::passed;
use crate::plane::{BODY, Rectangle, Room, SPEEDS, World, config, run};
use brain::coverage::plan::{PlanSettings, plan_coverage};
use brain::{
    BehaviorState, Brain, CELL_M, Cell, CellKnowledge, JobCommand, Pose2, Raster, StoredMap, StrategyName,
};

const SETTINGS: PlanSettings = PlanSettings {
    swath_m: BODY.swath_m,
    sigma_m: 0.01,
    cruise_m_per_s: SPEEDS.cruise_m_per_s,
    turn_rad_per_s: SPEEDS.turn_max_rad_per_s,
    takes_along: true,
};

/// Cells of a hall with a wall in the middle that leaves a passage at one end.
fn hall(width: i32, height: i32) -> Raster<bool> {
    let mut ground = Raster::filled(Cell { x: -3, y: 4 }, width as usize, height as usize, true);
    for y in 0..height - 30 {
        for x in width / 2 - 8..width / 2 + 8 {
            if let Some(cell) = ground.get_mut(Cell { x: x - 3, y: y + 4 }) {
                *cell = false;
            }
        }
    }
    ground
}

fn start() -> Pose2 {
    Pose2 {
        x_m: 0.2,
        y_m: 0.3,
        heading_rad: 1.0,
    }
}

#[test]
fn a_plan_passes_all_floor_in_little_more_than_the_least_time() {
    let ground = hall(200, 120);
    let plan = plan_coverage(&ground, |_| false, start(), &SETTINGS);
    assert!(passed(&plan, &ground) > 0.98, "{}", passed(&plan, &ground));
    let least_s = plan.floor_m2 / (SETTINGS.swath_m * SETTINGS.cruise_m_per_s);
    assert!(
        plan.time_s < 1.6 * least_s,
        "{} s, at least {least_s} s",
        plan.time_s
    );
    assert!(plan.left_m2 < 0.02 * plan.floor_m2, "{plan:?}");
}

#[test]
fn the_way_stays_on_free_cells() {
    let ground = hall(200, 120);
    let plan = plan_coverage(&ground, |_| false, start(), &SETTINGS);
    let first = plan
        .segments
        .iter()
        .position(|segment| segment.length_m > 0.0)
        .unwrap();
    for segment in &plan.segments[first..] {
        for step in 0..=20 {
            let place = segment.at(f64::from(step) / 20.0).position();
            // An arc may cut the corner of a cell.
            let near = [
                (0.0, 0.0),
                (0.02, 0.02),
                (-0.02, 0.02),
                (0.02, -0.02),
                (-0.02, -0.02),
            ];
            let free = near.iter().any(|(x_m, y_m)| {
                let cell = Cell::under(brain::Point2 {
                    x_m: place.x_m + x_m,
                    y_m: place.y_m + y_m,
                });
                ground.get(cell) == Some(&true)
            });
            assert!(free, "{place:?} on {segment:?}");
        }
    }
}

#[test]
fn a_plan_for_the_rest_leaves_the_swept_part_alone() {
    let ground = hall(200, 120);
    let left_half = |cell: Cell| cell.x < 97;
    let plan = plan_coverage(&ground, left_half, start(), &SETTINGS);
    let whole = plan_coverage(&ground, |_| false, start(), &SETTINGS);
    assert!(
        plan.time_s < 0.65 * whole.time_s,
        "{} of {}",
        plan.time_s,
        whole.time_s
    );
    assert!(
        (plan.share_passed() - 0.5).abs() < 0.05,
        "{}",
        plan.share_passed()
    );
}

#[test]
fn nothing_to_sweep_gives_no_way() {
    let ground = hall(60, 60);
    assert_eq!(plan_coverage(&ground, |_| true, start(), &SETTINGS).lanes, 0);
    let walls = Raster::filled(Cell::default(), 40, 40, false);
    let plan = plan_coverage(&walls, |_| false, start(), &SETTINGS);
    assert_eq!((plan.segments.len(), plan.floor_m2), (0, 0.0));
    let nothing = Raster::filled(Cell::default(), 0, 0, true);
    assert_eq!(plan_coverage(&nothing, |_| false, start(), &SETTINGS).lanes, 0);
}

fn furnished() -> Room {
    let leg = |x: f64, y: f64| Rectangle::new((x, y), (x + 0.05, y + 0.05));
    Room::empty((4.0, 5.0)).with(&[
        Rectangle::new((0.0, 3.6), (1.8, 5.0)),
        Rectangle::new((3.4, 0.5), (4.0, 2.0)),
        leg(1.2, 1.2),
        leg(2.2, 1.2),
        leg(1.2, 2.0),
        leg(2.2, 2.0),
    ])
}

/// The room as a map in the frame of a robot that starts at `start`, looking along x.
fn known(room: &Room, start: Pose2) -> StoredMap {
    let (width, height) = (
        (room.size_m.0 / CELL_M) as usize + 8,
        (room.size_m.1 / CELL_M) as usize + 8,
    );
    let origin = Cell {
        x: (-start.x_m / CELL_M) as i32 - 4,
        y: (-start.y_m / CELL_M) as i32 - 4,
    };
    let mut knowledge = Raster::filled(origin, width, height, CellKnowledge::Occupied);
    for index in 0..width * height {
        let cell = knowledge.cell(index);
        let (x_m, y_m) = (
            start.x_m + (f64::from(cell.x) + 0.5) * CELL_M,
            start.y_m + (f64::from(cell.y) + 0.5) * CELL_M,
        );
        let in_room = x_m > 0.0 && y_m > 0.0 && x_m < room.size_m.0 && y_m < room.size_m.1;
        let in_furniture = room
            .furniture
            .iter()
            .any(|piece| x_m > piece.low.0 && x_m < piece.high.0 && y_m > piece.low.1 && y_m < piece.high.1);
        if in_room && !in_furniture {
            knowledge.values_mut()[index] = CellKnowledge::Free;
        }
    }
    StoredMap::from_raster(&knowledge, None)
}

#[test]
fn a_known_room_is_covered_in_less_than_twice_the_least_time_and_the_job_ends() {
    let start = Pose2 {
        x_m: 2.6,
        y_m: 2.6,
        heading_rad: 0.0,
    };
    let room = furnished();
    let mut brain = Brain::with_map(config(), 1, &known(&room, start));
    let t0_s = room.size_m.0 * room.size_m.1 / (BODY.swath_m * SPEEDS.cruise_m_per_s);
    let mut world = World::new(room, start);
    let clean = JobCommand::Clean {
        strategy: StrategyName::Systematic,
    };
    run(&mut world, &mut brain, Some(clean), 1.7 * t0_s);
    assert!(world.covered() > 0.95, "{} {:?}", world.covered(), brain.status());
    run(&mut world, &mut brain, None, 2.0 * t0_s);
    assert_eq!(brain.status().state, BehaviorState::Idle, "{:?}", brain.status());
    assert_eq!(world.violations, Vec::<String>::new());
}
