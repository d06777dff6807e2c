//! Schedules of a whole system on a virtual clock: one starts a job, and those that do not say why.

use brain::{BehaviorState, StoredMap, StrategyName};
use robot::RobotSettings;
use rvac_api::{JobOrder, JobPart, QuietHours, RequestBody, ScheduleDecision, ScheduleEntry, ScheduledJob};
use rvac_sim::daily::{MIDNIGHT_S, daily_job};
use rvac_sim::run::start_cleaning;
use rvac_sim::{Host, Household};
use scenarios::{household, in_phase, says, scene, settings};
use vthal_core::schedule::ZoneReading;
use vthal_core::{CoreConfig, Input, KeptFloor};

const DAY_S: i64 = 24 * 3_600;
/// Handshake and description.
const CONNECT_MS: u64 = 5_000;

fn entry(name: &str, at: &str) -> ScheduleEntry {
    ScheduleEntry {
        job: ScheduledJob::Start {
            strategy: Some("bounce".to_owned()),
        },
        ..daily_job(name, at)
    }
}

/// A robot that waits, whose host has these entries.
fn waiting(entries: &[ScheduleEntry]) -> Household {
    let mut household = household(&scene("furnished-room", "nominal"), &settings(1, 0));
    household.pass_ms(CONNECT_MS);
    set_clock(&mut household, 0);
    household.pass_ms(2_000);
    for entry in entries {
        household.ask(RequestBody::AddSchedule(entry.clone()));
    }
    assert_eq!(host(&mut household).schedules().entries.len(), entries.len());
    household
}

fn host(household: &mut Household) -> &mut Host {
    household.host_mut().expect("lives")
}

/// So many seconds after midnight, ten seconds before the minute.
fn set_clock(household: &mut Household, after_s: i64) {
    let now_us = household.now_us();
    host(household).set_wall(now_us, MIDNIGHT_S + after_s - 10);
}

/// Sets the clock ten seconds before a time, and lets it pass.
fn meet(household: &mut Household, (hour, minute): (i64, i64)) {
    set_clock(household, 3_600 * hour + 60 * minute);
    household.pass_ms(15_000);
}

fn state(household: &Household) -> String {
    household
        .host()
        .map(|host| host.status().state)
        .unwrap_or_default()
}

fn last(household: &mut Household) -> (String, String, Option<String>) {
    let past: Option<ScheduleDecision> = host(household).schedules().decisions.into_iter().next();
    let past = past.expect("something was decided");
    (past.name, past.outcome, past.reason)
}

fn told(name: &str, outcome: &str, reason: Option<&str>) -> (String, String, Option<String>) {
    (name.to_owned(), outcome.to_owned(), reason.map(str::to_owned))
}

#[test]
fn of_two_schedules_that_are_due_together_one_starts_and_the_other_says_that_it_did_not() {
    let mut household = waiting(&[entry("Kitchen", "08:00"), entry("Hall", "08:00")]);
    meet(&mut household, (8, 0));
    let decisions = host(&mut household).schedules().decisions.into_iter();
    let mut outcomes: Vec<_> = decisions
        .map(|decision| (decision.name, decision.outcome, decision.reason))
        .collect();
    outcomes.sort();
    assert_eq!(
        outcomes,
        [
            told("Hall", "refused", Some("job-runs")),
            told("Kitchen", "fired", None)
        ]
    );
    assert_eq!(state(&household), "cleaning");
}

