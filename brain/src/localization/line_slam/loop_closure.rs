//! A lap that returns to its first wall: observations of a known landmark close the loop.

use crate::localization::Localization;
use crate::localization::known_home::{SimulatedRobot, TRACK_M, config, flat, take};
use crate::model::geometry::Pose2;
use core::f64::consts::FRAC_PI_2;

const STEP_M: f64 = 0.005;
const STEP_RAD: f64 = 0.024;
/// Distance that the wheels do not count, metres.
const SLIP_M: f64 = 0.08;

/// Straight on.
fn go(truth: &mut SimulatedRobot<'_>, localization: &mut Localization, distance_m: f64) {
    for _ in 0..(distance_m / STEP_M) as u32 {
        take(localization, truth.drive(STEP_M, 0.0));
    }
}

/// To the left, onto the next leg.
fn turn(truth: &mut SimulatedRobot<'_>, localization: &mut Localization) {
    let steps = (FRAC_PI_2 / STEP_RAD) as u32;
    for _ in 0..steps {
        take(localization, truth.drive(0.0, FRAC_PI_2 / f64::from(steps)));
    }
}

#[test]
fn a_lap_that_returns_to_its_first_wall_closes_the_loop() {
    let home = flat();
    let start = Pose2 {
        x_m: 0.7,
        y_m: 0.4,
        heading_rad: 0.0,
    };
    let mut truth = SimulatedRobot::new(&home, start);
    let mut localization = Localization::new(TRACK_M, 0.5);
    localization.place_at(start);
    localization.start_line_slam(&config());
    for leg_m in [2.6, 2.4, 2.9] {
        go(&mut truth, &mut localization, leg_m);
        turn(&mut truth, &mut localization);
    }
    go(&mut truth, &mut localization, 1.2);
    // It slips towards the first wall. No wall beside it shows that.
    truth.pose.y_m -= SLIP_M;
    go(&mut truth, &mut localization, 1.2);
    turn(&mut truth, &mut localization);
    let open_m = truth.off_m(&localization);
    assert!(open_m > 0.8 * SLIP_M, "{open_m} m off at the end of the lap");
    let graph = |localization: &Localization| {
        localization
            .estimator
            .first_run()
            .expect("line SLAM")
            .slam
            .graph
            .clone()
    };
    let lap = graph(&localization);
    go(&mut truth, &mut localization, 1.8);
    let closed_m = truth.off_m(&localization);
    assert!(closed_m < 0.5 * SLIP_M, "{closed_m} m off, {open_m} m before");
    let closed = graph(&localization);
    let first = lap.observations.first().map(|observation| observation.landmark);
    let later = closed
        .observations
        .iter()
        .filter(|observation| observation.node >= lap.nodes.len());
    let is_later = later
        .clone()
        .any(|observation| Some(observation.landmark) == first);
    assert!(
        is_later,
        "segments lie on the first landmark later: {:?}",
        later.collect::<Vec<_>>()
    );
}
