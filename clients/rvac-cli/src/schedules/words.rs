//! Schedules in words.

use core::fmt::Write as _;

use rvac_api::{InQuiet, JobPart, PlannedRun, ScheduleTime, ScheduleView, ScheduledJob, Schedules, Weekday};

use crate::arguments::day_name;

/// All entries, each with its next run.
pub(super) fn list(schedules: &Schedules) -> String {
    let mut text = heading(schedules);
    if schedules.entries.is_empty() {
        text += "no schedules: `rvac schedule add` makes one\n";
    }
    for view in &schedules.entries {
        let state = if view.entry.enabled { "" } else { " (disabled)" };
        let next = match view.next.first() {
            Some(run) => format!("next {}", planned(run)),
            None if view.entry.enabled => "no upcoming runs".to_owned(),
            None => "starts nothing".to_owned(),
        };
        let ScheduleView { number, entry, .. } = view;
        line(
            &mut text,
            &format!(
                "{number:<3} {}{state}: {}, {}{}",
                entry.name,
                time(&entry.when),
                job(&entry.job),
                floor(entry.floor)
            ),
        );
        line(&mut text, &format!("    {next}"));
        if entry.late_min > 0 {
            line(&mut text, &format!("    up to {} min late", entry.late_min));
        }
        if entry.in_quiet == InQuiet::Wait {
            line(&mut text, "    waits for the end of the quiet hours");
        }
        if let Some(reason) = view.refused_now.as_ref().filter(|_| entry.enabled) {
            line(&mut text, &format!("    would not start now: {reason}"));
        }
    }
    text
}

/// The next runs of all.
pub(super) fn next(schedules: &Schedules) -> String {
    let mut text = heading(schedules);
    if schedules.next.is_empty() {
        text += "no upcoming runs\n";
    }
    for run in &schedules.next {
        let name = schedules.entries.iter().find(|view| view.number == run.entry);
        let name = name.map_or("", |view| view.entry.name.as_str());
        line(&mut text, &format!("{}  {:<3} {name}", planned(run), run.entry));
    }
    text
}

/// What came of runs, the newest last.
pub(super) fn past(schedules: &Schedules) -> String {
    let mut text = String::new();
    if schedules.decisions.is_empty() {
        text += "no past runs\n";
    }
    for past in schedules.decisions.iter().rev() {
        let why = past
            .reason
            .as_ref()
            .map(|reason| format!(" ({reason})"))
            .unwrap_or_default();
        line(
            &mut text,
            &format!(
                "{}  {:<3} {}: {}{why}",
                past.at, past.entry, past.name, past.outcome
            ),
        );
    }
    text
}

fn heading(schedules: &Schedules) -> String {
    let whose = if schedules.zone_is_set {
        "set"
    } else {
        "the system's"
    };
    let mut text = format!("time zone {} ({whose})", schedules.zone);
    match &schedules.clock {
        Some(clock) => text += &format!(", {} there\n", clock.replace('T', " ")),
        None => text += "; the clock is not set (clock-not-set), so nothing starts\n",
    }
    if let Some(quiet) = &schedules.quiet {
        line(&mut text, &format!("quiet hours {} to {}", quiet.from, quiet.to));
    }
    text
}

fn planned(run: &PlannedRun) -> String {
    match (&run.kept_by, &run.held_by) {
        (Some(reason), _) => format!("{} does not start: {reason}", run.at),
        (None, Some(reason)) => format!("{} after waiting: {reason}", run.at),
        (None, None) => run.at.clone(),
    }
}

fn time(when: &ScheduleTime) -> String {
    match when {
        ScheduleTime::Weekly { days, at } if days.len() == Weekday::ALL.len() => format!("daily at {at}"),
        ScheduleTime::Weekly { days, at } => {
            let names: Vec<&str> = days.iter().map(|day| day_name(*day)).collect();
            format!("{} at {at}", names.join(","))
        }
        ScheduleTime::Once { date, at } => format!("once, {date} at {at}"),
    }
}

fn job(job: &ScheduledJob) -> String {
    let order = match job {
        ScheduledJob::Start { strategy: None } => return "all".to_owned(),
        ScheduledJob::Start {
            strategy: Some(strategy),
        } => return format!("all, {strategy}"),
        ScheduledJob::Clean(order) => order,
    };
    let part = |part: &JobPart| match part {
        JobPart::Room(number) => format!("room {number}"),
        JobPart::Zone(_) => "a zone".to_owned(),
        JobPart::Place(number) => format!("place {number}"),
        JobPart::Spot([x, y]) => format!("a spot at {x:.2},{y:.2}"),
    };
    let parts: Vec<String> = order.parts.iter().map(part).collect();
    let parts = if parts.is_empty() {
        "all".to_owned()
    } else {
        parts.join(", ")
    };
    let passes = match order.passes {
        1 => String::new(),
        passes => format!(", {passes} times"),
    };
    format!("{parts}{passes}")
}

fn floor(number: Option<u16>) -> String {
    number
        .map(|number| format!(", on floor {number}"))
        .unwrap_or_default()
}

fn line(text: &mut String, line: &str) {
    // Writing to a string does not fail.
    writeln!(text, "{line}").ok();
}

#[cfg(test)]
mod tests {
    use super::{list, next, past};

    fn told() -> rvac_api::Schedules {
        let text = r#"{"zone":"Europe/Tallinn","zone_is_set":false,"clock":"2026-11-22T16:00",
            "quiet":{"from":"22:00","to":"07:00"},
            "entries":[{"number":3,"name":"Köök","job":{"clean":{"parts":[{"room":4}],"passes":2}},
                "when":{"weekly":{"days":["mo","fr"],"at":"06:30"}},"late_min":30,"in_quiet":"wait","floor":2,"skip_next":false,
                "next":[{"entry":3,"at":"2026-11-23T07:00:00+02:00","held_by":"quiet-hours"}],
                "refused_now":"wheel-drop"}],
            "next":[{"entry":3,"at":"2026-11-23T07:00:00+02:00","held_by":"quiet-hours"}],
            "decisions":[{"entry":3,"name":"Köök","date":"2026-11-20","at":"2026-11-20T07:00:00+02:00",
                "outcome":"refused","reason":"job-runs"}]}"#;
        serde_json::from_str(text).expect("is of the daemon's form")
    }

    #[test]
    fn schedules_are_shown_in_words() {
        assert_eq!(
            list(&told()),
            "time zone Europe/Tallinn (the system's), 2026-11-22 16:00 there\nquiet hours 22:00 to 07:00\n\
             3   Köök: mo,fr at 06:30, room 4, 2 times, on floor 2\n    next 2026-11-23T07:00:00+02:00 after waiting: quiet-hours\n    \
             up to 30 min late\n    waits for the end of the quiet hours\n    would not start now: wheel-drop\n"
        );
        assert!(next(&told()).ends_with("2026-11-23T07:00:00+02:00 after waiting: quiet-hours  3   Köök\n"));
        assert_eq!(
            past(&told()),
            "2026-11-20T07:00:00+02:00  3   Köök: refused (job-runs)\n"
        );
    }

    #[test]
    fn a_clock_that_is_not_set_is_shown() {
        let told = rvac_api::Schedules {
            zone: "UTC".to_owned(),
            ..rvac_api::Schedules::default()
        };
        assert!(list(&told).contains("clock-not-set"));
    }
}