#[test]
fn a_schedule_starts_a_job_and_others_are_kept_by_name() {
    let mut household = waiting(&[
        entry("Morning", "08:00"),
        entry("Busy", "08:01"),
        entry("Skipped", "09:00"),
        entry("Quiet", "13:30"),
        entry("Lifted", "16:00"),
        entry("Driven", "17:00"),
    ]);
    household.ask(RequestBody::SkipNext {
        number: 3,
        skip: true,
    });
    household.ask(RequestBody::SetQuiet {
        quiet: Some(QuietHours {
            from: "13:00".to_owned(),
            to: "15:00".to_owned(),
        }),
    });
    let kept: Vec<Option<String>> = host(&mut household)
        .schedules()
        .next
        .into_iter()
        .map(|run| run.kept_by)
        .collect();
    let expected = [None, None, Some("skipped"), Some("quiet-hours"), None, None];
    assert_eq!(kept[..6], expected.map(|reason| reason.map(str::to_owned)));

    meet(&mut household, (8, 0));
    assert_eq!(last(&mut household), told("Morning", "fired", None));
    assert_eq!(state(&household), "cleaning");
    household.pass_ms(60_000);
    assert_eq!(last(&mut household), told("Busy", "refused", Some("job-runs")));
    household.ask(RequestBody::Stop);
    meet(&mut household, (9, 0));
    assert_eq!(last(&mut household), told("Skipped", "skipped", None));
    meet(&mut household, (13, 30));
    assert_eq!(last(&mut household), told("Quiet", "quiet-hours", None));

    household.robot_mut().world_mut().lift();
    meet(&mut household, (16, 0));
    assert_eq!(
        last(&mut household),
        told("Lifted", "refused", Some("wheel-drop"))
    );
    household.robot_mut().world_mut().put_down();
    household.pass_ms(2_000);

    set_clock(&mut household, 17 * 3_600);
    for _ in 0..60 {
        household.ask(RequestBody::Drive {
            v: 0.0,
            w: 0.0,
            ttl: 400,
            clean: false,
            power: None,
        });
        household.pass_ms(250);
    }
    assert_eq!(
        last(&mut household),
        told("Driven", "refused", Some("driver-busy"))
    );
    assert_eq!(household.robot().monitor().violations(), []);
}

/// A job is under way when a run falls due: what the robot does about that job is the reason, and the job goes on.
#[test]
fn a_run_that_falls_due_during_a_job_says_what_the_robot_does() {
    let scene = scene("furnished-room", "nominal");
    let mut household = household(&scene, &settings(1, 0)).with_known_map();
    household.pass_ms(CONNECT_MS);
    set_clock(&mut household, 0);
    household.pass_ms(2_000);
    for (name, at) in [
        ("Cleans", "08:00"),
        ("Paused", "09:00"),
        ("Goes home", "10:00"),
        ("Charges", "11:00"),
        ("Charged", "12:00"),
    ] {
        household.ask(RequestBody::AddSchedule(entry(name, at)));
    }
    assert!(start_cleaning(&mut household, StrategyName::Systematic));
    household.pass_ms(20_000);
    let refused = |household: &mut Household, name: &str, hour: i64, reason: &str| {
        let before = state(household);
        meet(household, (hour, 0));
        assert_eq!(last(household), told(name, "refused", Some(reason)));
        assert_eq!(state(household), before, "{name}");
    };
    refused(&mut household, "Cleans", 8, "job-runs");
    household.ask(RequestBody::Pause);
    household.pass_ms(1_000);
    refused(&mut household, "Paused", 9, "job-paused");
    household.ask(RequestBody::Resume);
    household.pass_ms(15_000);
    // So low that the pack would not let a job start for some minutes on the dock.
    household.robot_mut().world_mut().set_battery_charge(0.12);
    let is = |state: BehaviorState| {
        move |household: &Household| {
            let brain = household.host().and_then(Host::brain).expect("a brain");
            brain.status().state == state
        }
    };
    assert!(household.pass_until(900, is(BehaviorState::Docking)).is_some());
    set_clock(&mut household, 10 * 3_600 + 9);
    household.pass_ms(2_000);
    assert_eq!(
        last(&mut household),
        told("Goes home", "refused", Some("drives-home"))
    );
    assert!(household.pass_until(600, is(BehaviorState::Docked)).is_some());
    refused(&mut household, "Charges", 11, "recharging");
    household.robot_mut().world_mut().set_charging_speed(20.0);
    household.pass_ms(120_000);
    refused(&mut household, "Charged", 12, "recharging");
    let decisions = host(&mut household).schedules().decisions;
    assert_eq!(decisions.len(), 5, "nothing is dropped: {decisions:?}");
    let goes_on = household.pass_until(2 * 3_600, is(BehaviorState::Cleaning));
    assert!(goes_on.is_some(), "{:?}", state(&household));
}

