//! What the daemon keeps in its state folder: where each thing lies, what a new daemon begins with, and how it is replaced.

use std::io;
use std::path::{Path, PathBuf};

use rvac_api::{Run, RunRecord};
use vthal_core::health::StoredHealth;
use vthal_core::learnt::StoredLearnings;
use vthal_core::{Checkpoint, CoreConfig, FloorHome, cut_short};

use crate::checkpoint_file::{self, BootTime, Found};
use crate::floor_folder::FloorFolder;
use crate::health_file;
use crate::learnt_file;
use crate::lifetime_file::LifetimeFile;
use crate::mix_folder::MixFolder;
use crate::run_folder::RunFolder;
use crate::schedule_file;

/// Name of the file of the checkpoint in the state folder.
const CHECKPOINT: &str = "checkpoint";
/// Name of the folder of maps in the state folder.
const MAPS: &str = "maps";
/// Name of the folder of records of runs in the state folder.
const HISTORY: &str = "history";
/// Name of the folder of recordings in the state folder.
pub(crate) const RECORDINGS: &str = "runs";
/// Name of the folder of control mixes in the state folder.
const MIXES: &str = "mixes";
/// Name of the file of schedules in the state folder.
const SCHEDULES: &str = "schedules.json";
/// Name of the file of the motors' loads in the state folder.
const HEALTH: &str = "health.json";
/// Name of the file of what robots have learnt in the state folder.
const LEARNT: &str = "learnt.json";

/// Name of the file of what all runs come to in the state folder.
const STATISTICS: &str = "statistics.json";

/// Where things are kept.
#[derive(Debug)]
pub(crate) struct KeptPaths {
    /// The checkpoint.
    pub(crate) checkpoint: PathBuf,
    /// The floors, with the versions of their maps.
    pub(crate) floors: FloorFolder,
    /// The control mixes.
    pub(crate) mixes: MixFolder,
    /// The schedules.
    pub(crate) schedules: PathBuf,
    /// The loads of the motors.
    pub(crate) health: PathBuf,
    /// What robots have learnt of themselves.
    pub(crate) learnt: PathBuf,
    /// The records of runs.
    pub(crate) runs: RunFolder,
    /// What all runs come to.
    pub(crate) lifetime: LifetimeFile,
}

impl KeptPaths {
    /// Keeps the record of a run, with the version of the map that is the newest then.
    ///
    /// # Errors
    /// A sentence for the log.
    pub(crate) fn keep_run(&self, mut record: RunRecord) -> Result<Box<Run>, String> {
        let newest = |floor| self.floors.maps(floor).newest_number();
        record.run.map = record.run.floor.and_then(newest);
        match self.runs.keep(&record) {
            Ok(()) => {
                // The next run counts this one as well.
                if let Err(error) = self.lifetime.keep() {
                    tracing::error!(
                        part = "vthal",
                        "cannot write the sums of all runs: {error}; run {} is counted with the next one",
                        record.run.number
                    );
                }
                self.runs.look_for_recordings(&mut record.run);
                Ok(Box::new(record.run))
            }
            Err(error) => Err(format!(
                "cannot write the record of run {} in {}: {error}; it is tried again every minute",
                record.run.number,
                self.runs.path().display()
            )),
        }
    }

    /// Folders that cannot be listed: what is in them must not be taken for nothing.
    fn folder_complaints(&self) -> Vec<String> {
        let state = self.checkpoint.parent().unwrap_or(Path::new("."));
        let folders = [
            (MAPS, "maps"),
            (MIXES, "control mixes"),
            (HISTORY, "the history"),
            (RECORDINGS, "recordings"),
        ];
        folders
            .into_iter()
            .filter_map(|(name, what)| kept_file::folder_complaint(&state.join(name), what))
            .collect()
    }

    /// The job that goes on, and the number of the next run, which is above all that were `counted`. A run that is not continued is stored as cut short.
    fn left_over(&self, found: Option<Found>, counted: u64) -> (Option<Checkpoint>, u64) {
        let run = found.as_ref().and_then(|found| found.checkpoint.run.as_ref());
        let left = run.map_or(0, |run| run.run.number);
        let next_run = self.runs.newest().max(left).max(counted).saturating_add(1);
        let Some(Found { checkpoint, is_young }) = found else {
            return (None, next_run);
        };
        if is_young {
            return (Some(checkpoint), next_run);
        }
        if let Some(record) = cut_short(checkpoint).filter(|record| !self.runs.has(record.run.number)) {
            let number = record.run.number;
            match self.runs.keep(&record) {
                Ok(()) => tracing::info!(
                    part = "vthal",
                    "run {number} was cut short: what was known of it is kept"
                ),
                Err(error) => tracing::error!(
                    part = "vthal",
                    "cannot write what was known of run {number} in {}: {error}",
                    self.runs.path().display()
                ),
            }
        }
        (None, next_run)
    }
}

