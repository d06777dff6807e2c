//! The map of a floor on disk: a folder with one file for each version. Numbers rise, the
//! highest is the newest, and the oldest go when there are too many. No version is ever changed.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use brain::{CELL_M, CellKnowledge, MapTrial, NextNumbers, StoredMap};
use kept_file::{newest_json, replace_json};
use rvac_api::KeptMap;
use serde::{Deserialize, Serialize};
use vthal_core::stored_map;

use crate::map_trials::MapTrials;
use crate::numbered::number;

/// Versions kept: a map that was spoilt is noticed within some runs, and each change that a person makes is a version, too.
const VERSIONS_MAX: usize = 40;
/// Largest file that is read. A home of 150 square metres takes some ten kilobytes.
const BYTES_MAX: u64 = 16 << 20;
/// Ending of the files.
const ENDING: &str = ".map";
/// Name of the file of the next numbers.
const NUMBERS: &str = "numbers.json";

/// The next numbers as they are written.
#[derive(Debug, Serialize, Deserialize)]
struct StoredNumbers {
    room: u16,
    room_change: u16,
    no_go: u16,
    place: u16,
}

impl From<NextNumbers> for StoredNumbers {
    fn from(next: NextNumbers) -> Self {
        let NextNumbers {
            room,
            room_change,
            no_go,
            place,
        } = next;
        Self {
            room,
            room_change,
            no_go,
            place,
        }
    }
}

impl From<StoredNumbers> for NextNumbers {
    fn from(stored: StoredNumbers) -> Self {
        Self {
            room: stored.room,
            room_change: stored.room_change,
            no_go: stored.no_go,
            place: stored.place,
        }
        .after(Self::FIRST)
    }
}

/// The folder.
#[derive(Clone, Debug)]
pub(crate) struct MapFolder {
    path: PathBuf,
}

/// Why a version cannot be taken up again.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RestoreError {
    /// There is none with this number.
    #[error("No map has the number {0}: ask which are kept.")]
    Absent(u64),
    /// It is there, but not whole.
    #[error("Map {number} cannot be used: {what}. Take another one.")]
    Broken {
        /// Its number.
        number: u64,
        /// What is wrong.
        what: String,
    },
    /// It cannot be made the newest one.
    #[error("The map cannot be written: {0}. Check the disk and the state folder.")]
    Unwritable(#[from] io::Error),
}

impl RestoreError {
    /// The reason's name for clients.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Absent(_) => "no-such-map",
            Self::Broken { .. } => "map-unreadable",
            Self::Unwritable(_) => "map-unwritable",
        }
    }
}

impl MapFolder {
    /// The folder at `path`, made with the first version.
    pub(crate) fn new(path: PathBuf) -> Self {
        Self { path }
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps `home` as the newest version. Writes nothing when it is that already.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn save(&self, home: &StoredMap) -> io::Result<()> {
        self.raise_numbers(home.next_numbers())?;
        self.save_bytes(&stored_map::encode(home))
    }

    /// As [`Self::save`], with what the run that leaves it has shown of the map before it.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn save_after(&self, home: &StoredMap, trial: Option<MapTrial>) -> io::Result<()> {
        let base = self.newest_number();
        self.save(home)?;
        let versions = base.zip(self.newest_number());
        match trial.zip(versions) {
            Some((trial, versions)) => self.note_trial(trial, versions),
            None => Ok(()),
        }
    }

