//! Schedules of a whole system on a virtual clock: one starts a job, and those that do not say why.

use rvac_api::{
    InQuiet, QuietHours, RequestBody, ScheduleDecision, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday,
};
use rvac_sim::run::household;
use rvac_sim::{Host, Household};
use scenarios::{scene, settings};

/// Monday 2026-11-23, midnight UTC.
const MIDNIGHT_S: i64 = 1_795_392_000;
const DAY_S: i64 = 24 * 3_600;
/// Handshake and description.
const CONNECT_MS: u64 = 5_000;

fn entry(name: &str, at: &str) -> ScheduleEntry {
    ScheduleEntry {
        name: name.to_owned(),
        enabled: true,
        job: ScheduledJob::Start {
            strategy: Some("bounce".to_owned()),
        },
        when: ScheduleTime::Weekly {
            days: Weekday::ALL.to_vec(),
            at: at.to_owned(),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
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

fn replace_host(household: &mut Household) {
    let old = household.kill_host().expect("lives");
    let config = vthal_core::CoreConfig {
        schedules: old.kept_schedules(),
        ..Host::config(2, brain::StrategyName::Bounce)
    };
    household.revive_host(Host::start(household.now_us(), config));
    household.pass_ms(CONNECT_MS);
}
