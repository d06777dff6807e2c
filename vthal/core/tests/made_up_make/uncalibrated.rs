//! A robot on which nobody has measured anything yet: nothing sets it off, and it says why.

use jiff::civil::{Date, Time};
use rvac_api::{InQuiet, RequestBody, ScheduledJob, Topic, Update};
use vthal_core::CoreConfig;
use vthal_core::schedule::{Book, Plan, ScheduleEdit, When, Zone};

use super::Pair;
use super::robot::Robot;

const NOT_CALIBRATED: &str = "not-calibrated";

fn uncalibrated() -> Pair {
    let mut robot = Robot::new();
    robot.version = "1.0";
    let config = CoreConfig {
        schedules: mornings(),
        ..CoreConfig::default()
    };
    let mut pair = Pair::with(robot, config);
    pair.ask(RequestBody::Watch {
        topics: vec![Topic::Log],
    });
    pair
}

/// A schedule that somebody made before the robot was opened.
fn mornings() -> Book {
    let plan = Plan {
        name: "Mornings".to_owned(),
        enabled: true,
        job: ScheduledJob::Start { strategy: None },
        when: When::Once {
            date: Date::constant(2030, 1, 1),
            at: Time::constant(9, 0, 0, 0),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    };
    let mut book = Book::default();
    book.edit(ScheduleEdit::Add(plan), Zone::utc().at(0))
        .expect("is a plan");
    book
}

fn lines_about_calibration(pair: &Pair) -> usize {
    let lines = pair.updates.iter().filter(|update| match update {
        Update::Log(entry) => entry.text.contains("not calibrated"),
        _ => false,
    });
    lines.count()
}

#[test]
fn every_way_to_set_it_off_is_refused_by_that_name() {
    let mut pair = uncalibrated();
    let start = || RequestBody::Start { strategy: None };
    for body in [start(), RequestBody::Spot, RequestBody::Dock] {
        assert_eq!(pair.ask(body).as_deref(), Some(NOT_CALIBRATED));
    }
    for speed in [0.0, 0.1] {
        assert_eq!(pair.drive(speed).as_deref(), Some(NOT_CALIBRATED));
    }
    assert_eq!(
        pair.ask(RequestBody::RunSchedule { number: 1 }).as_deref(),
        Some(NOT_CALIBRATED)
    );
    pair.run_ms(5_000);
    assert!(pair.robot.stands() && !pair.robot.is_driven);
}

#[test]
fn it_is_told_in_the_status_and_once_in_the_log() {
    let mut pair = uncalibrated();
    assert!(pair.core.status().inhibits.contains(&NOT_CALIBRATED.to_owned()));
    pair.ask(RequestBody::Start { strategy: None });
    pair.run_ms(60_000);
    assert_eq!(lines_about_calibration(&pair), 1);
}

#[test]
fn measured_meanwhile_it_obeys() {
    let mut pair = uncalibrated();
    pair.robot.hears = false;
    pair.run_ms(5_000);
    pair.robot.version = "1.3";
    pair.robot.hears = true;
    pair.run_ms(5_000);
    assert!(pair.core.status().inhibits.is_empty(), "{:?}", pair.core.status());
    assert_eq!(pair.drive(0.0), None);
}
