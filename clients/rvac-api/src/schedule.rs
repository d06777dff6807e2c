//! Schedules: what starts by itself, when, and how it ended.
//!
//! Times of day are `HH:MM`, dates `YYYY-MM-DD`, both as clocks in the time zone of the robot show them. Instants are given as such
//! clocks show them, with their distance from UTC: `2026-11-23T07:30:00+02:00`.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{JobOrder, JobPart, NoGoShape};

/// Something that starts by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScheduleEntry {
    /// 1 to 40 characters, for people.
    pub name: String,
    /// Whether it starts anything.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// What starts.
    pub job: ScheduledJob,
    /// When.
    pub when: ScheduleTime,
    /// Up to so many minutes late it still starts when the daemon did not run, or had no robot, at its time; 0..=720. Later it
    /// is missed.
    #[serde(default)]
    pub late_min: u16,
    /// What happens when its time falls into the quiet hours.
    #[serde(default)]
    pub in_quiet: InQuiet,
    /// The floor in whose map its rooms, zones, spots and places to keep out of lie; on another one it does not start. Asked for
    /// without a floor, a job that names such places is for the floor on which the robot is then. Entries without a floor
    /// start on any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<u16>,
}

fn yes() -> bool {
    true
}

/// What a schedule starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScheduledJob {
    /// As [`crate::RequestBody::Start`].
    Start {
        /// Strategy by name; the configured default when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        strategy: Option<String>,
    },
    /// As [`crate::RequestBody::Clean`].
    Clean(JobOrder),
}

impl ScheduledJob {
    /// Whether it names places of a map, which are others on another floor.
    #[must_use]
    pub fn names_places(&self) -> bool {
        let (parts, avoid) = self.places();
        !(parts.is_empty() && avoid.is_empty())
    }

    /// The parts that it cleans, and what it keeps out of.
    #[must_use]
    pub fn places(&self) -> (&[JobPart], &[NoGoShape]) {
        match self {
            Self::Start { .. } => (&[], &[]),
            Self::Clean(order) => (&order.parts, &order.avoid),
        }
    }
}

/// When a schedule comes due.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScheduleTime {
    /// Every week.
    Weekly {
        /// On these days, at least one.
        days: Vec<Weekday>,
        /// Time of day.
        at: String,
    },
    /// On one day only.
    Once {
        /// Date.
        date: String,
        /// Time of day.
        at: String,
    },
}

/// Days of the week.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weekday {
    /// Monday.
    Mo,
    /// Tuesday.
    Tu,
    /// Wednesday.
    We,
    /// Thursday.
    Th,
    /// Friday.
    Fr,
    /// Saturday.
    Sa,
    /// Sunday.
    Su,
}

impl Weekday {
    /// All, from Monday.
    pub const ALL: [Self; 7] = [
        Self::Mo,
        Self::Tu,
        Self::We,
        Self::Th,
        Self::Fr,
        Self::Sa,
        Self::Su,
    ];
}

/// What happens to a run that would start in the quiet hours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InQuiet {
    /// It does not start.
    #[default]
    Refuse,
    /// It starts when they end.
    Wait,
}

/// Hours in which nothing starts by itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct QuietHours {
    /// Time of day at which they begin.
    pub from: String,
    /// Time of day at which they end; before `from`, the day after.
    pub to: String,
}

/// All schedules, and what is to be expected of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Schedules {
    /// Name of the time zone.
    pub zone: String,
    /// Whether a client has set it; else it is the system's.
    pub zone_is_set: bool,
    /// Date and time there, `2026-11-23T07:30`; absent while the clock is not set (`clock-not-set`), and then nothing starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock: Option<String>,
    /// Quiet hours, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quiet: Option<QuietHours>,
    /// The entries, by their numbers.
    pub entries: Vec<ScheduleView>,
    /// The next ten runs of all entries.
    pub next: Vec<PlannedRun>,
    /// What came of the last ones, newest first.
    pub decisions: Vec<ScheduleDecision>,
}

/// An entry as it is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScheduleView {
    /// Its number, from 1; never used twice.
    pub number: u32,
    /// What was asked for.
    #[serde(flatten)]
    pub entry: ScheduleEntry,
    /// Whether its next run is left out.
    pub skip_next: bool,
    /// Its next ten runs; none when it is not enabled.
    pub next: Vec<PlannedRun>,
    /// Why it would not start at this moment, for example `wheel-drop`; absent if it would.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refused_now: Option<String>,
}

/// A run that is to come.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedRun {
    /// Number of the entry.
    pub entry: u32,
    /// When it starts.
    pub at: String,
    /// What keeps it from starting: `skipped`, `quiet-hours`, or, were it to start now, `other-floor` or `map-not-taken-up`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_by: Option<String>,
    /// What lets it start later than its entry says: `quiet-hours`, `no-robot`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held_by: Option<String>,
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ScheduleDecision {
    /// Number of the entry.
    pub entry: u32,
    /// Its name then.
    pub name: String,
    /// The date to which the run belongs.
    pub date: String,
    /// When it was decided.
    pub at: String,
    /// `fired`, `skipped`, `missed`, `quiet-hours`, `refused`, `starting` (noted, not yet ordered), `interrupted` (the daemon
    /// ended between the two).
    pub outcome: String,
    /// Why it was refused, for example `job-runs`, `wheel-drop`, `no-robot`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}
