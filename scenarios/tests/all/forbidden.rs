//! Floor that a person forbids while the robot cleans: the path that the robot follows must not lead through it any more.

use brain::Point2;
use brain::command::StrategyName;
use rvac_api::{NoGoShape, RequestBody};
use rvac_sim::Household;
use scenarios::{brain, household, scene, settings};

/// Half the side of the forbidden square, metres.
const HALF_M: f64 = 0.25;
/// The square is this far from the robot at least, so that it can still turn away, metres.
const AHEAD_M: f64 = 0.8;
/// The pose is known to some centimetres, and the robot follows its path to some more, metres.
const SLACK_M: f64 = 0.1;

/// A corner of the planned path that is far enough ahead.
fn ahead(household: &Household) -> Option<Point2> {
    let brain = brain(household);
    let here = brain.pose().position();
    let mut corners = brain.planned_path().corners.into_iter();
    corners.find(|corner| corner.distance_m(here) > AHEAD_M)
}

/// Lets the robot clean a known home until its path leads on, forbids floor there, and gives how near to the middle of that floor the
/// robot comes afterwards, metres.
fn nearest_m(seed: u64) -> f64 {
    let mut household = household(&scene("two-room-flat", "nominal"), &settings(seed, 0)).with_known_map();
    household.pass_ms(3_000);
    household.ask(RequestBody::Start {
        strategy: Some(StrategyName::Systematic.name().to_owned()),
    });
    household.pass_ms(60_000);
    let middle = (0..60)
        .find_map(|_| {
            household.pass_ms(1_000);
            ahead(&household)
        })
        .expect("a path");
    let Point2 { x_m, y_m } = middle;
    household.ask(RequestBody::AddNoGo {
        shape: NoGoShape::Zone(vec![
            [x_m - HALF_M, y_m - HALF_M],
            [x_m + HALF_M, y_m - HALF_M],
            [x_m + HALF_M, y_m + HALF_M],
            [x_m - HALF_M, y_m + HALF_M],
        ]),
        name: None,
    });
    let mut nearest_m = f64::INFINITY;
    for _ in 0..600 {
        household.pass_ms(200);
        nearest_m = nearest_m.min(brain(&household).pose().position().distance_m(middle));
    }
    nearest_m
}

#[test]
fn a_zone_that_is_forbidden_during_a_job_is_not_entered_by_the_path_that_was_planned_before() {
    for seed in [1, 2, 3] {
        let nearest_m = nearest_m(seed);
        assert!(
            nearest_m > HALF_M - SLACK_M,
            "seed {seed}: within {nearest_m} m of the middle of forbidden floor"
        );
    }
}