#[test]
fn a_run_starts_once_whatever_clock_and_host_do() {
    let mut household = waiting(&[entry("Morning", "08:00")]);
    meet(&mut household, (8, 0));
    assert_eq!(state(&household), "cleaning");
    household.ask(RequestBody::Stop);
    // The clock is set back, and later the host dies and another one comes.
    meet(&mut household, (8, 0));
    assert_eq!(state(&household), "idle");
    replace_host(&mut household);
    meet(&mut household, (8, 0));
    assert_eq!(state(&household), "idle");
    set_clock(&mut household, DAY_S + 8 * 3_600);
    household.pass_ms(15_000);
    assert_eq!(state(&household), "cleaning", "the next day has a run of its own");
}

#[test]
fn a_host_that_dies_between_note_and_start_has_not_started_and_does_not_later() {
    let mut household = waiting(&[entry("Morning", "08:00")]);
    host(&mut household).mute_disk();
    meet(&mut household, (8, 0));
    assert_eq!(
        state(&household),
        "docked",
        "nothing starts before the disk has the note"
    );
    replace_host(&mut household);
    assert_eq!(last(&mut household), told("Morning", "interrupted", None));
    meet(&mut household, (8, 0));
    assert_eq!(state(&household), "docked");
}

#[test]
fn nothing_starts_while_the_clock_is_not_set() {
    let mut household = waiting(&[entry("Morning", "08:00")]);
    let now_us = household.now_us();
    // A board without a battery for its clock wakes up in 1970.
    host(&mut household).set_wall(now_us, 8 * 3_600 - 10);
    household.pass_ms(15_000);
    let schedules = host(&mut household).schedules();
    assert_eq!((schedules.clock, schedules.decisions.len()), (None, 0));
    assert_eq!(state(&household), "docked");
}

/// The system says this of its time zone: a name, or why there is none.
fn read_zone(household: &mut Household, name: Result<&str, &str>) {
    let reading = ZoneReading {
        name: name.map(str::to_owned).map_err(str::to_owned),
        tried: None,
        wrong_variable: None,
    };
    let now_us = household.now_us();
    host(household).handle(now_us, Input::SystemZone(reading));
}

fn zone(household: &mut Household) -> String {
    host(household).schedules().zone
}

/// How often the log says this.
fn times_said(household: &mut Household, what: &str) -> usize {
    let lines = host(household).log().iter();
    lines.filter(|line| line.text.contains(what)).count()
}

#[test]
fn a_zone_that_is_changed_while_the_host_runs_moves_schedules_and_quiet_hours() {
    let mut household = waiting(&[entry("Morning", "08:00"), entry("Quiet", "13:30")]);
    host(&mut household).keep_log();
    read_zone(&mut household, Ok("Europe/Tallinn"));
    assert_eq!(
        times_said(&mut household, "zone"),
        0,
        "it is the zone of the start"
    );
    household.ask(RequestBody::SetQuiet {
        quiet: Some(QuietHours {
            from: "13:00".to_owned(),
            to: "15:00".to_owned(),
        }),
    });
    set_clock(&mut household, 3_600);
    household.pass_ms(2_000);
    read_zone(&mut household, Ok("Asia/Kolkata"));
    assert!(says(
        &household,
        "the system's time zone changed from Europe/Tallinn to Asia/Kolkata (zone-changed)"
    ));
    let shown = host(&mut household).schedules();
    assert_eq!(shown.clock.as_deref(), Some("2026-11-23T06:29"));
    assert_eq!(shown.next[0].at, "2026-11-23T08:00:00+05:30");
    meet(&mut household, (2, 30));
    assert_eq!(last(&mut household), told("Morning", "fired", None));
    household.ask(RequestBody::Stop);
    meet(&mut household, (6, 0));
    assert_eq!(
        host(&mut household).schedules().decisions.len(),
        1,
        "eight o'clock in the zone of before is no time of an entry"
    );
    meet(&mut household, (8, 0));
    assert_eq!(last(&mut household), told("Quiet", "quiet-hours", None));
}

