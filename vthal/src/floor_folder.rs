//! The floors of the home on disk: their list, `floors.json`, in the folder of maps, and a folder of versions for each floor. The
//! first floor's versions lie in the folder of maps itself, where the only map lay before there were floors; those of floor 2
//! in `floor-2` below it, and so on. A removed floor keeps its folder until its place is needed.

mod taking_in;

use std::fs;
use std::io;
use std::path::PathBuf;

use brain::{NextNumbers, RoomName};
use rvac_api::{JobPart, ScheduledJob};
use serde::{Deserialize, Serialize};
use vthal_core::schedule::{Book, Entry};
use vthal_core::{FloorTask, KeptFloor};

use crate::map_folder::MapFolder;

/// Floors that are kept, removed ones included.
const FLOORS_MAX: usize = 16;
/// Name of the list.
const LIST: &str = "floors.json";
/// Largest list that is read.
const LIST_BYTES_MAX: usize = 1 << 16;

/// The folder of maps with all its floors.
#[derive(Clone, Debug)]
pub(crate) struct FloorFolder {
    path: PathBuf,
}

/// Why the floors are as they were before.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FloorError {
    /// There are as many as may be.
    #[error("There are as many floors as may be, {FLOORS_MAX}: remove one first.")]
    Full,
    /// There are not as many places as an archive has floors.
    #[error(
        "The archive has {wanted} floors, and {free} of {FLOORS_MAX} places are free; removed floors keep theirs, because \
         they can come back. Take an archive of fewer floors: `rvac floor export FILE --floor NAME` writes one of a single \
         floor."
    )]
    NoPlaces {
        /// Floors of the archive.
        wanted: usize,
        /// Places that are free.
        free: usize,
    },
    /// There is none with this number.
    #[error("There is no floor {0}: ask which there are.")]
    Absent(u16),
    /// The disk refuses.
    #[error(
        "The floors cannot be written: {0}. Check the disk and the state folder; they are as they were before."
    )]
    Unwritable(#[from] io::Error),
}

impl FloorError {
    /// The reason's name for clients.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Full | Self::NoPlaces { .. } => "too-many-floors",
            Self::Absent(_) => "no-such-floor",
            Self::Unwritable(_) => "floors-unwritable",
        }
    }
}

/// The list as it is written.
#[derive(Debug, Serialize, Deserialize)]
struct List {
    version: u32,
    /// Number of the next new floor. A number is not given a second time, because schedules keep numbers of floors.
    #[serde(default)]
    next: u16,
    /// Removed ones in the order in which they were removed.
    floors: Vec<FloorEntry>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct FloorEntry {
    number: u16,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default)]
    removed: bool,
}

impl FloorEntry {
    const fn new(number: u16) -> Self {
        Self {
            number,
            name: None,
            removed: false,
        }
    }
}

impl FloorFolder {
    /// The floors in the folder of maps at `path`, which is made with the first map.
    pub(crate) fn new(path: PathBuf) -> Self {
        Self { path }
    }

    /// The versions of a floor's map.
    pub(crate) fn maps(&self, floor: u16) -> MapFolder {
        MapFolder::new(match floor {
            1 => self.path.clone(),
            _ => self.path.join(format!("floor-{floor}")),
        })
    }

    /// Where it is.
    #[cfg(test)]
    pub(crate) fn path(&self) -> &std::path::Path {
        &self.path
    }

    /// All floors with their newest maps that are whole, and what is wrong with what is not.
    pub(crate) fn load(&self) -> (Vec<KeptFloor>, Vec<String>) {
        let unsettled = self.settle().err().map(|error| {
            format!(
                "cannot finish what an archive began in {}: {error}",
                self.path.display()
            )
        });
        let (list, mut complaints) = self.list();
        complaints.extend(unsettled);
        let mut floors = Vec::new();
        for entry in list.floors {
            let maps = self.maps(entry.number);
            let (home, wrong) = maps.newest();
            let (next_numbers, wrong_numbers) = maps.next_numbers();
            complaints.extend(wrong);
            complaints.extend(wrong_numbers);
            floors.push(KeptFloor {
                home: home.map(|home| home.numbered_after(next_numbers)),
                next_numbers,
                ..kept(&entry)
            });
        }
        (floors, complaints)
    }

