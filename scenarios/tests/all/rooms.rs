//! A room that a person splits: one half is cleaned, the home is mapped on, the host dies, and the room is still split.

use std::collections::BTreeSet;

use brain::command::StrategyName;
use brain::{Cell, Map};
use rvac_api::{JobOrder, JobPart, RequestBody, RoomSplitting};
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, scene, settings};
use vthal_core::stored_map;

const HOME: &str = "two-room-flat";
const MINUTE_MS: u64 = 60_000;

fn map(household: &Household) -> &Map {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.map()
}

fn ids(household: &Household) -> Vec<u16> {
    map(household)
        .rooms()
        .rooms()
        .iter()
        .map(|room| room.id)
        .collect()
}

/// Cells of a room.
fn cells_of(household: &Household, id: u16) -> BTreeSet<Cell> {
    let labels = map(household).rooms().labels();
    let places = labels.values().iter().enumerate();
    let inside = places.filter(|(_, label)| **label == id);
    inside.map(|(index, _)| labels.cell(index)).collect()
}

/// Share of `cells` that the last job has swept.
fn swept(household: &Household, cells: &BTreeSet<Cell>) -> f64 {
    let count = cells
        .iter()
        .filter(|cell| map(household).is_swept(cell.middle()))
        .count();
    count as f64 / cells.len() as f64
}

fn until_over(household: &mut Household, minutes: u64) {
    let over = household.pass_until(minutes * 60, Household::job_is_over);
    assert!(over.is_some(), "the job is not over after {minutes} minutes");
}

#[test]
fn a_split_room_stays_split_while_one_half_is_cleaned_the_home_mapped_on_and_the_host_killed() {
    let scene = scene(HOME, "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.pass_ms(3_000);
    let before = ids(&household);
    let largest = map(&household)
        .rooms()
        .rooms()
        .iter()
        .max_by(|one, other| one.area_m2.total_cmp(&other.area_m2))
        .copied()
        .expect("a home with rooms");
    // A line through its middle, from side to side.
    let (x, y) = (largest.middle.x_m, largest.middle.y_m);
    household.ask(RequestBody::SplitRoom(RoomSplitting {
        room: Some(largest.id),
        line: [[x, y - 6.0], [x, y + 6.0]],
    }));
    household.pass_ms(1_000);
    let split = ids(&household);
    assert_eq!(split.len(), before.len() + 1, "{before:?} {split:?}");
    let part = split
        .iter()
        .copied()
        .find(|id| !before.contains(id))
        .expect("a new room");
    let (half, rest) = (cells_of(&household, part), cells_of(&household, largest.id));

    household.ask(RequestBody::Clean(JobOrder {
        parts: vec![JobPart::Room(part)],
        ..JobOrder::default()
    }));
    household.pass_ms(5_000);
    until_over(&mut household, 60);
    let (done, beside) = (swept(&household, &half), swept(&household, &rest));
    // Furniture stands in both; the way to the half and its border may be swept beside it.
    assert!(
        done > 0.5 && beside < 0.35,
        "{done} of the half and {beside} of the rest"
    );
    assert_eq!(ids(&household), split);

    household.ask(RequestBody::Start {
        strategy: Some(StrategyName::Bounce.name().to_owned()),
    });
    household.pass_ms(10 * MINUTE_MS);
    assert_eq!(ids(&household), split, "mapped on by another job");

    let host = household.kill_host().expect("lives");
    let kept = host
        .brain()
        .map(|brain| stored_map::encode(&brain.map().stored()))
        .expect("a brain");
    let kept = stored_map::decode(&kept).expect("a good map");
    let mut household = scenarios::household(&scene, &settings(2, 0)).with_map(kept);
    household.pass_ms(3_000);
    assert_eq!(ids(&household), split, "in another host's hands");
    let again = cells_of(&household, part);
    let shared = again.intersection(&half).count() as f64 / half.len() as f64;
    assert!(shared > 0.8, "{shared} of the half is still in it");
}

#[test]
fn rooms_are_told_when_the_first_job_is_over_and_not_while_they_come_and_go() {
    let mut household = household(&scene(HOME, "nominal"), &settings(1, 0));
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    let told = |household: &Household| {
        let home = household.host().and_then(Host::home_view);
        home.expect("a home").rooms.len()
    };
    let mut found = 0;
    for _ in 0..6 {
        household.pass_ms(MINUTE_MS / 2);
        found = found.max(ids(&household).len());
        assert_eq!(told(&household), 0);
    }
    assert!(found > 0, "there was nothing to keep to itself");
    household.ask(RequestBody::Stop);
    household.pass_ms(3_000);
    assert_eq!(told(&household), ids(&household).len());
    assert!(told(&household) > 0);
}
