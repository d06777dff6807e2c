//! Records of runs of a whole system on a virtual clock: what people are told afterwards is what happened.

use rvac_api::{RequestBody, RunAsker, RunJob, RunRecord, RunResult, RunStop};
use rvac_sim::daily::MIDNIGHT_S;
use rvac_sim::{Host, Household};
use scenarios::{household, says, scene, settings};
use vthal_core::{Checkpoints, CoreConfig, cut_short};

/// Handshake and description.
const CONNECT_MS: u64 = 5_000;

/// A robot on its dock whose host keeps checkpoints and knows the time.
fn waiting() -> Household {
    let mut household = household(&scene("furnished-room", "nominal"), &settings(1, 0));
    household.kill_host().expect("lives");
    let host = Host::start(household.now_us(), config());
    household.revive_host(host);
    household.pass_ms(CONNECT_MS);
    let now_us = household.now_us();
    host_of(&mut household).set_wall(now_us, MIDNIGHT_S);
    household.pass_ms(1_000);
    household
}

fn config() -> CoreConfig {
    CoreConfig {
        checkpoints: Checkpoints::On,
        ..Host::config(1, brain::StrategyName::Bounce)
    }
}

fn host_of(household: &mut Household) -> &mut Host {
    household.host_mut().expect("lives")
}

fn state(household: &Household) -> String {
    household
        .host()
        .map(|host| host.status().state)
        .unwrap_or_default()
}

fn start(household: &mut Household) {
    household.ask(RequestBody::Start {
        strategy: Some("bounce".to_owned()),
    });
}

/// Lets time pass until the robot's state is this one.
fn pass_until(household: &mut Household, wanted: &str, at_most_ms: u64) {
    for _ in 0..at_most_ms / 100 {
        household.pass_ms(100);
        if state(household) == wanted {
            return;
        }
    }
    panic!("not {wanted} within {at_most_ms} ms but {}", state(household));
}

/// The record of the newest run.
fn last(household: &Household) -> RunRecord {
    let host = household.host().expect("lives");
    host.runs().last().expect("a run is kept").clone()
}

fn stops(record: &RunRecord) -> Vec<(String, String)> {
    let names = |stop: &RunStop| (stop.state.clone(), stop.reason.clone());
    record.stops.iter().map(names).collect()
}

fn told(state: &str, reason: &str) -> (String, String) {
    (state.to_owned(), reason.to_owned())
}

/// How far a place is from a straight way.
fn distance_m((from, to): ((f64, f64), (f64, f64)), place: (f64, f64)) -> f64 {
    let (along, apart) = (
        (to.0 - from.0, to.1 - from.1),
        (place.0 - from.0, place.1 - from.1),
    );
    let length2 = along.0 * along.0 + along.1 * along.1;
    let share = ((along.0 * apart.0 + along.1 * apart.1) / length2.max(1e-9)).clamp(0.0, 1.0);
    (apart.0 - share * along.0).hypot(apart.1 - share * along.1)
}

/// How long the disk may tell of a job after somebody has stopped it, milliseconds.
const STOPPED_MS: u64 = 200;

#[test]
fn a_power_cut_soon_after_stop_does_not_bring_the_job_back() {
    for after_ms in [3_000, 3_300, 3_700, 4_100, 9_000] {
        let mut household = waiting();
        household.ask(RequestBody::Start {
            strategy: Some("systematic".to_owned()),
        });
        household.pass_ms(after_ms);
        let has_job = |household: &Household| {
            let kept = household.host().and_then(Host::checkpoint);
            kept.is_some_and(|kept| kept.brain.job.is_some())
        };
        assert!(has_job(&household), "{after_ms} ms after the start");
        household.ask(RequestBody::Stop);
        household.pass_ms(STOPPED_MS);
        assert!(!has_job(&household), "stopped {after_ms} ms after the start");
    }
}

