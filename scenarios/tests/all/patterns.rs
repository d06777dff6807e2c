//! Floor that is swept in rings instead of lanes.

use brain::command::StrategyName;
use brain::{Cell, Map};
use rvac_api::{CleaningPattern, RequestBody, RoomSettings};
use rvac_sim::run::{RunEnd, RunSettings, run_until};
use rvac_sim::{Host, Household, RunReport};
use scenarios::{household, scene, settings};

const MINUTE_MS: u64 = 60_000;

/// Rings may sweep less than lanes by this share: in five draws they swept between 0.003 less and 0.014 more.
const LESS: f64 = 0.02;

/// A job in the furnished room, which the robot knows.
fn swept_by(pattern: CleaningPattern) -> RunReport {
    let settings = RunSettings {
        strategy: StrategyName::Systematic,
        pattern: Some(pattern),
        ..settings(1, 30 * MINUTE_MS)
    };
    let mut household = household(&scene("furnished-room", "nominal"), &settings).with_known_map();
    run_until(&mut household, (&settings, RunEnd::JobOver), |_| {}).expect("a robot that answers")
}

#[test]
fn rings_sweep_as_much_of_a_furnished_room_as_lanes() {
    let (rings, lanes) = (
        swept_by(CleaningPattern::Contour),
        swept_by(CleaningPattern::Lines),
    );
    assert!(rings.covered > 0.95, "{} and {}", rings.covered, lanes.covered);
    assert!(
        rings.covered > lanes.covered - LESS,
        "{} and {}",
        rings.covered,
        lanes.covered
    );
    assert_eq!((rings.monitor_violations, lanes.monitor_violations), (0, 0));
    // It was another way.
    assert!((rings.path_m - lanes.path_m).abs() > 1.0);
}

fn map(household: &Household) -> &Map {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.map()
}

/// Share of the cells of a room that the last job has swept.
fn swept(household: &Household, room: u16) -> f64 {
    let labels = map(household).rooms().labels();
    let cells = labels
        .values()
        .iter()
        .enumerate()
        .filter(|(_, label)| **label == room);
    let cells: Vec<Cell> = cells.map(|(index, _)| labels.cell(index)).collect();
    let swept = cells.iter().filter(|cell| map(household).is_swept(cell.middle()));
    swept.count() as f64 / cells.len() as f64
}

#[test]
fn a_job_for_the_whole_home_sweeps_each_room_by_its_own_pattern() {
    let settings = settings(1, 0);
    let mut household = household(&scene("two-room-flat", "nominal"), &settings).with_known_map();
    household.pass_ms(3_000);
    let rooms: Vec<u16> = map(&household)
        .rooms()
        .rooms()
        .iter()
        .map(|room| room.id)
        .collect();
    household.ask(RequestBody::SetRoom {
        room: rooms[0],
        settings: Some(RoomSettings {
            pattern: CleaningPattern::Contour,
            ..RoomSettings::default()
        }),
        was: None,
    });
    household.pass_ms(1_000);
    household.ask(RequestBody::Start {
        strategy: Some(StrategyName::Systematic.name().to_owned()),
    });
    household.pass_ms(5_000);
    assert!(household.pass_until(60 * 60, Household::job_is_over).is_some());
    for room in rooms {
        // The border of a room may lie where the body cannot be.
        let share = swept(&household, room);
        assert!(share > 0.85, "{share} of room {room}");
    }
}
