//! The schedules on disk: `schedules.json` in the state folder. What cannot be read is put aside, never overwritten.

use std::io;
use std::path::Path;

use kept_file::{Newest, newest_json};
use vthal_core::schedule::{Book, StoredBook};

/// What a daemon finds at its start.
#[derive(Debug, Default)]
pub(crate) struct FoundSchedules {
    /// The schedules.
    pub(crate) book: Book,
    /// The newest file was damaged, so it lacks the newest decisions about runs.
    pub(crate) distrusted: bool,
    /// What is wrong, for the log.
    pub(crate) complaints: Vec<String>,
}

/// Reads the newest file that is whole.
pub(crate) fn load(path: &Path) -> FoundSchedules {
    let Newest {
        value,
        mut complaints,
    } = newest_json::<StoredBook, _>(path, "the schedules");
    let distrusted = !complaints.is_empty();
    if distrusted && value.is_none() {
        let empty = "there are no schedules now: nothing starts by itself until somebody makes new ones";
        complaints.push(empty.to_owned());
    }
    FoundSchedules {
        book: value.unwrap_or_default(),
        distrusted,
        complaints,
    }
}

/// Keeps the schedules in place of those before.
///
/// # Errors
/// What the file system says.
pub(crate) fn save(path: &Path, book: &StoredBook) -> io::Result<()> {
    let text = serde_json::to_string_pretty(book).map_err(io::Error::other)?;
    kept_file::replace(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use rvac_api::{InQuiet, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday};
    use vthal_core::schedule::{Book, Plan, ScheduleEdit, StoredBook, Zone};

    use super::{load, save};

    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("vthal-schedules-{name}-{}", std::process::id()));
            fs::remove_dir_all(&path).ok();
            fs::create_dir_all(&path).expect("creates");
            Self(path)
        }

        fn file(&self) -> PathBuf {
            self.0.join("schedules.json")
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).ok();
        }
    }

    fn book(entries: usize) -> Book {
        let mut book = Book::default();
        for number in 0..entries {
            let plan = Plan::from_api(ScheduleEntry {
                name: format!("Köök {number}"),
                enabled: true,
                job: ScheduledJob::Start { strategy: None },
                when: ScheduleTime::Weekly {
                    days: vec![Weekday::Mo],
                    at: "07:30".to_owned(),
                },
                late_min: 5,
                in_quiet: InQuiet::Wait,
                floor: None,
            });
            let edit = ScheduleEdit::Add(plan.expect("a plan"));
            book.edit(edit, Zone::utc().at(1_800_000_000)).expect("adds");
        }
        book
    }

    #[test]
    fn what_was_kept_is_found() {
        let scratch = Scratch::new("kept");
        let nothing = load(&scratch.file());
        assert!(nothing.complaints.is_empty() && !nothing.distrusted);
        for entries in [1, 3] {
            save(&scratch.file(), &StoredBook::from(&book(entries))).expect("saves");
        }
        assert_eq!(load(&scratch.file()).book, book(3));
        // Power failed between the two names.
        fs::remove_file(scratch.file()).expect("removes");
        let found = load(&scratch.file());
        assert_eq!(found.book, book(1));
        assert!(!found.distrusted);
    }

    #[test]
    fn what_is_damaged_is_put_aside_and_its_predecessor_not_trusted_with_runs() {
        let scratch = Scratch::new("damaged");
        for _ in 0..2 {
            save(&scratch.file(), &StoredBook::from(&book(2))).expect("saves");
        }
        fs::write(scratch.file(), "{\"version\":1,").expect("writes");
        let found = load(&scratch.file());
        assert_eq!(found.book, book(2));
        assert!(found.distrusted && found.complaints.len() == 1, "{found:?}");
        let aside = scratch.0.join("schedules.json.damaged-1");
        assert_eq!(fs::read_to_string(aside).expect("is there"), "{\"version\":1,");
        let mut newer = serde_json::to_value(StoredBook::from(&book(1))).expect("is JSON");
        newer["version"] = 3.into();
        fs::write(scratch.file(), newer.to_string()).expect("writes");
        assert!(load(&scratch.file()).complaints[0].contains("version 3"));
        assert!(scratch.0.join("schedules.json.damaged-2").exists());
    }

    #[test]
    fn entries_from_before_floors_start_on_any_and_newer_ones_keep_theirs() {
        let file = |version: u32, floor: &str| {
            format!(
                r#"{{"version":{version},"last_number":1,"decisions":[],"entries":[{{"number":1,"name":"Room",
                "job":{{"clean":{{"parts":[{{"room":2}}]}}}},"when":{{"weekly":{{"days":["mo"],"at":"08:00"}}}},{floor}
                "since_s":0,"closed":[]}}]}}"#
            )
        };
        let scratch = Scratch::new("floors");
        for (text, expected) in [(file(1, ""), None), (file(2, r#""floor":2,"#), Some(2))] {
            fs::write(scratch.file(), text).expect("writes");
            let found = load(&scratch.file());
            assert!(found.complaints.is_empty(), "{:?}", found.complaints);
            let kept = found.book.entry(1).expect("is there").plan().floor;
            assert_eq!(kept, expected);
            save(&scratch.file(), &StoredBook::from(&found.book)).expect("writes");
            assert_eq!(load(&scratch.file()).book, found.book);
        }
    }
}
