//! Records of runs on disk: the folder `history` in the state folder, with one file for each run. Numbers rise, the highest is
//! the newest, and the oldest go when there are too many. A record is written once. The recordings of the runs are the
//! [`Library`](crate::recording::Library)'s; it may have removed them.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rvac_api::{RUN_PIECE_BYTES, Run, RunRecord, RunRecording, Update};
use serde::Deserialize;

use crate::numbered::number;
use crate::recording::Part;

/// Records kept.
const RUNS_MAX: usize = 200;
/// Largest file that is read. Pictures are bounded; a large home takes some hundred kilobytes.
const BYTES_MAX: u64 = 16 << 20;
/// Ending of the files.
const ENDING: &str = ".json";

/// The folder.
#[derive(Clone, Debug)]
pub(crate) struct RunFolder {
    path: PathBuf,
    recordings: PathBuf,
}

/// Why a client does not get what it asks for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RunError {
    /// There is none with this number.
    #[error("No run {0} is kept: ask which are. The last {RUNS_MAX} are kept.")]
    Absent(u64),
    /// It is there, but not whole.
    #[error("What is kept of run {number} cannot be read: {what}. It stays where it is, in {}.", .file.display())]
    Broken {
        /// Its number.
        number: u64,
        /// What is wrong.
        what: String,
        /// Where.
        file: PathBuf,
    },
    /// It has fewer recordings.
    #[error("Run {number} has {count} recordings, counted from 0.")]
    NoRecording {
        /// Its number.
        number: u64,
        /// How many it has.
        count: usize,
    },
    /// The recording was removed.
    #[error(
        "The recording {name} of run {number} was removed because newer ones took its place: raise recording.files or recording.total_mib in the configuration of vthal to keep more."
    )]
    Removed {
        /// Number of the run.
        number: u64,
        /// Name of the file.
        name: String,
    },
    /// The disk refuses.
    #[error("The recording cannot be read: {0}. Check the disk and the state folder.")]
    Unreadable(#[from] io::Error),
}

impl RunError {
    /// The reason's name for clients.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Absent(_) => "no-such-run",
            Self::Broken { .. } => "run-unreadable",
            Self::NoRecording { .. } => "no-such-recording",
            Self::Removed { .. } => "recording-removed",
            Self::Unreadable(_) => "recording-unreadable",
        }
    }
}

/// A file of the folder without what lists do not show.
#[derive(Deserialize)]
struct Head {
    run: Run,
}

/// What is counted of a record.
#[derive(Debug, Deserialize)]
pub(crate) struct CountedRun {
    /// The run.
    pub(crate) run: Run,
    /// Where it stopped.
    pub(crate) stops: Vec<CountedStop>,
}

/// What is counted of a stop.
#[derive(Debug, Deserialize)]
pub(crate) struct CountedStop {
    /// Its named reason.
    pub(crate) reason: String,
}

impl RunFolder {
    /// The folder at `path`, made with the first record, of runs that are recorded in `recordings`.
    pub(crate) fn new(path: PathBuf, recordings: PathBuf) -> Self {
        Self { path, recordings }
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Number of the newest run, 0 if there is none.
    pub(crate) fn newest(&self) -> u64 {
        self.numbers().first().copied().unwrap_or(0)
    }

    /// Whether there is a record of this number.
    pub(crate) fn has(&self, number: u64) -> bool {
        self.file(number).is_file()
    }

    /// Numbers of the records above this one, the lowest first.
    pub(crate) fn newer_than(&self, number: u64) -> Vec<u64> {
        let newest_first = self.numbers().into_iter();
        let mut newer: Vec<u64> = newest_first.take_while(|newer| *newer > number).collect();
        newer.reverse();
        newer
    }

    /// What is counted of a run.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn counted(&self, number: u64) -> Result<CountedRun, RunError> {
        self.load(number)
    }