    /// The robot doubts the newest version.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn note_doubt(&self) -> io::Result<()> {
        match self.newest_number() {
            Some(newest) => self.note_trial(MapTrial::Doubted, (newest, newest)),
            None => Ok(()),
        }
    }

    fn note_trial(&self, trial: MapTrial, versions: (u64, u64)) -> io::Result<()> {
        let numbers = self.numbers();
        MapTrials::change(&self.path, &numbers, |trials| {
            trials.note(trial, versions, &numbers)
        })
    }

    /// The numbers that nothing of the floor has had yet, and what is wrong with the file that holds them. They lie beside the maps,
    /// because the newest map may be damaged; without them the maps know.
    pub(crate) fn next_numbers(&self) -> (NextNumbers, Vec<String>) {
        let kept = newest_json::<StoredNumbers, NextNumbers>(&self.path.join(NUMBERS), "the next numbers");
        let next = kept.value.unwrap_or_else(|| self.next_numbers_of_maps());
        (next, kept.complaints)
    }

    /// What is new on the floor gets these numbers or higher ones.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn raise_numbers(&self, next: NextNumbers) -> io::Result<()> {
        let (before, complaints) = self.next_numbers();
        for complaint in complaints {
            tracing::error!(part = "vthal", "{complaint}");
        }
        let after = before.after(next);
        let file = self.path.join(NUMBERS);
        if after == before && file.exists() {
            return Ok(());
        }
        fs::create_dir_all(&self.path)?;
        replace_json(&file, &StoredNumbers::from(after))
    }

    fn next_numbers_of_maps(&self) -> NextNumbers {
        let maps = self.numbers().into_iter().filter_map(|map| self.load(map).ok());
        maps.fold(NextNumbers::FIRST, |next, map| next.after(map.next_numbers()))
    }

    /// As [`Self::save`], of a map that is bytes already.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn save_bytes(&self, bytes: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.path)?;
        let numbers = self.numbers();
        let newest = numbers.first().copied();
        if newest.is_some_and(|number| self.read(number).is_ok_and(|present| present == bytes)) {
            return Ok(());
        }
        let number = newest.unwrap_or(0).saturating_add(1);
        kept_file::replace(&self.file(number), bytes)?;
        for oldest in numbers.iter().skip(VERSIONS_MAX - 1) {
            self.discard(*oldest)?;
        }
        Ok(())
    }

    /// The newest undamaged map, and why newer ones cannot be used; both empty when there is none yet.
    pub(crate) fn newest(&self) -> (Option<StoredMap>, Vec<String>) {
        let mut complaints = Vec::new();
        for number in self.numbers() {
            match self.load(number) {
                Ok(home) => return (Some(home), complaints),
                Err(what) => complaints.push(format!(
                    "cannot use the map {}: {what}",
                    self.file(number).display()
                )),
            }
        }
        (None, complaints)
    }

    /// The bytes of the newest map that is whole.
    pub(crate) fn newest_bytes(&self) -> Option<Vec<u8>> {
        let read = |number| self.read(number).ok();
        let mut versions = self.numbers().into_iter().filter_map(read);
        versions.find(|bytes| stored_map::decode(bytes).is_ok())
    }

    /// Number of the newest version.
    pub(crate) fn newest_number(&self) -> Option<u64> {
        self.numbers().first().copied()
    }

    /// The versions that are whole, newest first.
    pub(crate) fn list(&self) -> Vec<KeptMap> {
        let kept = |number| Some(describe(number, self.kept_s(number), &self.load(number).ok()?));
        let mut versions: Vec<KeptMap> = self.numbers().into_iter().filter_map(kept).collect();
        let numbers: Vec<u64> = versions.iter().map(|version| version.number).collect();
        let trials = MapTrials::load(&self.path);
        let last_good = trials.last_good(&numbers);
        for version in &mut versions {
            version.doubted = trials.is_doubted(version.number);
            version.last_good = last_good == Some(version.number);
        }
        versions
    }

    /// Makes a version the newest one.
    ///
    /// # Errors
    /// See [`RestoreError`]; then nothing is changed.
    pub(crate) fn restore(&self, number: u64) -> Result<StoredMap, RestoreError> {
        if !self.numbers().contains(&number) {
            return Err(RestoreError::Absent(number));
        }
        let home = self
            .load(number)
            .map_err(|what| RestoreError::Broken { number, what })?;
        // A room, zone or place that is new from now on gets a number that no version has given to another one: schedules and scripts
        // keep numbers.
        let home = home.numbered_after(self.next_numbers().0.after(self.next_numbers_of_maps()));
        self.save(&home)?;
        if let Some(copy) = self.newest_number() {
            MapTrials::change(&self.path, &self.numbers(), |trials| trials.copy(number, copy))?;
        }
        Ok(home)
    }

    /// Deletes a version for good.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn discard(&self, number: u64) -> io::Result<()> {
        fs::remove_file(self.file(number))
    }

    /// Numbers of the versions, newest first. A folder that is not there holds none.
    fn numbers(&self) -> Vec<u64> {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return Vec::new();
        };
        let mut numbers: Vec<u64> = entries
            .flatten()
            .filter_map(|entry| number(entry.file_name().to_str()?, ENDING))
            // What a person named otherwise is not ours.
            .filter(|number| self.file(*number).is_file())
            .collect();
        numbers.sort_unstable_by(|one, other| other.cmp(one));
        numbers
    }

    fn file(&self, number: u64) -> PathBuf {
        self.path.join(format!("{number:06}{ENDING}"))
    }

    fn read(&self, number: u64) -> io::Result<Vec<u8>> {
        let file = self.file(number);
        if fs::metadata(&file)?.len() > BYTES_MAX {
            return Err(io::Error::other("it is larger than any map"));
        }
        kept_file::read(&file)
    }

    fn load(&self, number: u64) -> Result<StoredMap, String> {
        let bytes = self.read(number).map_err(|error| error.to_string())?;
        stored_map::decode(&bytes).map_err(|error| error.to_string())
    }

    fn kept_s(&self, number: u64) -> u64 {
        let modified = fs::metadata(self.file(number)).and_then(|meta| meta.modified());
        let since = modified
            .ok()
            .and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        since.map_or(0, |since| since.as_secs())
    }
}

