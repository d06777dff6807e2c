//! Past and coming runs as a calendar (RFC 5545), in UTC, so that no time zone has to be described.

use std::fmt::Write as _;

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::TimeZone;
use rvac_api::{Run, Schedules};

/// A run that is to come has no end; calendars want one.
const EXPECTED_MIN: i64 = 60;
/// Octets of a line, its end not counted (chapter 3.1).
const LINE_OCTETS_MAX: usize = 75;

/// The calendar.
pub(crate) fn calendar(name: &str, runs: &[Run], schedules: Option<&Schedules>) -> String {
    let mut text = String::new();
    line(&mut text, "BEGIN:VCALENDAR");
    line(&mut text, "VERSION:2.0");
    line(&mut text, "PRODID:-//LibreRVAC//rvac-hooks//EN");
    line(&mut text, &format!("X-WR-CALNAME:{}", escaped(name)));
    for run in runs {
        if let Some(event) = past(name, run) {
            event.write(&mut text);
        }
    }
    for event in schedules
        .into_iter()
        .flat_map(|schedules| coming(name, schedules))
    {
        event.write(&mut text);
    }
    line(&mut text, "END:VCALENDAR");
    text
}

struct Event {
    id: String,
    start: Timestamp,
    end: Timestamp,
    title: String,
    text: String,
}

fn past(name: &str, run: &Run) -> Option<Event> {
    let start = Timestamp::from_second(run.start_s?).ok()?;
    let end = run.end_s.and_then(|end_s| Timestamp::from_second(end_s).ok());
    Some(Event {
        id: format!("run-{}", run.number),
        start,
        end: end.filter(|end| *end > start).unwrap_or(start),
        title: format!("{name}: {:.1} m²", run.swept_m2),
        text: run.text.clone(),
    })
}

fn coming(name: &str, schedules: &Schedules) -> Vec<Event> {
    let zone = TimeZone::get(&schedules.zone).unwrap_or(TimeZone::UTC);
    let event = |run: &rvac_api::PlannedRun| {
        let at: DateTime = run.at.parse().ok()?;
        let start = zone.to_ambiguous_zoned(at).compatible().ok()?.timestamp();
        let entry = schedules.entries.iter().find(|entry| entry.number == run.entry);
        let what = entry.map_or_else(|| "cleaning".to_owned(), |entry| entry.entry.name.clone());
        Some(Event {
            id: format!("schedule-{}-{}", run.entry, start.as_second()),
            start,
            end: start
                .checked_add(jiff::SignedDuration::from_mins(EXPECTED_MIN))
                .ok()?,
            title: format!("{name}: {what}"),
            text: run.kept_by.clone().unwrap_or_default(),
        })
    };
    // A run that was left out is none.
    schedules
        .next
        .iter()
        .filter(|run| run.kept_by.is_none())
        .filter_map(event)
        .collect()
}

impl Event {
    fn write(&self, text: &mut String) {
        let utc = |time: Timestamp| time.strftime("%Y%m%dT%H%M%SZ").to_string();
        for part in [
            "BEGIN:VEVENT".to_owned(),
            format!("UID:{}@librervac", self.id),
            format!("DTSTAMP:{}", utc(self.start)),
            format!("DTSTART:{}", utc(self.start)),
            format!("DTEND:{}", utc(self.end)),
            format!("SUMMARY:{}", escaped(&self.title)),
            format!("DESCRIPTION:{}", escaped(&self.text)),
            "END:VEVENT".to_owned(),
        ] {
            line(text, &part);
        }
    }
}

fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for letter in text.chars() {
        match letter {
            '\\' | ';' | ',' => safe.extend(['\\', letter]),
            '\n' => safe.push_str("\\n"),
            letter if letter.is_control() => {}
            letter => safe.push(letter),
        }
    }
    safe
}

/// A line, folded where it is too long.
fn line(text: &mut String, content: &str) {
    let mut octets = 0;
    for letter in content.chars() {
        if octets + letter.len_utf8() > LINE_OCTETS_MAX {
            text.push_str("\r\n ");
            octets = 1;
        }
        octets += letter.len_utf8();
        // A text takes all that is written to it.
        let _never_fails = text.write_char(letter);
    }
    text.push_str("\r\n");
}

#[cfg(test)]
mod tests {
    use super::{calendar, line};

    #[test]
    fn lines_are_folded_between_letters_and_texts_escaped() {
        let mut text = String::new();
        line(&mut text, &"ä".repeat(80));
        assert!(text.lines().all(|line| line.len() <= 75), "{text}");
        assert_eq!(text.replace("\r\n ", "").trim_end(), "ä".repeat(80));
        let empty = calendar("Robo; the first", &[], None);
        assert!(empty.contains("X-WR-CALNAME:Robo\\; the first\r\n"), "{empty}");
    }
}