#[test]
fn a_run_that_a_person_pauses_and_stops_is_told_with_both() {
    let mut household = waiting();
    start(&mut household);
    household.pass_ms(40_000);
    household.ask(RequestBody::Pause);
    household.pass_ms(10_000);
    household.ask(RequestBody::Resume);
    household.pass_ms(30_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(4_000);
    assert!(
        household.host().expect("lives").runs().is_empty(),
        "it might go on"
    );
    household.pass_ms(2_000);
    let record = last(&household);
    let run = &record.run;
    assert_eq!(
        (run.number, run.result, run.reason.as_str()),
        (1, RunResult::Stopped, "command")
    );
    assert_eq!(run.by, RunAsker::Client("client-1".to_owned()));
    assert!(
        matches!(&run.job, RunJob::Clean { strategy, .. } if strategy == "bounce"),
        "{run:?}"
    );
    assert_eq!(run.start_s, Some(MIDNIGHT_S + 1));
    assert_eq!(run.end_s, Some(MIDNIGHT_S + 81));
    assert!((79.9..80.3).contains(&run.duration_s), "{}", run.duration_s);
    assert!(run.moving_s > 50.0 && run.moving_s < 70.0, "{}", run.moving_s);
    assert!(run.swept_m2 > 1.0 && run.path_m > 5.0, "{run:?}");
    assert_eq!(stops(&record), [told("paused", "command")]);
    let pause = &record.stops[0];
    assert!((39.9..40.3).contains(&pause.at_s), "{pause:?}");
    assert!(
        (9.9..10.3).contains(&pause.lasted_s.expect("it went on")),
        "{pause:?}"
    );
    assert_eq!(pause.by.as_deref(), Some("client-1"));
    let place = &pause.place;
    let picture = record.picture.expect("is drawn");
    assert!(picture.swept_rows.len() >= 3 && picture.path_mm.len() >= 4);
    let way: Vec<(f64, f64)> = picture
        .path_mm
        .chunks_exact(2)
        .map(|point| (f64::from(point[0]) / 1e3, f64::from(point[1]) / 1e3))
        .collect();
    let is_on_the_way = way
        .windows(2)
        .any(|leg| distance_m((leg[0], leg[1]), (place.x, place.y)) < 0.05);
    assert!(is_on_the_way, "{place:?}");
    let swept_m2: f64 = picture
        .swept_rows
        .chunks_exact(3)
        .map(|row| f64::from(row[2]))
        .sum::<f64>()
        * 0.025
        * 0.025;
    assert!(
        (swept_m2 - run.swept_m2).abs() < 0.01,
        "{swept_m2} {}",
        run.swept_m2
    );
}

#[test]
fn a_run_that_finishes_says_so() {
    let mut household = waiting();
    household.ask(RequestBody::Spot);
    pass_until(&mut household, "spot", 10_000);
    pass_until(&mut household, "idle", 600_000);
    household.pass_ms(6_000);
    let record = last(&household);
    assert_eq!(
        (record.run.result, record.run.reason.as_str()),
        (RunResult::Finished, "finished")
    );
    assert_eq!(record.run.job, RunJob::Spot);
    assert_eq!(record.run.text, "Finished.");
    household.ask(RequestBody::Dock);
    household.pass_ms(2_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let dock = last(&household);
    assert_eq!((dock.run.number, dock.run.job), (2, RunJob::Dock));
    let picture = dock.picture.expect("is drawn");
    assert!(picture.swept_rows.is_empty(), "what the spot swept is the spot's");
}

#[test]
fn a_robot_that_hangs_gives_up_and_says_why_and_where() {
    let mut household = waiting();
    start(&mut household);
    household.pass_ms(30_000);
    household.robot_mut().world_mut().lift();
    household.pass_ms(3_000);
    assert_eq!(state(&household), "paused");
    household.robot_mut().world_mut().put_down();
    household.pass_ms(2_000);
    household.ask(RequestBody::Resume);
    household.pass_ms(10_000);
    household.robot_mut().world_mut().turn_wheels(Some([0.0; 2]));
    let mut held_ms = 0;
    while !matches!(state(&household).as_str(), "stuck" | "error") {
        household.pass_ms(1_000);
        held_ms += 1_000;
        assert!(held_ms < 300_000, "it drives on: {}", state(&household));
    }
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let record = last(&household);
    assert_eq!(record.run.result, RunResult::GaveUp, "{:?}", record.run);
    let named = stops(&record);
    assert_eq!(named[0], told("paused", "wheel-drop"));
    let (state, reason) = named.last().expect("stops");
    assert!(matches!(state.as_str(), "stuck" | "error"), "{named:?}");
    assert_eq!(&record.run.reason, reason);
    assert!(record.run.text.starts_with("Gave up: "), "{}", record.run.text);
}

#[test]
fn a_crash_of_the_host_is_part_of_the_run_or_its_end() {
    let mut household = waiting();
    start(&mut household);
    household.pass_ms(40_000);
    let dead = household.kill_host().expect("lives");
    household.pass_ms(3_000);
    let found = dead.checkpoint().cloned().expect("a job runs");
    // A host that comes at once goes on.
    let next = CoreConfig {
        resume: Some(found.clone()),
        next_run: 2,
        ..config()
    };
    household.revive_host(Host::start(household.now_us(), next));
    household.pass_ms(30_000);
    assert_eq!(state(&household), "cleaning");
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let record = last(&household);
    assert_eq!((record.run.number, record.run.result), (1, RunResult::Stopped));
    assert_eq!(record.run.start_s, Some(MIDNIGHT_S + 1));
    assert_eq!(stops(&record), [told("daemon-ended", "restored")]);
    assert!(record.stops[0].lasted_s.is_some(), "it went on");
    assert!(record.run.duration_s > 60.0, "{}", record.run.duration_s);
    // One that comes too late keeps what was known.
    let cut = cut_short(found).expect("a run went on");
    assert_eq!(
        (cut.run.number, cut.run.result, cut.run.end_s),
        (1, RunResult::CutShort, None)
    );
    assert!(
        cut.run.duration_s > 35.0 && cut.run.swept_m2 > 0.5,
        "{:?}",
        cut.run
    );
    let picture = cut.picture.expect("is drawn");
    assert!(picture.path_mm.len() > 4 && picture.swept_rows.len() > 3);
}

#[test]
fn a_host_that_ends_in_good_order_ends_the_run_and_a_clock_that_is_not_set_is_not_made_up() {
    let mut household = household(&scene("furnished-room", "nominal"), &settings(1, 0));
    household.pass_ms(CONNECT_MS);
    let now_us = household.now_us();
    // A board without a battery for its clock wakes up in 1970.
    host_of(&mut household).set_wall(now_us, 100);
    start(&mut household);
    household.pass_ms(20_000);
    let now_us = household.now_us();
    host_of(&mut household).shut_down(now_us);
    let record = last(&household);
    assert_eq!(record.run.result, RunResult::DaemonEnded);
    assert_eq!((record.run.start_s, record.run.end_s), (None, None));
    assert!(
        (19.9..20.2).contains(&record.run.duration_s),
        "{}",
        record.run.duration_s
    );
}

#[test]
fn a_clock_that_is_set_on_the_way_tells_the_beginning_too() {
    let mut household = household(&scene("furnished-room", "nominal"), &settings(1, 0));
    household.pass_ms(CONNECT_MS);
    start(&mut household);
    household.pass_ms(20_000);
    let now_us = household.now_us();
    host_of(&mut household).set_wall(now_us, MIDNIGHT_S);
    household.pass_ms(10_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let run = last(&household).run;
    assert_eq!(
        (run.start_s, run.end_s),
        (Some(MIDNIGHT_S - 20), Some(MIDNIGHT_S + 10))
    );
}

#[test]
fn a_clock_that_is_set_back_in_a_job_is_told_and_the_run_ends_after_its_beginning() {
    let mut household = household(&scene("furnished-room", "nominal"), &settings(1, 0));
    household.pass_ms(CONNECT_MS);
    let noon_s = MIDNIGHT_S + 12 * 3_600;
    let now_us = household.now_us();
    host_of(&mut household).keep_log();
    host_of(&mut household).set_wall(now_us, noon_s);
    start(&mut household);
    household.pass_ms(20_000);
    let now_us = household.now_us();
    host_of(&mut household).set_wall(now_us, noon_s + 20 - 3_600);
    household.pass_ms(10_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(6_000);
    let run = last(&household).run;
    assert_eq!(
        (run.start_s, run.end_s, run.clock_set_s),
        (Some(noon_s - 3_600), Some(noon_s - 3_600 + 30), Some(-3_600))
    );
    assert!(says(
        &household,
        "the clock was set back by 60 min 0 s (clock-set)"
    ));
}