#[test]
fn a_zone_that_is_changed_makes_up_for_nothing() {
    let late = ScheduleEntry {
        late_min: 720,
        ..entry("Morning", "08:00")
    };
    let mut household = waiting(&[]);
    read_zone(&mut household, Ok("America/New_York"));
    household.ask(RequestBody::AddSchedule(late));
    set_clock(&mut household, 6 * 3_600);
    household.pass_ms(2_000);
    // There it is half past eleven: the run of eight o'clock would be late, and was never to be.
    read_zone(&mut household, Ok("Asia/Kolkata"));
    household.pass_ms(30_000);
    assert_eq!(host(&mut household).schedules().decisions, []);
    assert_eq!(state(&household), "docked");
}

#[test]
fn a_zone_that_cannot_be_told_any_more_stays_and_is_named() {
    let mut household = waiting(&[entry("Morning", "08:00")]);
    host(&mut household).keep_log();
    read_zone(&mut household, Ok("Europe/Tallinn"));
    for _ in 0..3 {
        read_zone(&mut household, Err("there is no /etc/localtime"));
    }
    assert_eq!(zone(&mut household), "Europe/Tallinn");
    assert_eq!(
        times_said(
            &mut household,
            "(zone-unknown): there is no /etc/localtime; schedules are in Europe/Tallinn"
        ),
        1
    );
    read_zone(&mut household, Ok("Europe/Tallinn"));
    assert!(says(
        &household,
        "the system says its time zone again, Europe/Tallinn"
    ));
    read_zone(&mut household, Ok("Moon/Tranquility"));
    assert_eq!(zone(&mut household), "Europe/Tallinn");
    assert!(says(
        &household,
        "(zone-unknown): there is no time zone Moon/Tranquility"
    ));
}

#[test]
fn schedules_that_have_a_zone_of_their_own_stay_in_it() {
    let mut household = waiting(&[entry("Morning", "08:00")]);
    host(&mut household).keep_log();
    read_zone(&mut household, Ok("Europe/Tallinn"));
    household.ask(RequestBody::SetZone {
        zone: Some("Pacific/Auckland".to_owned()),
    });
    read_zone(&mut household, Ok("Asia/Kolkata"));
    assert_eq!(zone(&mut household), "Pacific/Auckland");
    assert!(says(
        &household,
        "to Asia/Kolkata (zone-changed); schedules stay in Pacific/Auckland"
    ));
    household.ask(RequestBody::SetZone { zone: None });
    assert_eq!(
        zone(&mut household),
        "Asia/Kolkata",
        "and then follow the system's"
    );
}

/// A room of the floor on which the robot is.
fn room_entry(household: &Household, at: &str) -> ScheduleEntry {
    let brain = household.host().and_then(Host::brain).expect("a brain");
    let room = brain.map().rooms().rooms()[0].id;
    let order = JobOrder {
        parts: vec![JobPart::Room(room)],
        ..JobOrder::default()
    };
    ScheduleEntry {
        job: ScheduledJob::Clean(order),
        ..entry("Room", at)
    }
}

fn map_of(name: &str) -> StoredMap {
    let mut household = household(&scene(name, "nominal"), &settings(1, 0)).with_known_map();
    household.pass_ms(3_000);
    let brain = household.host().and_then(Host::brain).expect("a brain");
    brain.map().stored()
}

