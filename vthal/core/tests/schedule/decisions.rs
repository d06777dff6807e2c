//! What is decided, by name, and that the preview foretells it.

use jiff::civil::{date, time};
use rvac_api::InQuiet;
use vthal_core::schedule::{
    Blocker, Book, Days, EditError, Held, Outcome, Plan, Quiet, ScheduleEdit, When, Zone, planned, verdict,
};

use crate::{book, decide, instant, outcomes, plan, restarted};

const HOUR_S: i64 = 3_600;

fn tallinn() -> Zone {
    Zone::named("Europe/Tallinn").expect("known")
}

fn daily(hour: i8) -> Plan {
    let monday = date(2026, 11, 23);
    let days = (0..7).fold(Days::default(), |all, shift| {
        all.with(monday.saturating_add(jiff::Span::new().days(shift)).weekday())
    });
    plan(When::Weekly {
        days,
        at: time(hour, 0, 0, 0),
    })
}

/// A book with one entry at eight, made at six that morning, and eight o'clock.
fn at_eight(plan: Plan) -> (Book, Zone, i64) {
    let zone = tallinn();
    let eight = instant(&zone, date(2026, 11, 23), time(8, 0, 0, 0));
    (book(&[plan], &zone, eight - 2 * HOUR_S), zone, eight)
}

fn night(book: &mut Book, zone: &Zone, (from, to): (i8, i8)) {
    let quiet = Quiet::new(time(from, 0, 0, 0), time(to, 0, 0, 0));
    book.edit(ScheduleEdit::Quiet(quiet), zone.at(0))
        .expect("quiet hours");
}

#[test]
fn a_run_starts_once_and_on_time() {
    let (mut book, zone, eight) = at_eight(daily(8));
    assert!(decide(&mut book, &zone, eight - 1).is_empty());
    assert_eq!(outcomes(&decide(&mut book, &zone, eight)), [&Outcome::Starting]);
    for later_s in [0, 1, 100, HOUR_S, 20 * HOUR_S] {
        assert!(decide(&mut book, &zone, eight + later_s).is_empty());
    }
    assert_eq!(
        outcomes(&decide(&mut book, &zone, eight + 24 * HOUR_S)),
        [&Outcome::Starting]
    );
}

#[test]
fn a_run_that_nobody_was_there_for_is_missed_or_late() {
    let (book, zone, eight) = at_eight(daily(8));
    let woken = |minutes: i64, late_min| {
        let mut book = restarted(&book);
        let late = Plan { late_min, ..daily(8) };
        book.edit(ScheduleEdit::Change(1, late), zone.at(eight - HOUR_S))
            .expect("changes");
        decide(&mut book, &zone, eight + 60 * minutes)
            .first()
            .map(|verdict| verdict.outcome.clone())
    };
    assert_eq!(woken(2, 0), Some(Outcome::Starting), "systems stall for a moment");
    assert_eq!(woken(3, 0), Some(Outcome::Missed));
    assert_eq!(woken(60, 60), Some(Outcome::Starting));
    assert_eq!(woken(63, 60), Some(Outcome::Missed));
}

#[test]
fn what_was_due_before_it_was_wanted_does_not_start() {
    let zone = tallinn();
    let nine = instant(&zone, date(2026, 11, 23), time(9, 0, 0, 0));
    let late = Plan {
        late_min: 120,
        ..daily(8)
    };
    let mut made = book(core::slice::from_ref(&late), &zone, nine);
    assert!(decide(&mut made, &zone, nine + 1).is_empty());
    // Enabled again after its time, and moved to a zone in which its time was before.
    made.edit(ScheduleEdit::Enable(1, false), zone.at(nine))
        .expect("disables");
    made.edit(ScheduleEdit::Enable(1, true), zone.at(nine + 10))
        .expect("enables");
    assert!(decide(&mut made, &zone, nine + 11).is_empty());
    let east = Zone::named("Asia/Yekaterinburg").expect("known");
    let mut moved = book(&[late], &zone, nine - 3 * HOUR_S);
    moved
        .edit(ScheduleEdit::Zone(Some(east.clone())), zone.at(nine - 2 * HOUR_S))
        .expect("moves");
    assert!(decide(&mut moved, &east, nine - 2 * HOUR_S + 1).is_empty());
    // A clock that was wrong when the entry was made does not keep it for years.
    let mut future = book(&[daily(8)], &zone, nine + 100_000 * HOUR_S);
    assert!(decide(&mut future, &zone, nine).is_empty());
    assert_eq!(
        outcomes(&decide(&mut future, &zone, nine + 23 * HOUR_S)),
        [&Outcome::Starting]
    );
}

#[test]
fn the_next_run_is_skipped_once() {
    let (mut book, zone, eight) = at_eight(daily(8));
    book.edit(ScheduleEdit::SkipNext(1, true), zone.at(eight - 1))
        .expect("skips");
    let mut book = restarted(&book);
    assert_eq!(outcomes(&decide(&mut book, &zone, eight)), [&Outcome::Skipped]);
    assert!(decide(&mut book, &zone, eight + 1).is_empty());
    assert_eq!(
        outcomes(&decide(&mut book, &zone, eight + 24 * HOUR_S)),
        [&Outcome::Starting]
    );
}

