//! The schedules as they are kept on a disk.

use std::collections::VecDeque;

use jiff::civil::Date;
use rvac_api::{QuietHours, ScheduleDecision, ScheduleEntry};
use serde::{Deserialize, Serialize};

use super::book::Decision;
use super::marks::{Mark, Marks};
use super::{Book, Entry, Outcome, Plan, ScheduleError, Verdict, from_api, to_api};

/// Version of this form. Raised when an older program would misread a newer file.
const VERSION: u32 = 2;
/// The oldest form that is still read: its entries have no floor.
const OLDEST: u32 = 1;

/// The schedules as they are kept on a disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredBook {
    version: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    zone: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    quiet: Option<QuietHours>,
    last_number: u32,
    entries: Vec<StoredEntry>,
    decisions: Vec<ScheduleDecision>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StoredEntry {
    number: u32,
    #[serde(flatten)]
    entry: ScheduleEntry,
    #[serde(default)]
    skip_next: bool,
    since_s: i64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    closed_until: Option<String>,
    closed: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    missed: Vec<String>,
}

/// Why what was kept cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StoredError {
    /// A newer program has written it.
    #[error("its form has the version {0}, this program knows {VERSION}")]
    Newer(u32),
    /// A part of it is wrong.
    #[error(transparent)]
    Wrong(#[from] ScheduleError),
    /// An unknown outcome.
    #[error("`{0}` is no outcome of a run")]
    Outcome(String),
}

impl From<&Book> for StoredBook {
    fn from(book: &Book) -> Self {
        Self {
            version: VERSION,
            zone: book.zone().map(|zone| zone.name().to_owned()),
            quiet: book.quiet().map(to_api::quiet_hours),
            last_number: book.last_number,
            entries: book.entries().map(StoredEntry::from).collect(),
            decisions: book.decisions.iter().map(to_api::decision).collect(),
        }
    }
}

impl From<&Entry> for StoredEntry {
    fn from(entry: &Entry) -> Self {
        let dates = |mark| entry.marks.dates(mark).map(|date| date.to_string()).collect();
        Self {
            number: entry.number,
            entry: entry.plan.to_api(),
            skip_next: entry.skip_next,
            since_s: entry.since_s,
            closed_until: entry.marks.closed_until().map(|date| date.to_string()),
            closed: dates(Mark::Closed),
            missed: dates(Mark::Missed),
        }
    }
}

impl TryFrom<StoredBook> for Book {
    type Error = StoredError;

    fn try_from(stored: StoredBook) -> Result<Self, StoredError> {
        if !(OLDEST..=VERSION).contains(&stored.version) {
            return Err(StoredError::Newer(stored.version));
        }
        let entries: Result<Vec<Entry>, StoredError> = stored.entries.into_iter().map(entry).collect();
        let decisions: Result<VecDeque<Decision>, StoredError> =
            stored.decisions.into_iter().map(decision).collect();
        let entries = entries?;
        let highest = entries.iter().map(|entry| entry.number).max().unwrap_or_default();
        let mut book = Self {
            zone: from_api::zone_named(stored.zone.as_deref())?,
            quiet: from_api::quiet_hours(stored.quiet.as_ref())?,
            last_number: stored.last_number.max(highest),
            entries,
            decisions: decisions?,
        };
        book.interrupt_starting();
        Ok(book)
    }
}

fn entry(stored: StoredEntry) -> Result<Entry, StoredError> {
    let dates = |texts: &[String], mark| -> Result<Vec<(Date, Mark)>, ScheduleError> {
        texts
            .iter()
            .map(|text| Ok((from_api::date(text)?, mark)))
            .collect()
    };
    let closed_until = stored.closed_until.as_deref().map(from_api::date).transpose()?;
    let mut marks = dates(&stored.missed, Mark::Missed)?;
    marks.extend(dates(&stored.closed, Mark::Closed)?);
    Ok(Entry {
        number: stored.number,
        plan: Plan::from_api(stored.entry)?,
        skip_next: stored.skip_next,
        since_s: stored.since_s,
        marks: Marks::restored(closed_until, marks.into_iter()),
    })
}

fn decision(stored: ScheduleDecision) -> Result<Decision, StoredError> {
    let outcome = match (stored.outcome.as_str(), stored.reason) {
        ("starting", _) => Outcome::Starting,
        ("fired", _) => Outcome::Fired,
        ("interrupted", _) => Outcome::Interrupted,
        ("skipped", _) => Outcome::Skipped,
        ("missed", _) => Outcome::Missed,
        ("quiet-hours", _) => Outcome::QuietHours,
        ("refused", Some(reason)) => Outcome::Refused(reason),
        _ => return Err(StoredError::Outcome(stored.outcome)),
    };
    Ok(Decision {
        verdict: Verdict {
            entry: stored.entry,
            date: from_api::date(&stored.date)?,
            outcome,
        },
        name: stored.name,
        at: stored.at,
    })
}