fn describe(number: u64, kept_s: u64, home: &StoredMap) -> KeptMap {
    let knowledge = home.knowledge();
    let free = knowledge
        .values()
        .iter()
        .filter(|kind| **kind == CellKnowledge::Free);
    KeptMap {
        number,
        kept_s,
        area_m2: free.count() as f64 * CELL_M * CELL_M,
        rooms: u32::try_from(home.room_count()).unwrap_or(u32::MAX),
        doubted: false,
        last_good: false,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use brain::{Cell, CellKnowledge, MapTrial, Raster, StoredMap};

    use super::{MapFolder, VERSIONS_MAX};

    fn home(width: usize) -> StoredMap {
        StoredMap::from_raster(
            &Raster::filled(Cell { x: 1, y: 2 }, width, 4, CellKnowledge::Free),
            None,
        )
    }

    struct Scratch(MapFolder);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("vthal-maps-{name}-{}", std::process::id()));
            fs::remove_dir_all(&path).ok();
            Self(MapFolder::new(path))
        }

        fn numbers(&self) -> Vec<u64> {
            self.0.list().iter().map(|kept| kept.number).collect()
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            fs::remove_dir_all(self.0.path()).ok();
        }
    }

    #[test]
    fn a_doubted_version_and_the_last_good_one_are_marked_and_a_restored_one_is_as_it_was() {
        let scratch = Scratch::new("trials");
        let marks = || {
            let versions = scratch.0.list();
            let marks = versions
                .iter()
                .map(|kept| (kept.number, kept.doubted, kept.last_good));
            marks.collect::<Vec<_>>()
        };
        scratch.0.save_after(&home(4), None).expect("saves");
        scratch
            .0
            .save_after(&home(5), Some(MapTrial::Held))
            .expect("saves");
        assert_eq!(marks(), [(2, false, false), (1, false, true)]);
        scratch
            .0
            .save_after(&home(6), Some(MapTrial::Doubted))
            .expect("saves");
        let doubted = [(3, true, false), (2, true, false), (1, false, true)];
        assert_eq!(marks(), doubted);
        scratch.0.note_doubt().expect("saves");
        assert_eq!(marks(), doubted, "that is known");
        scratch.0.restore(1).expect("is whole");
        assert_eq!(marks()[0], (4, false, true));
        fs::write(scratch.0.path().join("trials.json"), "{").expect("writes");
        assert_eq!(
            marks(),
            [
                (4, false, false),
                (3, true, false),
                (2, true, false),
                (1, false, true)
            ],
            "a damaged file is as the one before it"
        );
    }

    #[test]
    fn an_older_version_stands_in_for_a_broken_one() {
        let scratch = Scratch::new("broken");
        assert_eq!(scratch.0.newest(), (None, Vec::new()));
        for width in [4, 5, 5] {
            scratch.0.save(&home(width)).expect("saves");
        }
        assert_eq!(scratch.numbers(), [2, 1]);
        assert_eq!(scratch.0.newest(), (Some(home(5)), Vec::new()));
        let file = scratch.0.path().join("000002.map");
        let mut broken = fs::read(&file).expect("reads");
        broken[9] ^= 1;
        fs::write(&file, &broken).expect("writes");
        let (found, complaints) = scratch.0.newest();
        assert_eq!(found, Some(home(4)));
        assert!(
            complaints.len() == 1 && complaints[0].contains("checksum"),
            "{complaints:?}"
        );
        let error = scratch.0.restore(2).expect_err("is broken");
        assert_eq!(error.name(), "map-unreadable");
    }

    #[test]
    fn a_restored_version_becomes_the_newest_and_the_spoilt_one_stays() {
        let scratch = Scratch::new("restored");
        for width in [4, 5] {
            scratch.0.save(&home(width)).expect("saves");
        }
        assert_eq!(scratch.0.restore(1).expect("is whole"), home(4));
        assert_eq!(scratch.numbers(), [3, 2, 1]);
        assert_eq!(scratch.0.newest().0, Some(home(4)));
        assert!((scratch.0.list()[0].area_m2 - 16.0 * 0.025 * 0.025).abs() < 1e-9);
        assert_eq!(scratch.0.restore(7).expect_err("is absent").name(), "no-such-map");
    }

    #[test]
    fn the_oldest_go_and_foreign_files_stay() {
        let scratch = Scratch::new("many");
        scratch.0.save(&home(1)).expect("saves");
        let foreign = scratch.0.path().join("my copy.map");
        fs::write(&foreign, b"mine").expect("writes");
        for width in 2..=VERSIONS_MAX + 3 {
            scratch.0.save(&home(width)).expect("saves");
        }
        // A number that leaves none above it is not ours, either.
        fs::write(scratch.0.path().join(format!("{}.map", u64::MAX)), b"not ours").expect("writes");
        scratch.0.save(&home(1)).expect("saves");
        let newest = VERSIONS_MAX as u64 + 4;
        assert_eq!(scratch.numbers(), (5..=newest).rev().collect::<Vec<_>>());
        assert!(foreign.exists());
    }
}
