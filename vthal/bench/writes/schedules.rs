//! Schedules: added, changed, removed.

use rvac_api::{RequestBody, ScheduleEntry, ScheduleTime, ScheduledJob, Topic, Update, Weekday};

use crate::life::{Kept, replaced};
use crate::store::{Change, Desk, Store};

/// Entries kept at a time.
const ENTRIES_MAX: usize = 6;

pub(crate) struct Schedules;

impl Store for Schedules {
    fn name(&self) -> &'static str {
        "schedules"
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        desk.look_at(Topic::Schedules)?;
        let entries = desk.wait("the schedules", |update| match update {
            Update::Schedules(schedules) => Some(schedules.entries),
            _ => None,
        })?;
        entries
            .into_iter()
            .map(|view| Ok((view.number.to_string(), serde_json::to_string(&view.entry)?)))
            .collect()
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        let newest = kept.keys().filter_map(|key| key.parse::<u32>().ok()).max();
        let entry = entry(number);
        let text = serde_json::to_string(&entry).ok();
        match newest {
            Some(of) if kept.len() >= ENTRIES_MAX || number.is_multiple_of(4) => Change {
                after: replaced(kept, Some(&of.to_string()), None),
                request: RequestBody::RemoveSchedule { number: of },
            },
            Some(of) if number % 4 == 1 => Change {
                after: replaced(kept, Some(&of.to_string()), text),
                request: RequestBody::ChangeSchedule {
                    number: of,
                    entry,
                    was: None,
                },
            },
            _ => Change {
                after: replaced(kept, None, text),
                request: RequestBody::AddSchedule(entry),
            },
        }
    }
}

/// One that starts nothing while it is looked at.
fn entry(number: u64) -> ScheduleEntry {
    ScheduleEntry {
        name: format!("Entry {number}"),
        enabled: false,
        job: ScheduledJob::Start { strategy: None },
        when: ScheduleTime::Weekly {
            days: vec![Weekday::Mo, Weekday::Fr],
            at: format!("{:02}:{:02}", number / 60 % 24, number % 60),
        },
        late_min: 30,
        in_quiet: rvac_api::InQuiet::Wait,
        floor: None,
    }
}