    /// What schedules name is not given again, also where the maps are older than they: after a copy of the folder of maps came back. Gives
    /// what is wrong.
    pub(crate) fn number_after_schedules(&self, book: &Book) -> Vec<String> {
        let (list, mut complaints) = self.list();
        for FloorEntry { number, .. } in list.floors {
            let jobs = book.entries().map(Entry::plan);
            let jobs = jobs.filter(|plan| plan.floor.is_none_or(|floor| floor == number));
            let next = jobs.fold(NextNumbers::FIRST, |next, plan| next.after(named(&plan.job)));
            let maps = self.maps(number);
            complaints.extend(maps.next_numbers().1);
            if next != NextNumbers::FIRST
                && let Err(error) = maps.raise_numbers(next)
            {
                let folder = maps.path().display();
                complaints.push(format!("cannot write the next numbers in {folder}: {error}"));
            }
        }
        complaints
    }

    /// Carries out a client's order about floors, and returns the number of a new one.
    ///
    /// # Errors
    /// See [`FloorError`]; then nothing is changed.
    pub(crate) fn change(&self, task: &FloorTask) -> Result<Option<u16>, FloorError> {
        let mut list = self.list().0;
        let entries = &mut list.floors;
        let mut made = None;
        match task {
            FloorTask::New(name) => {
                let dropped = make_room(entries)?;
                let number = list.next;
                list.next = number.checked_add(1).ok_or(FloorError::Full)?;
                let entry = FloorEntry {
                    name: name.as_ref().map(|name| name.as_str().to_owned()),
                    ..FloorEntry::new(number)
                };
                entries.push(entry);
                if let Some(dropped) = dropped {
                    self.discard(dropped)?;
                }
                made = Some(number);
            }
            FloorTask::Name(number, name) => {
                entry(entries, *number)?.name = name.as_ref().map(|name| name.as_str().to_owned());
            }
            FloorTask::Remove(number) => {
                let mut removed = entry(entries, *number)?.clone();
                removed.removed = true;
                entries.retain(|entry| entry.number != *number);
                entries.push(removed);
            }
            FloorTask::Restore(number) => entry(entries, *number)?.removed = false,
        }
        self.write(&list)?;
        Ok(made)
    }

    fn write(&self, list: &List) -> Result<(), FloorError> {
        let bytes = serde_json::to_vec_pretty(list).map_err(io::Error::from)?;
        fs::create_dir_all(&self.path)?;
        kept_file::replace(&self.path.join(LIST), &bytes)?;
        Ok(())
    }

    /// The versions of a floor that was removed long ago are deleted for a new one.
    fn discard(&self, number: u16) -> io::Result<()> {
        let maps = self.maps(number);
        for version in maps.list() {
            maps.discard(version.number)?;
        }
        Ok(())
    }

    /// The list, and what is wrong with it. A floor that has a folder and no entry is on it nevertheless, so that none is
    /// lost with the list. The number of the next new floor is higher than that of any floor that there was, also of one whose place
    /// was needed.
    fn list(&self) -> (List, Vec<String>) {
        let (mut list, complaints) = self.written_list();
        let mut found: Vec<u16> = self.folders();
        found.sort_unstable();
        for number in found {
            if list.floors.iter().all(|entry| entry.number != number) {
                list.floors.push(FloorEntry::new(number));
            }
        }
        let listed = list.floors.iter().map(|entry| entry.number);
        let highest = listed.chain(self.folder_numbers()).max().unwrap_or(1);
        list.next = list.next.max(highest.saturating_add(1));
        (list, complaints)
    }

    /// The list as it was written, and what is wrong with it.
    fn written_list(&self) -> (List, Vec<String>) {
        let kept = kept_file::newest(&self.path.join(LIST), "the list of floors", read);
        let list = kept.value.unwrap_or_else(|| List {
            version: 1,
            next: 0,
            floors: vec![FloorEntry::new(1)],
        });
        (list, kept.complaints)
    }

