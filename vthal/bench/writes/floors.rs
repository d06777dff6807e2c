//! Floors of the home: begun, named, removed, brought back.

use rvac_api::{FloorView, RequestBody, Topic, Update};

use crate::life::{Kept, replaced};
use crate::store::{Change, Desk, Store};

/// Floors at a time, removed ones among them.
const FLOORS_MAX: usize = 5;

pub(crate) struct Floors;

impl Store for Floors {
    fn name(&self) -> &'static str {
        "floors"
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        desk.look_at(Topic::Floors)?;
        let floors = desk.wait("the floors", |update| match update {
            Update::Floors(view) => Some(view.floors),
            _ => None,
        })?;
        let told = |floor: FloorView| (floor.number.to_string(), text(&floor.title(), floor.removed));
        Ok(floors.into_iter().map(told).collect())
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        let of = |removed: bool| {
            let mut floors = kept
                .iter()
                .filter(move |(_, text)| text.ends_with(REMOVED) == removed);
            floors.next_back().and_then(|(key, _)| key.parse::<u16>().ok())
        };
        let (present, gone) = (of(false).unwrap_or(1), of(true));
        let is_last = kept.values().filter(|text| !text.ends_with(REMOVED)).count() < 2;
        let name = format!("Storey {number}");
        let key = |floor: u16| floor.to_string();
        let title = |floor: u16| {
            let text = kept.get(&key(floor)).map_or("", String::as_str);
            text.trim_end_matches(REMOVED).to_owned()
        };
        match (number % 4, gone) {
            (0, Some(floor)) => Change {
                after: replaced(kept, Some(&key(floor)), Some(text(&title(floor), false))),
                request: RequestBody::RestoreFloor { floor },
            },
            (1, _) if !is_last => Change {
                after: replaced(kept, Some(&key(present)), Some(text(&title(present), true))),
                request: RequestBody::RemoveFloor { floor: present },
            },
            (2, _) if kept.len() < FLOORS_MAX => Change {
                after: replaced(kept, None, Some(text(&name, false))),
                request: RequestBody::NewFloor { name: Some(name) },
            },
            _ => Change {
                after: replaced(kept, Some(&key(present)), Some(text(&name, false))),
                request: RequestBody::NameFloor {
                    floor: present,
                    name: Some(name),
                },
            },
        }
    }
}

const REMOVED: &str = ", removed";

fn text(title: &str, removed: bool) -> String {
    format!("{title}{}", if removed { REMOVED } else { "" })
}