/// A robot on the dock of the first of two floors.
fn at_home_with_two_floors() -> Household {
    let scene = scene("furnished-room", "nominal");
    let floors = (1..).zip(["furnished-room", "two-room-flat"]);
    let config = CoreConfig {
        sensors: scene.sensors(),
        floors: floors
            .map(|(number, name)| KeptFloor {
                home: Some(map_of(name)),
                ..KeptFloor::new(number)
            })
            .collect(),
        ..Host::config(5, brain::StrategyName::Systematic)
    };
    let robot = scene.robot_at(None, 5, &RobotSettings::default());
    let mut household = in_phase(Household::new(robot, Host::start(0, config)));
    household.pass_ms(CONNECT_MS);
    set_clock(&mut household, 0);
    household.pass_ms(2_000);
    household
}

fn say_floor(household: &mut Household, floor: u16) {
    household.ask(RequestBody::ChooseFloor { floor });
    household.pass_ms(5_000);
    assert_eq!(host(household).floors().here, Some(floor));
}

/// What would keep the next runs.
fn keeps(household: &mut Household) -> Vec<Option<String>> {
    let next = host(household).schedules().next.into_iter();
    next.map(|run| run.kept_by).collect()
}

#[test]
fn rooms_of_one_floor_are_cleaned_on_that_floor_only() {
    let mut household = at_home_with_two_floors();
    say_floor(&mut household, 1);
    let room = room_entry(&household, "08:00");
    household.ask(RequestBody::AddSchedule(room));
    let kept = host(&mut household).schedules().entries.remove(0);
    assert_eq!(kept.entry.floor, Some(1), "the floor where the robot was");
    assert!(keeps(&mut household).iter().all(Option::is_none));

    say_floor(&mut household, 2);
    let next = keeps(&mut household);
    assert!(next.len() == 10 && next.iter().all(|reason| reason.as_deref() == Some("other-floor")));
    meet(&mut household, (8, 0));
    assert_eq!(last(&mut household), told("Room", "refused", Some("other-floor")));
    household.ask(RequestBody::RunSchedule { number: 1 });
    household.pass_ms(15_000);
    assert_eq!(state(&household), "docked", "not by hand either");

    say_floor(&mut household, 1);
    household.ask(RequestBody::RunSchedule { number: 1 });
    household.pass_ms(15_000);
    assert_eq!(state(&household), "cleaning");
}

#[test]
fn an_entry_for_rooms_needs_a_floor_and_one_for_all_does_not() {
    let mut household = at_home_with_two_floors();
    assert_eq!(host(&mut household).floors().here, None);
    let room = ScheduleEntry {
        job: ScheduledJob::Clean(JobOrder {
            parts: vec![JobPart::Room(1)],
            ..JobOrder::default()
        }),
        ..entry("Room", "08:00")
    };
    household.ask(RequestBody::AddSchedule(room.clone()));
    assert_eq!(host(&mut household).schedules().entries, []);
    household.ask(RequestBody::AddSchedule(ScheduleEntry {
        floor: Some(2),
        ..room
    }));
    household.ask(RequestBody::AddSchedule(entry("All", "09:00")));
    let floors: Vec<Option<u16>> = host(&mut household)
        .schedules()
        .entries
        .iter()
        .map(|view| view.entry.floor)
        .collect();
    assert_eq!(floors, [Some(2), None]);
    let next = keeps(&mut household);
    assert_eq!(next[0].as_deref(), Some("map-not-taken-up"));
    assert_eq!(next[1], None);
}

fn replace_host(household: &mut Household) {
    let old = household.kill_host().expect("lives");
    let config = vthal_core::CoreConfig {
        schedules: old.kept_schedules(),
        ..Host::config(2, brain::StrategyName::Bounce)
    };
    household.revive_host(Host::start(household.now_us(), config));
    household.pass_ms(CONNECT_MS);
}