    /// Numbers of the floors that have versions.
    fn folders(&self) -> Vec<u16> {
        let all = core::iter::once(1).chain(self.folder_numbers());
        all.filter(|number| !self.maps(*number).list().is_empty())
            .collect()
    }

    /// Numbers of the floors that have a folder of their own.
    fn folder_numbers(&self) -> Vec<u16> {
        let number = |name: &str| name.strip_prefix("floor-")?.parse::<u16>().ok();
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        entries
            .filter_map(|entry| number(entry.file_name().to_str()?))
            .filter(|number| *number > 1)
            .collect()
    }
}

fn read(text: &str) -> Result<List, String> {
    if text.len() > LIST_BYTES_MAX {
        return Err("it is larger than any list of floors".to_owned());
    }
    let list: List = serde_json::from_str(text).map_err(|error| error.to_string())?;
    match list.version {
        1 => Ok(list),
        version => Err(format!(
            "it has version {version}, and this vthal knows version 1"
        )),
    }
}

/// The numbers after all that a job names.
fn named(job: &ScheduledJob) -> NextNumbers {
    let after = |number: u16| number.saturating_add(1);
    job.places()
        .0
        .iter()
        .fold(NextNumbers::FIRST, |next, part| match part {
            JobPart::Room(room) => NextNumbers {
                room: next.room.max(after(*room)),
                ..next
            },
            JobPart::Place(place) => NextNumbers {
                place: next.place.max(after(*place)),
                ..next
            },
            JobPart::Zone(_) | JobPart::Spot(_) => next,
        })
}

fn kept(entry: &FloorEntry) -> KeptFloor {
    KeptFloor {
        name: entry.name.as_deref().and_then(|name| RoomName::new(name).ok()),
        removed: entry.removed,
        ..KeptFloor::new(entry.number)
    }
}

fn entry(entries: &mut [FloorEntry], number: u16) -> Result<&mut FloorEntry, FloorError> {
    let found = entries.iter_mut().find(|entry| entry.number == number);
    found.ok_or(FloorError::Absent(number))
}