/// The state folder of a daemon. The daemon hands its paths to the thread that writes; a program that measures a life of many
/// daemons writes through it directly.
#[derive(Debug)]
pub struct KeptStore(KeptPaths);

impl KeptStore {
    /// The state folder at `state`; nothing is made before something is kept.
    #[must_use]
    pub fn new(state: &Path) -> Self {
        let runs = RunFolder::new(state.join(HISTORY), state.join(RECORDINGS));
        Self(KeptPaths {
            checkpoint: state.join(CHECKPOINT),
            floors: FloorFolder::new(state.join(MAPS)),
            mixes: MixFolder::new(state.join(MIXES)),
            schedules: state.join(SCHEDULES),
            health: state.join(HEALTH),
            learnt: state.join(LEARNT),
            lifetime: LifetimeFile::new(state.join(STATISTICS), runs.clone()),
            runs,
        })
    }

    pub(crate) const fn paths(&self) -> &KeptPaths {
        &self.0
    }

    pub(crate) fn into_paths(self) -> KeptPaths {
        self.0
    }

    /// Settings of a core that begins with what is kept; what is wrong with that is in its complaints.
    #[must_use]
    pub fn fill(&self, config: CoreConfig) -> CoreConfig {
        let kept = &self.0;
        let found = schedule_file::load(&kept.schedules);
        let (health, health_complaints) = health_file::load(&kept.health);
        let (learnt, learnt_complaints) = learnt_file::load(&kept.learnt);
        let unraised = kept.floors.number_after_schedules(&found.book);
        let (floors, floor_complaints) = kept.floors.load();
        let now = BootTime::now().ok();
        let newest = now.map(|now| checkpoint_file::newest(&kept.checkpoint, &now));
        let (checkpoint, checkpoint_complaint) = newest.unwrap_or_default();
        let (lifetime, lifetime_complaints) = kept.lifetime.load();
        let (resume, next_run) = kept.left_over(checkpoint, lifetime.newest());
        CoreConfig {
            schedules: found.book,
            schedules_distrusted: found.distrusted,
            health,
            learnt,
            floors,
            complaints: [
                found.complaints,
                health_complaints,
                learnt_complaints,
                lifetime_complaints,
                unraised,
                floor_complaints,
                kept.mixes.put_damaged_aside(),
                kept.folder_complaints(),
                checkpoint_complaint.into_iter().collect(),
            ]
            .concat(),
            resume,
            next_run,
            ..config
        }
    }

    /// Keeps a map as the newest version of its floor.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep_home(&self, kept: &FloorHome) -> io::Result<()> {
        let maps = self.0.floors.maps(kept.floor);
        maps.save_after(&kept.home, kept.trial)
    }

    /// Keeps that the robot doubts the newest map of a floor.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep_doubt(&self, floor: u16) -> io::Result<()> {
        self.0.floors.maps(floor).note_doubt()
    }

    /// Keeps the loads of motors.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep_health(&self, health: &StoredHealth) -> io::Result<()> {
        health_file::save(&self.0.health, health)
    }

    /// Keeps what robots have learnt of themselves.
    ///
    /// # Errors
    /// What the file system says.
    pub fn keep_learnt(&self, learnt: &StoredLearnings) -> io::Result<()> {
        learnt_file::save(&self.0.learnt, learnt)
    }

    /// Keeps the record of a run; gives it as clients see it.
    ///
    /// # Errors
    /// A sentence for the log.
    pub fn keep_run(&self, record: RunRecord) -> Result<Box<Run>, String> {
        self.0.keep_run(record)
    }

    /// Bytes of the newest map of a floor that is whole.
    #[must_use]
    pub fn newest_map(&self, floor: u16) -> Option<Vec<u8>> {
        self.0.floors.maps(floor).newest_bytes()
    }
}
