//! Tests of a robot that drives in the map of its own earlier runs.

use super::known_home::{START, SimulatedRobot, config, flat, placed};
use crate::mapping::{CELL_M, CellKnowledge, Map, StoredMap};

/// Ten minutes.
const STEPS: u32 = 60 * 50 * 10;
const RUNS: u32 = 5;

/// Whether a run learns by the reference of earlier runs, or draws on and on in one grid.
#[derive(Clone, Copy)]
enum Learning {
    ByReference,
    DrawingOn,
}

/// A run in a stored home, from its start.
fn run(home: &Map, stored: &StoredMap, learning: Learning, number: u32) -> StoredMap {
    let mut map = Map::new(config().body, config().sensors);
    map.load(stored);
    if matches!(learning, Learning::DrawingOn) {
        map.draw_afresh();
    }
    let mut truth = SimulatedRobot::seeded(home, START, u64::from(number));
    let mut localization = placed(&map, START);
    for _ in 0..STEPS {
        let view = truth.step().clone();
        let advance = localization.update(&view);
        localization.refine(&view, advance);
        map.insert(&localization.estimate(), &view);
        if let Some(trust) = localization.place_trust() {
            map.note_trust(trust, view.time_us);
        }
    }
    map.stored()
}

/// Solid cells of the map on floor that is free in the home, square metres.
fn false_solid_m2(home: &Map, stored: &StoredMap) -> f64 {
    let knowledge = stored.knowledge();
    let solid = (0..knowledge.values().len())
        .filter(|index| knowledge.values()[*index] == CellKnowledge::Occupied)
        .map(|index| home.distance_field().at(knowledge.cell(index).middle()));
    solid.filter(|gap_m| *gap_m > CELL_M).count() as f64 * CELL_M * CELL_M
}

fn after_runs(learning: Learning) -> f64 {
    let home = flat();
    let mut stored = home.stored();
    for number in 1..=RUNS {
        stored = run(&home, &stored, learning, number);
    }
    false_solid_m2(&home, &stored)
}

#[test]
fn walls_get_no_thicker_with_the_runs() {
    let (by_reference, drawing_on) = (after_runs(Learning::ByReference), after_runs(Learning::DrawingOn));
    assert!(
        by_reference < 0.02 && by_reference < 0.5 * drawing_on,
        "{by_reference} m2 by reference, {drawing_on} m2 drawn on and on"
    );
}
