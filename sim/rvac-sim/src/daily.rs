//! What recurs each day in the homes of measurements.

use rvac_api::{InQuiet, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday};

/// Monday 2026-11-23, midnight UTC.
pub const MIDNIGHT_S: i64 = 1_795_392_000;

/// A job of the robot's choice, each day at this time.
#[must_use]
pub fn daily_job(name: &str, at: &str) -> ScheduleEntry {
    ScheduleEntry {
        name: name.to_owned(),
        enabled: true,
        job: ScheduledJob::Start { strategy: None },
        when: ScheduleTime::Weekly {
            days: Weekday::ALL.to_vec(),
            at: at.to_owned(),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    }
}