    /// Keeps a record.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn keep(&self, record: &RunRecord) -> io::Result<()> {
        fs::create_dir_all(&self.path)?;
        let text = serde_json::to_vec(record).map_err(io::Error::other)?;
        kept_file::replace(&self.file(record.run.number), &text)?;
        for oldest in self.numbers().iter().skip(RUNS_MAX) {
            fs::remove_file(self.file(*oldest))?;
        }
        Ok(())
    }

    /// All that is kept of a run.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn show(&self, number: u64) -> Result<RunRecord, RunError> {
        let mut record: RunRecord = self.load(number)?;
        self.look_for_recordings(&mut record.run);
        Ok(record)
    }

    /// Runs with lower numbers than `before`, newest first. One that cannot be read is left out; who asks for it by its number
    /// is given the reason.
    pub(crate) fn list(&self, before: Option<u64>, count: usize) -> Update {
        let numbers = self.numbers();
        let older = numbers
            .iter()
            .filter(|number| before.is_none_or(|before| **number < before));
        let mut runs: Vec<Run> = Vec::new();
        let mut more = false;
        for number in older {
            if runs.len() == count {
                more = true;
                break;
            }
            if let Ok(Head { mut run }) = self.load(*number) {
                self.look_for_recordings(&mut run);
                runs.push(run);
            }
        }
        Update::Runs { runs, more }
    }

    /// Fills in how large the recordings are that are still there.
    pub(crate) fn look_for_recordings(&self, run: &mut Run) {
        for recording in &mut run.recordings {
            let file = self.recording(&recording.name);
            recording.bytes = file
                .and_then(|file| fs::metadata(file).ok())
                .map(|meta| meta.len());
        }
    }

    /// The file of a recording. A name that leads elsewhere is none.
    fn recording(&self, name: &str) -> Option<PathBuf> {
        let is_plain = Path::new(name).file_name().is_some_and(|plain| plain == name);
        is_plain.then(|| self.recordings.join(name))
    }

    /// Whether a run has one recording, and that was ended with its index.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn has_one_with_its_end(&self, number: u64) -> Result<bool, RunError> {
        let Head { run } = self.load(number)?;
        let [recording] = run.recordings.as_slice() else {
            return Ok(false);
        };
        let mut end = [0; mcap::MAGIC.len()];
        let mut read_end = |file: PathBuf| {
            let mut file = File::open(file)?;
            const END: SeekFrom = SeekFrom::End(-(mcap::MAGIC.len() as i64));
            file.seek(END)?;
            file.read_exact(&mut end)
        };
        let is_read = self
            .recording(&recording.name)
            .is_some_and(|file| read_end(file).is_ok());
        Ok(is_read && end == mcap::MAGIC)
    }

    /// Opens a recording of a run.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn open(&self, number: u64, index: usize) -> Result<Part<File>, RunError> {
        let Head { run } = self.load(number)?;
        let count = run.recordings.len();
        let recording = run.recordings.into_iter().nth(index);
        self.part(number, recording.ok_or(RunError::NoRecording { number, count })?)
    }

    /// Opens those recordings of a run that were not removed, of which there is one at least.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn open_all(&self, number: u64) -> Result<Vec<Part<File>>, RunError> {
        let Head { run } = self.load(number)?;
        let mut parts = Vec::new();
        let mut missing = RunError::NoRecording { number, count: 0 };
        for recording in run.recordings {
            match self.part(number, recording) {
                Ok(part) => parts.push(part),
                Err(removed @ RunError::Removed { .. }) => missing = removed,
                Err(error) => return Err(error),
            }
        }
        if parts.is_empty() {
            return Err(missing);
        }
        Ok(parts)
    }

    fn part(&self, number: u64, recording: RunRecording) -> Result<Part<File>, RunError> {
        let RunRecording { name, zero_s, .. } = recording;
        match self.recording(&name).map(File::open) {
            Some(Ok(file)) => Ok(Part { name, zero_s, file }),
            Some(Err(error)) if error.kind() != io::ErrorKind::NotFound => Err(error.into()),
            _ => Err(RunError::Removed { number, name }),
        }
    }

    /// A piece of a recording.
    ///
    /// # Errors
    /// See [`RunError`].
    pub(crate) fn piece(&self, number: u64, index: usize, from: u64) -> Result<Update, RunError> {
        let Part { name, mut file, .. } = self.open(number, index)?;
        let size = file.metadata()?.len();
        file.seek(SeekFrom::Start(from.min(size)))?;
        let mut bytes = Vec::new();
        file.take(RUN_PIECE_BYTES).read_to_end(&mut bytes)?;
        Ok(Update::RunFile {
            number,
            name,
            from: from.min(size),
            size: Some(size),
            data: STANDARD.encode(bytes),
        })
    }

    /// The numbers that have files, the highest first. What a person named otherwise is not ours.
    fn numbers(&self) -> Vec<u64> {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return Vec::new();
        };
        let mut numbers: Vec<u64> = entries
            .flatten()
            .filter_map(|entry| number(entry.file_name().to_str()?, ENDING))
            .filter(|number| self.has(*number))
            .collect();
        numbers.sort_unstable_by(|one, other| other.cmp(one));
        numbers
    }

    fn file(&self, number: u64) -> PathBuf {
        self.path.join(format!("{number:06}{ENDING}"))
    }

    fn load<T: for<'text> Deserialize<'text>>(&self, number: u64) -> Result<T, RunError> {
        let file = self.file(number);
        let broken = |what: String| RunError::Broken {
            number,
            what,
            file: file.clone(),
        };
        let length = match fs::metadata(&file) {
            Ok(meta) => meta.len(),
            Err(_) => return Err(RunError::Absent(number)),
        };
        if length > BYTES_MAX {
            return Err(broken("it is larger than any record".to_owned()));
        }
        let text = kept_file::read(&file).map_err(|error| broken(error.to_string()))?;
        serde_json::from_slice(&text).map_err(|error| broken(error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use rvac_api::{RUN_PIECE_BYTES, RunRecord, Update};
    use vthal_core::RunTask;

    use super::{RUNS_MAX, RunError, RunFolder};
    use crate::lifetime_file::LifetimeFile;
    use crate::run_desk::RunDesk;

    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("vthal-history-{name}-{}", std::process::id()));
            fs::remove_dir_all(&path).ok();
            fs::create_dir_all(path.join("runs")).expect("creates");
            Self(path)
        }

        fn folder(&self) -> RunFolder {
            RunFolder::new(self.0.join("history"), self.0.join("runs"))
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).ok();
        }
    }

    fn record(number: u64) -> RunRecord {
        let text = r#"{"run":{"number":1,"job":"spot","by":"button","duration_s":60.0,"moving_s":50.0,"swept_m2":1.0,
            "path_m":9.0,"bumps":0,"result":"finished","reason":"finished","text":"Finished.","stop_count":0,
            "recordings":[{"name":"run-a.mcap","zero_s":3.5}]},"stops":[]}"#;
        let mut record: RunRecord = serde_json::from_str(text).expect("a record");
        record.run.number = number;
        record
    }

    fn answer(folder: &RunFolder, task: RunTask) -> Result<Update, RunError> {
        let lifetime = LifetimeFile::new(folder.path.join("statistics.json"), folder.clone());
        RunDesk::new(lifetime).answer(task)
    }

    fn numbers(update: Result<Update, RunError>) -> (Vec<u64>, bool) {
        match update {
            Ok(Update::Runs { runs, more }) => (runs.iter().map(|run| run.number).collect(), more),
            other => panic!("no list but {other:?}"),
        }
    }

    fn list(folder: &RunFolder, before: Option<u64>, count: u8) -> (Vec<u64>, bool) {
        numbers(answer(folder, RunTask::List { before, count }))
    }

    #[test]
    fn the_newest_come_first_page_by_page_and_the_oldest_go() {
        let scratch = Scratch::new("pages");
        let folder = scratch.folder();
        assert_eq!((folder.newest(), list(&folder, None, 5)), (0, (vec![], false)));
        let last = RUNS_MAX as u64 + 3;
        for number in 1..=last {
            folder.keep(&record(number)).expect("keeps");
        }
        assert_eq!(folder.newest(), last);
        assert_eq!(list(&folder, None, 2), (vec![last, last - 1], true));
        assert_eq!(list(&folder, Some(6), 2), (vec![5, 4], false));
        assert!(matches!(
            answer(&folder, RunTask::Show(3)),
            Err(RunError::Absent(3))
        ));
        assert!(matches!(answer(&folder, RunTask::Show(4)), Ok(Update::Run(_))));
    }

    #[test]
    fn a_damaged_record_is_left_out_and_reported_by_its_number() {
        let scratch = Scratch::new("damaged");
        let folder = scratch.folder();
        for number in 1..=3 {
            folder.keep(&record(number)).expect("keeps");
        }
        fs::write(folder.path().join("000002.json"), "{\"run\":{").expect("writes");
        fs::write(folder.path().join("notes.json"), "mine").expect("writes");
        assert_eq!(list(&folder, None, 9), (vec![3, 1], false));
        let error = answer(&folder, RunTask::Show(2)).expect_err("is damaged");
        assert_eq!(error.name(), "run-unreadable");
    }

    #[test]
    fn a_recording_comes_in_pieces_and_its_absence_is_reported() {
        let scratch = Scratch::new("pieces");
        let folder = scratch.folder();
        folder.keep(&record(1)).expect("keeps");
        let file = |recording, from| RunTask::File {
            number: 1,
            recording: Some(recording),
            from,
        };
        assert_eq!(
            answer(&folder, file(0, 0)).expect_err("is absent").name(),
            "recording-removed"
        );
        assert_eq!(
            answer(&folder, file(1, 0)).expect_err("is absent").name(),
            "no-such-recording"
        );
        let whole: Vec<u8> = (0..2 * RUN_PIECE_BYTES + 7).map(|byte| byte as u8).collect();
        fs::write(scratch.0.join("runs/run-a.mcap"), &whole).expect("writes");
        let mut got = Vec::new();
        loop {
            let Ok(Update::RunFile { size, data, from, .. }) = answer(&folder, file(0, got.len() as u64))
            else {
                panic!("no piece")
            };
            assert_eq!((size, from), (Some(whole.len() as u64), got.len() as u64));
            let piece = STANDARD.decode(data).expect("base 64");
            if piece.is_empty() {
                break;
            }
            got.extend(piece);
        }
        assert_eq!(got, whole);
        let Ok(Update::Run(shown)) = answer(&folder, RunTask::Show(1)) else {
            panic!("no record")
        };
        assert_eq!(shown.run.recordings[0].bytes, Some(whole.len() as u64));
    }

    #[test]
    fn a_name_that_leads_elsewhere_is_no_recording() {
        let scratch = Scratch::new("elsewhere");
        fs::write(scratch.0.join("secret"), "x").expect("writes");
        let folder = scratch.folder();
        for name in ["../secret", "/etc/hostname", "..", ""] {
            let mut wrong = record(1);
            wrong.run.recordings[0].name = name.to_owned();
            folder.keep(&wrong).expect("keeps");
            let task = RunTask::File {
                number: 1,
                recording: Some(0),
                from: 0,
            };
            assert_eq!(
                answer(&folder, task).expect_err("is none").name(),
                "recording-removed",
                "{name}"
            );
        }
    }
}
