//! Floors of archives: what goes into one, and how those of one are kept beside the floors that there are.
//!
//! The maps are written first, into folders that nothing reads (`floor-3.new`). The list with the new floors, written at one
//! stroke, decides; then the folders get their names. After a crash the folders of floors on the list get theirs, and the
//! others go: either all floors of an archive are there or none is.

use std::fs::{self, File};
use std::io;
use std::path::PathBuf;

use brain::RoomName;

use super::{FLOORS_MAX, FloorEntry, FloorError, FloorFolder, List};
use crate::floor_archive::ArchivedFloor;
use crate::map_folder::MapFolder;

/// Ending of a folder that is not a floor's yet.
const STAGED: &str = ".new";
/// Most characters of a name, as [`RoomName`] takes them.
const NAME_MAX: usize = 40;

impl FloorFolder {
    /// The floors that are not removed and have a map, or the one of them with this number, with the newest maps that are
    /// whole.
    pub(crate) fn archived(&self, only: Option<u16>) -> Vec<ArchivedFloor> {
        let mut entries = self.list().0.floors;
        entries.retain(|entry| !entry.removed && only.is_none_or(|number| number == entry.number));
        entries.sort_by_key(|entry| entry.number);
        let archived = |entry: FloorEntry| {
            Some(ArchivedFloor {
                map: self.maps(entry.number).newest_bytes()?,
                name: entry.name.and_then(|name| RoomName::new(&name).ok()),
            })
        };
        entries.into_iter().filter_map(archived).collect()
    }

    /// Keeps the floors of an archive beside those that there are, and gives the numbers that they got. A name that is taken
    /// gets a number behind it.
    ///
    /// # Errors
    /// See [`FloorError`]; then nothing is changed.
    pub(crate) fn take_in(&self, floors: &[ArchivedFloor]) -> Result<Vec<u16>, FloorError> {
        self.settle()?;
        let kept = self.list().0;
        let free = FLOORS_MAX.saturating_sub(kept.floors.len());
        if floors.len() > free {
            let wanted = floors.len();
            return Err(FloorError::NoPlaces { wanted, free });
        }
        let list = with_new(kept, floors)?;
        let all = &list.floors;
        let fresh = all.get(all.len() - floors.len()..).unwrap_or_default();
        let numbers = fresh.iter().map(|entry| entry.number).collect();
        self.stage(fresh, floors)?;
        self.write(&list)?;
        if let Err(error) = self.settle() {
            // The list has decided: the next start tries again.
            tracing::error!("cannot name the folders of new floors: {error}");
        }
        Ok(numbers)
    }

    /// Writes the maps into folders that nothing reads.
    fn stage(&self, fresh: &[FloorEntry], floors: &[ArchivedFloor]) -> io::Result<()> {
        for (entry, floor) in fresh.iter().zip(floors) {
            MapFolder::new(self.staged(entry.number)).save_bytes(&floor.map)?;
        }
        self.flush()
    }

    /// Ends what a crash may have left: folders of floors that are on the list get their names, others go.
    pub(super) fn settle(&self) -> io::Result<()> {
        let staged: Vec<u16> = self.staged_numbers();
        if staged.is_empty() {
            return Ok(());
        }
        let listed = self.written_list().0.floors;
        for number in staged {
            let (staged, maps) = (self.staged(number), self.maps(number));
            let is_listed = listed.iter().any(|entry| entry.number == number);
            if is_listed && !maps.path().exists() {
                fs::rename(staged, maps.path())?;
            } else {
                fs::remove_dir_all(staged)?;
            }
        }
        self.flush()
    }

    fn staged(&self, number: u16) -> PathBuf {
        self.path.join(format!("floor-{number}{STAGED}"))
    }

    fn staged_numbers(&self) -> Vec<u16> {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return Vec::new();
        };
        let number = |name: &str| {
            let name = name.strip_prefix("floor-")?.strip_suffix(STAGED)?;
            name.parse::<u16>().ok()
        };
        let mut numbers: Vec<u16> = entries
            .flatten()
            .filter_map(|entry| number(entry.file_name().to_str()?))
            .collect();
        numbers.sort_unstable();
        numbers
    }

    /// Names of folders are on the disk only then.
    fn flush(&self) -> io::Result<()> {
        File::open(&self.path)?.sync_all()
    }
}

/// The list with entries for these floors at its end.
fn with_new(mut list: List, floors: &[ArchivedFloor]) -> Result<List, FloorError> {
    for floor in floors {
        let number = list.next;
        list.next = number.checked_add(1).ok_or(FloorError::Full)?;
        let name = floor.name.as_ref().map(|name| free_name(name, &list.floors));
        list.floors.push(FloorEntry {
            name,
            ..FloorEntry::new(number)
        });
    }
    Ok(list)
}

/// The name, or the first free one like it.
fn free_name(name: &RoomName, entries: &[FloorEntry]) -> String {
    let is_free = |wanted: &str| {
        let mut taken = entries.iter().filter_map(|entry| entry.name.as_deref());
        taken.all(|taken| taken.to_lowercase() != wanted.to_lowercase())
    };
    let name = name.as_str();
    if is_free(name) {
        return name.to_owned();
    }
    let numbered = |number: usize| {
        let ending = format!(" ({number})");
        let begin: String = name.chars().take(NAME_MAX - ending.len()).collect();
        format!("{}{ending}", begin.trim_end())
    };
    // There are fewer floors than numbers: one is free.
    let mut names = (2..=FLOORS_MAX + 2).map(numbered);
    names
        .find(|name| is_free(name))
        .unwrap_or_else(|| name.to_owned())
}

#[cfg(test)]
mod tests;
