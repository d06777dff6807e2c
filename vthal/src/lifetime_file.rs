//! What all runs come to on disk: `statistics.json` in the state folder.
//!
//! The sums are written after the record of a run. Runs whose records are newer than the sums are counted from their records, so a crash
//! in between counts none twice and leaves none out; so are all runs that are kept when there are no sums yet, or they were damaged.

use std::io;
use std::path::PathBuf;

use kept_file::{Newest, newest_json, replace_json};
use vthal_core::lifetime::{Lifetime, StoredLifetime};

use crate::run_folder::RunFolder;

/// The file, and the records from which it is brought up to date.
#[derive(Clone, Debug)]
pub(crate) struct LifetimeFile {
    path: PathBuf,
    runs: RunFolder,
}

impl LifetimeFile {
    /// The file at `path` for these runs; nothing is made before a run is kept.
    pub(crate) fn new(path: PathBuf, runs: RunFolder) -> Self {
        Self { path, runs }
    }

    /// The records.
    pub(crate) const fn runs(&self) -> &RunFolder {
        &self.runs
    }

    /// The sums as they were kept, and what is wrong with what was kept, for the log.
    pub(crate) fn load(&self) -> (Lifetime, Vec<String>) {
        let Newest {
            value,
            mut complaints,
        } = newest_json::<StoredLifetime, _>(&self.path, "the sums of all runs");
        if value.is_none() && !complaints.is_empty() {
            complaints
                .push("the sums of all runs begin again with the runs whose records are kept".to_owned());
        }
        (value.unwrap_or_default(), complaints)
    }

    /// The sums with all runs whose records are kept. One whose record cannot be read is not counted.
    pub(crate) fn up_to_date(&self) -> Lifetime {
        let (mut lifetime, complaints) = self.load();
        for complaint in complaints {
            tracing::error!(part = "vthal", "{complaint}");
        }
        for number in self.runs.newer_than(lifetime.newest()) {
            match self.runs.counted(number) {
                Ok(counted) => {
                    let stops = counted.stops.iter().map(|stop| stop.reason.as_str());
                    lifetime.count(&counted.run, stops);
                }
                Err(error) => tracing::warn!(part = "vthal", "not in the sums of all runs: {error}"),
            }
        }
        lifetime
    }

    /// Keeps the sums with all runs whose records are kept.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn keep(&self) -> io::Result<()> {
        replace_json(&self.path, &StoredLifetime::from(&self.up_to_date()))
    }
}

#[cfg(test)]
mod tests {
    use super::LifetimeFile;
    use crate::run_folder::RunFolder;
    use rvac_api::RunRecord;
    use std::fs;
    use vthal_bench::Scratch;

    fn record(number: u64) -> RunRecord {
        let text = r#"{"run":{"number":1,"job":"spot","by":"button","duration_s":60.0,"moving_s":50.0,"swept_m2":1.5,
            "path_m":9.0,"bumps":1,"result":"finished","reason":"finished","text":"Finished.","stop_count":1,"recordings":[]},
            "stops":[{"at_s":1.0,"state":"paused","reason":"command","text":"Paused.","place":{"x":0.0,"y":0.0,"heading":0.0,"t":1.0},
            "felt":[],"tried":[]}]}"#;
        let mut record: RunRecord = serde_json::from_str(text).expect("a record");
        record.run.number = number;
        record
    }

    struct Kept {
        _scratch: Scratch,
        folder: RunFolder,
        file: LifetimeFile,
    }

    fn kept() -> Kept {
        let scratch = Scratch::new().expect("creates");
        let folder = RunFolder::new(scratch.join("history"), scratch.join("runs"));
        let file = LifetimeFile::new(scratch.join("statistics.json"), folder.clone());
        Kept {
            _scratch: scratch,
            folder,
            file,
        }
    }

    fn clean_runs(file: &LifetimeFile) -> (u64, f64, u64) {
        let lifetime = file.up_to_date();
        let sums = lifetime.statistics();
        let count = |counts: &std::collections::BTreeMap<String, u64>, name| counts.get(name).copied();
        (
            count(&sums.runs, "spot").unwrap_or(0),
            sums.swept_m2,
            count(&sums.stops, "command").unwrap_or(0),
        )
    }

    #[test]
    fn the_sums_outlive_the_records_and_a_crash_between_both() {
        let Kept {
            folder,
            file,
            _scratch,
        } = kept();
        assert_eq!(clean_runs(&file), (0, 0.0, 0));
        for number in 1..=2 {
            folder.keep(&record(number)).expect("keeps");
            file.keep().expect("keeps");
        }
        fs::remove_file(folder.path().join("000001.json")).expect("is tidied away");
        folder.keep(&record(3)).expect("keeps");
        assert_eq!(
            clean_runs(&file),
            (3, 4.5, 3),
            "a crash came before the sums of run 3"
        );
        file.keep().expect("keeps");
        file.keep().expect("keeps");
        assert_eq!(clean_runs(&file), (3, 4.5, 3), "none is counted twice");
    }

    #[test]
    fn sums_that_cannot_be_are_put_aside_and_begin_again_with_what_is_kept() {
        let Kept {
            folder,
            file,
            _scratch,
        } = kept();
        folder.keep(&record(7)).expect("keeps");
        file.keep().expect("keeps");
        let path = _scratch.join("statistics.json");
        let text = fs::read_to_string(&path).expect("is there");
        fs::write(&path, text.replacen("1.5", "-1.5", 1)).expect("writes");
        let (_, complaints) = file.load();
        assert!(complaints[0].contains("the floor") && complaints[0].contains("is kept as"));
        assert!(complaints[1].contains("begin again"), "{complaints:?}");
        assert!(_scratch.join("statistics.json.damaged-1").exists());
        assert_eq!(clean_runs(&file), (1, 1.5, 1));
    }
}
