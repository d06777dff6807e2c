//! A robot that is sent to a place: it drives there without cleaning, stands there, or says why not.

use brain::{BehaviorState, Brain, CellKnowledge, Point2, Reason};
use rvac_api::{NoGoShape, RequestBody};
use rvac_sim::Household;
use scenarios::{brain, generated, household, says, scene, settings};

/// Nearer than this it is there, metres: its place is known to some centimetres, and it stops within some more.
const THERE_M: f64 = 0.2;

fn go_to(household: &mut Household, place: Point2) {
    household.ask(RequestBody::GoTo {
        x: place.x_m,
        y: place.y_m,
    });
}

fn off_m(household: &Household, place: Point2) -> f64 {
    let truth = household.truth_in_map();
    (truth.x_m - place.x_m).hypot(truth.y_m - place.y_m)
}

/// The place of the map that is farthest from the robot and has free floor for so many metres around it.
fn far_place(brain: &Brain, clear_m: f64) -> Point2 {
    let knowledge = brain.map().knowledge();
    let is_free = |at: Point2| knowledge.get(brain::Cell::under(at)) == Some(&CellKnowledge::Free);
    let is_clear = |at: &Point2| {
        (0..16).all(|direction| {
            let (sin, cos) = (core::f64::consts::TAU * f64::from(direction) / 16.0).sin_cos();
            [0.5, 1.0].into_iter().all(|share| {
                is_free(Point2 {
                    x_m: at.x_m + share * clear_m * cos,
                    y_m: at.y_m + share * clear_m * sin,
                })
            })
        })
    };
    let from = brain.pose().position();
    let cells = (0..knowledge.values().len()).map(|index| knowledge.cell(index).middle());
    cells
        .filter(is_clear)
        .max_by(|one, other| one.distance_m(from).total_cmp(&other.distance_m(from)))
        .expect("the map has floor")
}

/// Whether brushes ran within so many seconds, in which the robot drove.
fn sweeps_within(household: &mut Household, seconds: u32) -> bool {
    (0..5 * seconds).any(|_| {
        household.pass_ms(200);
        brain(household).map().swept_m2() > 0.0
    })
}

#[test]
fn it_drives_to_the_place_without_cleaning_and_stands_there() {
    for (home, seed) in [(1, 1), (3, 2), (7, 3)] {
        let mut household = household(&generated(home), &settings(seed, 0)).with_known_map();
        household.pass_ms(3_000);
        let place = far_place(brain(&household), 0.3);
        go_to(&mut household, place);
        let began = household.pass_until(10, |household| {
            brain(household).status().state == BehaviorState::Going
        });
        assert!(began.is_some(), "home {home}: {:?}", brain(&household).status());
        assert!(!sweeps_within(&mut household, 5), "home {home}");
        let over = household.pass_until(300, |household| {
            brain(household).status().state == BehaviorState::Idle
        });
        assert!(over.is_some(), "home {home}: {:?}", brain(&household).status());
        assert_eq!(brain(&household).status().reason, Reason::Arrived, "home {home}");
        let off_m = off_m(&household, place);
        assert!(off_m < THERE_M, "home {home}: {off_m} m off");
        assert_eq!(brain(&household).map().swept_m2(), 0.0, "home {home}");
    }
}

/// In the flat of two rooms, with the robot on its dock and a place in the other room.
fn in_the_flat() -> (Household, Point2) {
    let mut household = household(&scene("two-room-flat", "nominal"), &settings(4, 0)).with_known_map();
    if let Some(host) = household.host_mut() {
        host.keep_log();
    }
    household.pass_ms(3_000);
    let place = far_place(brain(&household), 0.3);
    (household, place)
}

#[test]
fn it_goes_on_to_the_place_after_a_pause_and_sets_out_for_the_dock_from_there() {
    let (mut household, place) = in_the_flat();
    go_to(&mut household, place);
    household.pass_ms(10_000);
    household.ask(RequestBody::Pause);
    household.pass_ms(5_000);
    assert_eq!(brain(&household).status().state, BehaviorState::Paused);
    household.ask(RequestBody::Resume);
    let over = household.pass_until(120, |household| {
        brain(household).status().reason == Reason::Arrived
    });
    assert!(over.is_some(), "{:?}", brain(&household).status());
    assert!(off_m(&household, place) < THERE_M);
    household.ask(RequestBody::Dock);
    let home = household.pass_until(240, |household| {
        brain(household).status().state == BehaviorState::Docked
    });
    assert!(home.is_some(), "{:?}", brain(&household).status());
}

#[test]
fn a_place_that_cannot_be_reached_is_refused_by_name() {
    let (mut household, place) = in_the_flat();
    for far_m in [40.0, 1e300] {
        let (x_m, y_m) = (far_m, -far_m);
        go_to(&mut household, Point2 { x_m, y_m });
        household.pass_ms(500);
        assert!(says(&household, "no-floor-there"), "{far_m} m");
        assert_eq!(brain(&household).status().state, BehaviorState::Docked);
    }
    let Point2 { x_m, y_m } = brain(&household).map().rooms().doors()[0].at;
    household.ask(RequestBody::AddNoGo {
        shape: NoGoShape::Wall([[x_m, y_m - 1.0], [x_m, y_m + 1.0]]),
        name: None,
    });
    household.pass_ms(1_000);
    go_to(&mut household, place);
    household.pass_ms(500);
    assert!(says(&household, "virtual-wall-in-the-way"));
    assert_eq!(brain(&household).status().state, BehaviorState::Docked);
}