#[test]
fn quiet_hours_refuse_or_put_off() {
    let (mut refusing, zone, eight) = at_eight(daily(8));
    night(&mut refusing, &zone, (22, 10));
    assert_eq!(
        outcomes(&decide(&mut refusing, &zone, eight)),
        [&Outcome::QuietHours]
    );
    let waits = Plan {
        in_quiet: InQuiet::Wait,
        ..daily(8)
    };
    let (mut waiting, zone, eight) = at_eight(waits);
    night(&mut waiting, &zone, (22, 10));
    let entry = waiting.entry(1).expect("is there").clone();
    let foretold = planned(&waiting, &entry, zone.at(eight + 60));
    assert_eq!(
        (foretold[0].start_s, foretold[0].held),
        (eight + 2 * HOUR_S, Some(Held::QuietHours))
    );
    for early_s in [0, HOUR_S, 2 * HOUR_S - 1] {
        assert!(decide(&mut waiting, &zone, eight + early_s).is_empty());
    }
    assert_eq!(
        outcomes(&decide(&mut waiting, &zone, eight + 2 * HOUR_S)),
        [&Outcome::Starting]
    );
}

#[test]
fn what_keeps_the_robot_has_its_name_and_a_robot_that_is_not_there_is_waited_for() {
    let (mut book, zone, eight) = at_eight(Plan {
        late_min: 10,
        ..daily(8)
    });
    let ask = |book: &Book, now_s, reason| {
        verdict(book, zone.at(now_s), |_| Err(reason)).map(|verdict| verdict.outcome)
    };
    assert_eq!(
        ask(&book, eight, "wheel-drop"),
        Some(Outcome::Refused("wheel-drop".to_owned()))
    );
    let gone = ["no-robot", "link-lost"];
    for reason in gone {
        assert_eq!(ask(&book, eight, reason), None);
    }
    let entry = book.entry(1).expect("is there").clone();
    assert_eq!(
        planned(&book, &entry, zone.at(eight + 60))[0].held,
        Some(Held::NoRobot)
    );
    for reason in gone {
        let gives_up = Some(Outcome::Refused(reason.to_owned()));
        assert_eq!(ask(&book, eight + 11 * 60 + 45, reason), gives_up);
    }
    assert_eq!(
        outcomes(&decide(&mut book, &zone, eight + 300)),
        [&Outcome::Starting]
    );
}

#[test]
fn two_that_are_due_together_are_decided_one_after_the_other() {
    let zone = tallinn();
    let eight = instant(&zone, date(2026, 11, 23), time(8, 0, 0, 0));
    let mut book = book(&[daily(8), daily(8)], &zone, eight - HOUR_S);
    let all = decide(&mut book, &zone, eight);
    let numbers: Vec<u32> = all.iter().map(|verdict| verdict.entry).collect();
    assert_eq!(numbers, [1, 2]);
}

#[test]
fn the_preview_is_what_then_happens() {
    let zone = tallinn();
    let start = instant(&zone, date(2026, 3, 20), time(3, 30, 0, 0));
    let waits = Plan {
        in_quiet: InQuiet::Wait,
        ..daily(3)
    };
    let once = plan(When::Once {
        date: date(2026, 3, 29),
        at: time(3, 30, 0, 0),
    });
    let mut book = book(&[daily(3), waits, once, daily(23)], &zone, start);
    night(&mut book, &zone, (22, 4));
    book.edit(ScheduleEdit::SkipNext(2, true), zone.at(start))
        .expect("skips");
    let mut foretold: Vec<(i64, u32, Outcome)> = Vec::new();
    let entries: Vec<_> = book.entries().cloned().collect();
    for entry in &entries {
        foretold.extend(planned(&book, entry, zone.at(start)).into_iter().map(|run| {
            let outcome = match run.kept {
                None => Outcome::Starting,
                Some(Blocker::Skipped) => Outcome::Skipped,
                Some(Blocker::QuietHours) => Outcome::QuietHours,
                Some(Blocker::Elsewhere(reason)) => Outcome::Refused(reason.to_owned()),
            };
            (run.start_s, run.entry, outcome)
        }));
    }
    let end = start + 9 * 24 * HOUR_S;
    foretold.retain(|(start_s, ..)| *start_s < end);
    foretold.sort_by_key(|(start_s, entry, _)| (*start_s, *entry));
    let mut happened = Vec::new();
    for now_s in (start..end).step_by(60) {
        let verdicts = decide(&mut book, &zone, now_s);
        happened.extend(
            verdicts
                .into_iter()
                .map(|verdict| (now_s, verdict.entry, verdict.outcome)),
        );
    }
    assert_eq!(happened, foretold);
    assert!(foretold.len() > 20);
}

#[test]
fn wrong_changes_are_refused_and_change_nothing() {
    let (mut book, zone, eight) = at_eight(daily(8));
    decide(&mut book, &zone, eight);
    let before = book.clone();
    let once = |day| {
        plan(When::Once {
            date: date(2026, 11, day),
            at: time(9, 0, 0, 0),
        })
    };
    let mut refused = |edit| {
        let error = book.edit(edit, zone.at(eight + 1)).expect_err("is wrong");
        assert_eq!(book, before);
        error
    };
    assert!(matches!(refused(ScheduleEdit::Add(once(22))), EditError::Past(_)));
    assert!(matches!(
        refused(ScheduleEdit::Change(1, once(23))),
        EditError::Decided { .. }
    ));
    let absent = refused(ScheduleEdit::Remove(7));
    assert_eq!(absent.to_string(), "There is no schedule 7: there are 1.");
    for _ in 1..32 {
        book.edit(ScheduleEdit::Add(daily(9)), zone.at(eight))
            .expect("has room");
    }
    assert_eq!(
        book.edit(ScheduleEdit::Add(daily(9)), zone.at(eight)),
        Err(EditError::Full)
    );
    book.edit(ScheduleEdit::Remove(32), zone.at(eight))
        .expect("removes");
    book.edit(ScheduleEdit::Add(daily(9)), zone.at(eight))
        .expect("has room");
    assert!(
        book.entry(32).is_err() && book.entry(33).is_ok(),
        "no number comes twice"
    );
}