/// When all places are taken, the floor that was removed first is given up.
fn make_room(entries: &mut Vec<FloorEntry>) -> Result<Option<u16>, FloorError> {
    if entries.len() < FLOORS_MAX {
        return Ok(None);
    }
    let oldest = entries.iter().find(|entry| entry.removed);
    let oldest = oldest.map(|entry| entry.number).ok_or(FloorError::Full)?;
    entries.retain(|entry| entry.number != oldest);
    Ok(Some(oldest))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use brain::{Cell, CellKnowledge, NextNumbers, Raster, RoomName, StoredMap};
    use rvac_api::{InQuiet, JobOrder, JobPart, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday};
    use vthal_core::schedule::{Book, Plan, ScheduleEdit, Zone};
    use vthal_core::{FloorTask, KeptFloor};

    use super::{FLOORS_MAX, FloorFolder, LIST};

    fn home(width: usize) -> StoredMap {
        let floor = Raster::filled(Cell { x: 1, y: 2 }, width, 4, CellKnowledge::Free);
        StoredMap::from_raster(&floor, None)
    }

    struct Scratch(FloorFolder);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("vthal-floors-{name}-{}", std::process::id()));
            fs::remove_dir_all(&path).ok();
            Self(FloorFolder::new(path))
        }

        fn floors(&self) -> Vec<KeptFloor> {
            self.0.load().0
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            fs::remove_dir_all(self.0.path()).ok();
        }
    }

    fn called(name: &str) -> Option<RoomName> {
        Some(RoomName::new(name).expect("is a name"))
    }

    #[test]
    fn the_only_map_of_before_there_were_floors_is_the_first_floors() {
        let scratch = Scratch::new("before");
        fs::create_dir_all(scratch.0.path()).expect("creates");
        let bytes = vthal_core::stored_map::encode(&home(7));
        for file in ["000003.map", "000004.map"] {
            fs::write(scratch.0.path().join(file), &bytes).expect("writes");
        }
        let first = KeptFloor {
            home: Some(home(7)),
            ..KeptFloor::new(1)
        };
        assert_eq!(scratch.floors(), [first]);
        scratch.0.change(&FloorTask::New(called("Attic"))).expect("makes");
        scratch.0.maps(2).save(&home(9)).expect("saves");
        assert_eq!(scratch.0.maps(1).list().len(), 2, "nothing was moved");
        assert_eq!(scratch.0.maps(2).list().len(), 1);
    }

    #[test]
    fn a_removed_floor_comes_back_with_its_name_and_versions() {
        let scratch = Scratch::new("removed");
        assert_eq!(scratch.floors(), [KeptFloor::new(1)]);
        let made = scratch.0.change(&FloorTask::New(called("Attic"))).expect("makes");
        assert_eq!(made, Some(2));
        for width in [4, 5] {
            scratch.0.maps(2).save(&home(width)).expect("saves");
        }
        scratch.0.change(&FloorTask::Remove(2)).expect("removes");
        assert!(scratch.floors()[1].removed);
        assert_eq!(scratch.0.change(&FloorTask::New(None)).expect("makes"), Some(3));
        scratch.0.change(&FloorTask::Restore(2)).expect("comes back");
        let attic = scratch
            .floors()
            .into_iter()
            .find(|floor| floor.number == 2)
            .expect("is there");
        assert_eq!(
            (attic.name, attic.home, attic.removed),
            (called("Attic"), Some(home(5)), false)
        );
        assert_eq!(scratch.0.maps(2).list().len(), 2);
        let error = scratch.0.change(&FloorTask::Remove(9)).expect_err("is absent");
        assert_eq!(error.name(), "no-such-floor");
    }

    #[test]
    fn a_spoilt_list_loses_no_floor() {
        let scratch = Scratch::new("spoilt");
        scratch.0.change(&FloorTask::New(called("Attic"))).expect("makes");
        scratch.0.maps(2).save(&home(5)).expect("saves");
        let list = scratch.0.path().join(LIST);
        fs::write(&list, b"garbage").expect("writes");
        let (floors, complaints) = scratch.0.load();
        assert_eq!(floors.len(), 2);
        assert_eq!(floors[1].home, Some(home(5)));
        assert!(complaints[0].contains(LIST), "{complaints:?}");
        let aside = scratch.0.path().join("floors.json.damaged-1");
        assert_eq!(fs::read(aside).expect("is kept"), b"garbage");
    }

    /// A map whose next room has this number.
    fn numbered(width: usize, room: u16) -> StoredMap {
        home(width).numbered_after(NextNumbers {
            room,
            ..NextNumbers::FIRST
        })
    }

    fn next_room(scratch: &Scratch) -> (bool, u16) {
        let first = scratch.floors().remove(0);
        let known = first.home.as_ref().map(|home| home.next_numbers());
        assert!(known.is_none_or(|next| next == first.next_numbers));
        (known.is_some(), first.next_numbers.room)
    }

    fn spoil(scratch: &Scratch, file: &str) {
        fs::write(scratch.0.path().join(file), b"garbage").expect("writes");
    }

    /// An older map stands in for a damaged one, and does not give its numbers again: schedules keep numbers of rooms.
    #[test]
    fn numbers_do_not_come_back_when_the_newest_map_is_damaged() {
        let scratch = Scratch::new("counters");
        for (width, room) in [(4, 3), (5, 9)] {
            scratch.0.maps(1).save(&numbered(width, room)).expect("saves");
        }
        assert_eq!(next_room(&scratch), (true, 9));
        spoil(&scratch, "000002.map");
        assert_eq!(next_room(&scratch), (true, 9));
        scratch.0.maps(1).restore(1).expect("is whole");
        assert_eq!(next_room(&scratch), (true, 9));
        for map in ["000001.map", "000003.map"] {
            spoil(&scratch, map);
        }
        assert_eq!(next_room(&scratch), (false, 9), "no map is whole");
    }

    #[test]
    fn the_maps_know_the_numbers_when_the_file_of_them_is_damaged_or_never_was() {
        let scratch = Scratch::new("no-counters");
        for (width, room) in [(4, 9), (5, 3)] {
            let bytes = vthal_core::stored_map::encode(&numbered(width, room));
            scratch.0.maps(1).save_bytes(&bytes).expect("saves");
        }
        assert_eq!(next_room(&scratch), (true, 9), "as an older version left it");
        scratch.0.maps(1).save(&numbered(6, 3)).expect("saves");
        spoil(&scratch, "numbers.json");
        let (floors, complaints) = scratch.0.load();
        assert_eq!(floors[0].next_numbers.room, 9);
        assert!(complaints[0].contains("numbers.json"), "{complaints:?}");
    }

    /// Somebody puts an older copy of the folder of maps back, and the schedules are as they were.
    #[test]
    fn what_schedules_name_is_not_given_again() {
        let scratch = Scratch::new("backup");
        scratch.0.maps(1).save(&numbered(4, 3)).expect("saves");
        let plan = Plan::from_api(ScheduleEntry {
            name: "Bath".to_owned(),
            enabled: true,
            job: ScheduledJob::Clean(JobOrder {
                parts: vec![JobPart::Room(8), JobPart::Place(2), JobPart::Room(1)],
                passes: 1,
                avoid: Vec::new(),
                power: None,
                pattern: None,
            }),
            when: ScheduleTime::Weekly {
                days: vec![Weekday::Mo],
                at: "07:30".to_owned(),
            },
            late_min: 5,
            in_quiet: InQuiet::Wait,
            floor: Some(1),
        });
        let mut book = Book::default();
        book.edit(
            ScheduleEdit::Add(plan.expect("a plan")),
            Zone::utc().at(1_800_000_000),
        )
        .expect("adds");
        let complaints = scratch.0.number_after_schedules(&book);
        assert!(complaints.is_empty(), "{complaints:?}");
        assert_eq!(next_room(&scratch), (true, 9));
        assert_eq!(scratch.floors()[0].next_numbers.place, 3);
        scratch.0.maps(1).save(&numbered(5, 3)).expect("saves");
        assert_eq!(next_room(&scratch), (true, 9), "and not later, either");
    }

    #[test]
    fn when_all_places_are_taken_the_floor_that_was_removed_first_gives_way() {
        let scratch = Scratch::new("many");
        for number in 2..=FLOORS_MAX as u16 {
            assert_eq!(
                scratch.0.change(&FloorTask::New(None)).expect("makes"),
                Some(number)
            );
        }
        let error = scratch.0.change(&FloorTask::New(None)).expect_err("is full");
        assert_eq!(error.name(), "too-many-floors");
        scratch.0.maps(5).save(&home(5)).expect("saves");
        for number in [5, 3] {
            scratch.0.change(&FloorTask::Remove(number)).expect("removes");
        }
        let newest = FLOORS_MAX as u16 + 1;
        assert_eq!(
            scratch.0.change(&FloorTask::New(None)).expect("makes"),
            Some(newest),
            "schedules may know the number of the one that gave way"
        );
        assert_eq!(scratch.0.maps(5).list(), [], "its maps are gone");
        assert!(
            scratch
                .floors()
                .iter()
                .any(|floor| floor.number == 3 && floor.removed)
        );
    }

    /// Floors come and go for years, and each that is new has a number of its own.
    #[test]
    fn no_floor_gets_the_number_of_another_one() {
        let scratch = Scratch::new("numbers");
        let mut given = std::collections::BTreeSet::from([1]);
        for _ in 0..3 * FLOORS_MAX {
            let number = scratch.0.change(&FloorTask::New(None)).expect("makes");
            let number = number.expect("a new one has a number");
            assert!(given.insert(number), "{number} was given before");
            scratch.0.change(&FloorTask::Remove(number)).expect("removes");
        }
    }
}
