//! Bytes of a stored map.
//!
//! `RVACMAP`, a version byte, then numbers of variable length (seven bits a byte, low ones first, signed ones zigzag), and
//! a CRC-32 (IEEE 802.3) over everything before it, low byte first. Poses and corners are micrometres and microradians.
//!
//! Version 1 ends after the layers; version 2 adds what people have said of the home; version 3 adds to that how they changed
//! its rooms, version 4 how rooms are cleaned, version 5 by which pattern. Version 6 begins with two poses of the dock: where
//! it was felt, after how often, and where a person says that it is. Of earlier ones it was felt often enough; 0 = no pose follows.
//! Version 7 adds the names of no-go zones and virtual walls, version 8 the zones and spots that are kept. Version 9 keeps the kind
//! of floor in two bits of each cell; in the oldest maps they may hold how much wheels slipped there, which nothing used.

mod room_words;
mod words;

use super::{CELLS_MAX, FLOOR_BITS, Run, StoredMap};
use crate::mapping::dock::Felt;
use crate::mapping::{Annotations, Cell, DockPlace};
use crate::model::geometry::Pose2;

const MAGIC: &[u8; 7] = b"RVACMAP";
/// Version that is written.
const VERSION: u8 = 9;
/// Oldest version that is read.
const VERSION_MIN: u8 = 1;
/// Most runs of one layer; a home has some ten thousand.
const RUNS_MAX: u64 = CELLS_MAX;

/// Why bytes are no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredMapError {
    /// They do not begin like a map.
    NotAMap,
    /// A version that is not known here.
    Version(u8),
    /// The checksum is another one.
    Checksum {
        /// Of the bytes.
        computed: u32,
        /// At their end.
        stored: u32,
    },
    /// They end too early.
    Cut,
    /// A number is longer than any that is written.
    Number,
    /// More cells than a map can have.
    TooLarge {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// A layer has another number of cells than the window.
    Cells {
        /// Of the window.
        expected: u64,
        /// Of the layer.
        found: u64,
    },
    /// A kind of floor that is not known here.
    Floor,
    /// A no-go zone that no map can have.
    NoGo,
    /// A place that no map can keep.
    Place,
    /// A name that no room can have.
    Name,
    /// A change of rooms that no map can have.
    RoomChange,
    /// Settings that no room can have.
    RoomSettings,
    /// Something follows the end.
    Trailing,
}

impl core::fmt::Display for StoredMapError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotAMap => formatter.write_str("it does not begin like a map"),
            Self::Version(version) => write!(
                formatter,
                "it has version {version} and this program reads {VERSION_MIN} to {VERSION}"
            ),
            Self::Checksum { computed, stored } => write!(
                formatter,
                "its checksum is {computed:08X} and should be {stored:08X}"
            ),
            Self::Cut => formatter.write_str("it ends too early"),
            Self::Number => formatter.write_str("it has a number that is too long"),
            Self::TooLarge { width, height } => {
                write!(
                    formatter,
                    "{width} times {height} cells are more than a map can have"
                )
            }
            Self::Cells { expected, found } => {
                write!(formatter, "a layer has {found} cells instead of {expected}")
            }
            Self::Floor => formatter.write_str("it has a kind of floor that cannot be"),
            Self::NoGo => formatter.write_str("it has a no-go zone that cannot be"),
            Self::Name => formatter.write_str("it has a name of a room that cannot be"),
            Self::Place => formatter.write_str("it keeps a place that cannot be"),
            Self::RoomChange => formatter.write_str("it has a change of rooms that cannot be"),
            Self::RoomSettings => formatter.write_str("it has settings of a room that cannot be"),
            Self::Trailing => formatter.write_str("something follows its end"),
        }
    }
}

impl core::error::Error for StoredMapError {}

impl StoredMap {
    /// The bytes of the map.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.push(VERSION);
        let felt = self.dock.felt();
        put_pose(&mut bytes, felt.map(|felt| (felt.times, felt.pose)));
        put_pose(&mut bytes, self.dock.told().map(|told| (1, told)));
        put_signed(&mut bytes, self.origin.x.into());
        put_signed(&mut bytes, self.origin.y.into());
        put(&mut bytes, self.width.into());
        put(&mut bytes, self.height.into());
        put(&mut bytes, self.next_room.into());
        for layer in [&self.cells, &self.rooms] {
            put(&mut bytes, layer.len() as u64);
            for run in layer {
                put(&mut bytes, run.value.into());
                put(&mut bytes, run.length.into());
            }
        }
        words::put_words(&mut bytes, &self.annotations);
        room_words::put_room_changes(&mut bytes, &self.annotations.rooms);
        room_words::put_room_settings(&mut bytes, &self.annotations.settings);
        words::put_places(&mut bytes, &self.annotations.places);
        let sum = crc32(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    /// The map of `bytes`.
    ///
    /// # Errors
    /// What is wrong with them; nothing is taken from broken bytes.
    pub fn decode(bytes: &[u8]) -> Result<Self, StoredMapError> {
        let body = bytes.strip_prefix(MAGIC).ok_or(StoredMapError::NotAMap)?;
        let version = *body.first().ok_or(StoredMapError::Cut)?;
        if !(VERSION_MIN..=VERSION).contains(&version) {
            return Err(StoredMapError::Version(version));
        }
        let (whole, sum) = bytes.split_last_chunk::<4>().ok_or(StoredMapError::Cut)?;
        let (computed, stored) = (crc32(whole), u32::from_le_bytes(*sum));
        if computed != stored {
            return Err(StoredMapError::Checksum { computed, stored });
        }
        let body = whole.get(MAGIC.len() + 1..).ok_or(StoredMapError::Cut)?;
        Reader { rest: body }.map(version)
    }
}

/// What is left to read.
struct Reader<'bytes> {
    rest: &'bytes [u8],
}

impl Reader<'_> {
    fn map(mut self, version: u8) -> Result<StoredMap, StoredMapError> {
        let dock = self.dock(version)?;
        let origin = Cell {
            x: self.signed()?.try_into().map_err(|_| StoredMapError::Number)?,
            y: self.signed()?.try_into().map_err(|_| StoredMapError::Number)?,
        };
        let (width, height) = (self.number()?, self.number()?);
        let expected = width.checked_mul(height).filter(|cells| *cells <= CELLS_MAX);
        let expected = expected.ok_or(StoredMapError::TooLarge { width, height })?;
        let next_room = self.number()?.try_into().map_err(|_| StoredMapError::Number)?;
        let mut cells = self.layer(expected)?;
        take_floors(version, &mut cells)?;
        let rooms = self.layer(expected)?;
        let mut annotations = match version {
            1 => Annotations::default(),
            _ => self.words(version)?,
        };
        if version >= 3 {
            annotations.rooms = self.room_changes(next_room)?;
        }
        if version >= 4 {
            annotations.settings = self.room_settings(version)?;
        }
        if version >= 8 {
            annotations.places = self.places()?;
        }
        if !self.rest.is_empty() {
            return Err(StoredMapError::Trailing);
        }
        Ok(StoredMap {
            dock,
            origin,
            width: width.try_into().map_err(|_| StoredMapError::Number)?,
            height: height.try_into().map_err(|_| StoredMapError::Number)?,
            cells,
            rooms,
            next_room,
            annotations,
        })
    }

    /// A layer of `expected` cells, or one without any run.
    fn layer(&mut self, expected: u64) -> Result<Vec<Run>, StoredMapError> {
        let count = self.number()?;
        if count > RUNS_MAX {
            return Err(StoredMapError::Number);
        }
        let mut runs = Vec::new();
        let mut found: u64 = 0;
        for _ in 0..count {
            let run = Run {
                value: self.number()?.try_into().map_err(|_| StoredMapError::Number)?,
                length: self.number()?.try_into().map_err(|_| StoredMapError::Number)?,
            };
            found += u64::from(run.length);
            if found > expected {
                return Err(StoredMapError::Cells { expected, found });
            }
            runs.push(run);
        }
        if count > 0 && found != expected {
            return Err(StoredMapError::Cells { expected, found });
        }
        Ok(runs)
    }

    fn dock(&mut self, version: u8) -> Result<DockPlace, StoredMapError> {
        let felt = self.pose()?;
        if version < 6 {
            return Ok(felt.map_or_else(DockPlace::default, |(_, pose)| DockPlace::sure(pose)));
        }
        let told = self.pose()?.map(|(_, told)| told);
        let felt = felt.map(|(times, pose)| Felt { pose, times });
        Ok(DockPlace::from_parts(felt, told))
    }

    /// A number and, unless it is 0, the pose that follows it.
    fn pose(&mut self) -> Result<Option<(u8, Pose2)>, StoredMapError> {
        let number = self.number()?.try_into().map_err(|_| StoredMapError::Number)?;
        if number == 0 {
            return Ok(None);
        }
        let pose = Pose2 {
            x_m: self.millionths()?,
            y_m: self.millionths()?,
            heading_rad: self.millionths()?,
        };
        Ok(Some((number, pose)))
    }

    fn number(&mut self) -> Result<u64, StoredMapError> {
        let mut value = 0;
        for shift in (0..63).step_by(7) {
            let (byte, rest) = self.rest.split_first().ok_or(StoredMapError::Cut)?;
            self.rest = rest;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(StoredMapError::Number)
    }

    fn signed(&mut self) -> Result<i64, StoredMapError> {
        let value = self.number()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    fn millionths(&mut self) -> Result<f64, StoredMapError> {
        Ok(self.signed()? as f64 * 1e-6)
    }
}

/// Forgets what older versions kept where the kind of floor is now, and refuses kinds that there are not.
fn take_floors(version: u8, cells: &mut [Run]) -> Result<(), StoredMapError> {
    if version < 9 {
        cells.iter_mut().for_each(|run| run.value &= !FLOOR_BITS);
    }
    let is_known = |run: &Run| run.value & FLOOR_BITS != FLOOR_BITS;
    cells
        .iter()
        .all(is_known)
        .then_some(())
        .ok_or(StoredMapError::Floor)
}

/// A number that is not 0 and a pose, or 0.
fn put_pose(bytes: &mut Vec<u8>, numbered: Option<(u8, Pose2)>) {
    let Some((number, pose)) = numbered else {
        return put(bytes, 0);
    };
    put(bytes, number.into());
    for value in [pose.x_m, pose.y_m, pose.heading_rad] {
        put_signed(bytes, libm::round(value * 1e6) as i64);
    }
}

fn put(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push((value & 0x7F) as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

fn put_signed(bytes: &mut Vec<u8>, value: i64) {
    // Nine bytes hold 63 bits; nothing that is stored comes near.
    let bounded = value.clamp(-(1 << 60), 1 << 60);
    put(bytes, ((bounded << 1) ^ (bounded >> 63)) as u64);
}

fn crc32(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for byte in bytes {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            sum = (sum >> 1) ^ (0xEDB8_8320 & (sum & 1).wrapping_neg());
        }
    }
    !sum
}

#[cfg(test)]
mod tests {
    use super::{StoredMap, StoredMapError, crc32};
    use crate::mapping::dock::Felt;
    use crate::mapping::{
        Annotations, Cell, CellKnowledge, DockPlace, FloorKind, Map, PartSide, Raster, RoomChange, RoomJoin,
        RoomSplit,
    };
    use crate::model::config::{Body, SensorLayout};
    use crate::model::cut_line::CutLine;
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::kept_place::{KeptPlace, PlaceShape};
    use crate::model::no_go::{NoGo, RoomName};
    use crate::model::room_settings::{Pattern, RoomPower, RoomSettings};
    use crate::model::zone::Zone;

    const BODY: Body = Body {
        radius_m: 0.17,
        swath_m: 0.26,
        track_m: 0.24,
    };

    fn map() -> StoredMap {
        let mut raster = Raster::filled(Cell { x: -7, y: 300 }, 9, 5, CellKnowledge::Unknown);
        let kinds = [
            CellKnowledge::Free,
            CellKnowledge::Occupied,
            CellKnowledge::Cliff,
            CellKnowledge::NoGo,
        ];
        for (index, place) in raster.values_mut().iter_mut().enumerate().skip(3) {
            *place = kinds[(index / 3) % 4];
        }
        let dock = Pose2 {
            x_m: -1.25,
            y_m: 2.5,
            heading_rad: -3.0,
        };
        let next_room = 7;
        StoredMap {
            next_room,
            ..StoredMap::from_raster(&raster, Some(dock)).with_annotations(words())
        }
    }

    fn words() -> Annotations {
        let at = |x_m, y_m| Point2 { x_m, y_m };
        let zone = Zone::new(vec![at(0.1, 0.2), at(1.0 / 3.0, 0.2), at(0.1, -7.0)]).unwrap();
        let mut words = Annotations::default();
        let cats = RoomName::new("Cats").unwrap();
        words
            .add(NoGo::zone(&zone).unwrap().with_name(Some(cats)))
            .unwrap();
        words
            .add(NoGo::wall(at(0.0, 0.0), at(2.0 / 3.0, 1e-5)).unwrap())
            .unwrap();
        words.call(3, Some(RoomName::new("Köök").unwrap()));
        let split = |part| RoomSplit {
            room: 3,
            part,
            side: PartSide::Right,
            line: CutLine::new(at(-1.0, 1.0 / 3.0), at(2.0, 0.5)).unwrap(),
        };
        let join = RoomJoin {
            kept: 3,
            lost: 2,
            at: [at(0.5, 0.25), at(-1.5, 2.0)],
        };
        words.rooms.add(RoomChange::Split(split(5))).unwrap();
        words.rooms.take_back(1).unwrap();
        words.rooms.add(RoomChange::Split(split(6))).unwrap();
        words.rooms.add(RoomChange::Join(join)).unwrap();
        let power = RoomPower {
            suction: 25,
            ..RoomPower::FULL
        };
        let settings = RoomSettings::new(2, power).unwrap();
        words.settings.insert(3, settings.with_pattern(Pattern::Contour));
        let named =
            |name: &str, shape: PlaceShape| KeptPlace::new(RoomName::new(name).unwrap(), &shape).unwrap();
        let places = [
            (2, named("Table", PlaceShape::Zone(zone))),
            (4, named("Bowl", PlaceShape::Spot(at(1.0 / 7.0, -0.2)))),
        ];
        words.places.kept.extend(places);
        words.places.next = 9;
        words
    }

    #[test]
    fn a_map_of_the_first_version_is_read() {
        let mut bytes = b"RVACMAP\x01".to_vec();
        // No dock, at the origin, 2 x 3 cells of one kind, no room yet.
        bytes.extend([0, 0, 0, 2, 3, 1, 1, 5, 6, 0]);
        bytes.extend(crc32(&bytes).to_le_bytes());
        let map = StoredMap::decode(&bytes).unwrap();
        assert_eq!(map.knowledge().values().len(), 6);
        assert!(map.annotations().is_empty());
        assert_eq!(StoredMap::decode(&map.encode()), Ok(map));
    }

    #[test]
    fn a_map_of_the_second_version_has_no_changes_of_rooms() {
        let mut bytes = b"RVACMAP\x02".to_vec();
        // The same cells; the next no-go zone is the first one, none is there; room 1 is called A.
        bytes.extend([0, 0, 0, 2, 3, 1, 1, 5, 6, 0, 1, 0, 1, 1, 1, b'A']);
        bytes.extend(crc32(&bytes).to_le_bytes());
        let map = StoredMap::decode(&bytes).unwrap();
        assert_eq!(map.annotations().name(1).map(RoomName::as_str), Some("A"));
        assert!(map.annotations().room_changes().is_empty());
        assert_eq!(StoredMap::decode(&map.encode()), Ok(map));
    }

    #[test]
    fn no_go_zones_of_the_sixth_version_have_no_names() {
        // No dock was felt or told; the same cells; no-go zone 1 of 2 is a wall from 0, 0 to 1, 0 micrometres; no names, changes, settings.
        let begin = [0, 0, 0, 0, 2, 3, 1, 1, 5, 6, 0, 2, 1, 1, 1, 0, 0, 2, 0];
        let read = |version: u8, name: &[u8]| {
            let mut bytes = b"RVACMAP".to_vec();
            bytes.push(version);
            bytes.extend(begin);
            bytes.extend(name);
            bytes.extend([0, 1, 0, 0, 0]);
            bytes.extend(crc32(&bytes).to_le_bytes());
            StoredMap::decode(&bytes)
        };
        let name = |map: &StoredMap| {
            let mut all = map.annotations().no_go();
            let (_, no_go) = all.next().unwrap();
            no_go.name().map(|name| name.as_str().to_owned())
        };
        let older = read(6, &[]).unwrap();
        assert_eq!(name(&older), None);
        assert_eq!(StoredMap::decode(&older.encode()), Ok(older));
        assert_eq!(name(&read(7, &[1, b'A']).unwrap()), Some("A".to_owned()));
        assert_eq!(name(&read(7, &[0]).unwrap()), None);
        assert_eq!(read(7, &[1, b' ']), Err(StoredMapError::Name));
    }

    #[test]
    fn a_map_before_the_eighth_version_keeps_no_places_and_bad_ones_are_refused() {
        let read = |version: u8, places: &[u8]| {
            let mut bytes = b"RVACMAP".to_vec();
            bytes.push(version);
            bytes.extend([0, 0, 0, 0, 2, 3, 1, 1, 5, 6, 0, 1, 0, 0, 1, 0, 0, 0]);
            bytes.extend(places);
            bytes.extend(crc32(&bytes).to_le_bytes());
            StoredMap::decode(&bytes)
        };
        let older = read(7, &[]).unwrap();
        assert_eq!(older.annotations().places().count(), 0);
        assert_eq!(StoredMap::decode(&older.encode()), Ok(older));
        // The next number, how many; number, name, kind, middle.
        let newer = read(8, &[3, 1, 2, 1, b'A', 1, 2, 4]).unwrap();
        let place = newer.annotations().place(2).unwrap();
        assert_eq!(place.name().as_str(), "A");
        assert_eq!(StoredMap::decode(&newer.encode()), Ok(newer));
        for bad in [
            // Number 3 where the next one is 3; kind 7; a zone of no corners.
            &[3, 1, 3, 1, b'A', 1, 2, 4][..],
            &[3, 1, 2, 1, b'A', 7, 2, 4],
            &[3, 1, 2, 1, b'A', 0, 0],
        ] {
            assert_eq!(read(8, bad), Err(StoredMapError::Place), "{bad:?}");
        }
        assert_eq!(read(8, &[3, 1, 2, 0, 1, 2, 4]), Err(StoredMapError::Name));
    }

    #[test]
    fn a_change_of_rooms_that_cannot_be_is_refused() {
        // As above in version 3, with the next change and then the changes: number, kind, rooms, places.
        let begin = [0, 0, 0, 2, 3, 9, 1, 5, 6, 0, 1, 0, 0];
        let good: [&[u8]; 2] = [&[2, 1, 1, 1, 1, 2, 0, 0, 2, 2, 0], &[1, 0, 0]];
        let bad: [&[u8]; 6] = [
            // Number 1 where the next one is 1; rooms 1 and 1; room 0; room 9, which is yet to come; kind 7; a line without length.
            &[1, 1, 1, 1, 1, 2, 0, 0, 2, 2, 0],
            &[2, 1, 1, 1, 1, 1, 0, 0, 2, 2, 0],
            &[2, 1, 1, 1, 0, 2, 0, 0, 2, 2, 0],
            &[2, 1, 1, 1, 1, 9, 0, 0, 2, 2, 0],
            &[2, 1, 1, 7, 1, 2, 0, 0, 2, 2, 0],
            &[2, 1, 1, 0, 1, 2, 0, 0, 0, 0, 0, 0],
        ];
        let read = |rest: &[u8]| {
            let mut bytes = b"RVACMAP\x03".to_vec();
            bytes.extend(begin);
            bytes.extend(rest);
            bytes.extend(crc32(&bytes).to_le_bytes());
            StoredMap::decode(&bytes)
        };
        for rest in good {
            assert!(read(rest).is_ok(), "{rest:?}: {:?}", read(rest).err());
        }
        for rest in bad {
            assert_eq!(read(rest), Err(StoredMapError::RoomChange), "{rest:?}");
        }
    }

    #[test]
    fn settings_that_no_room_can_have_are_refused() {
        let read = |version: u8, settings: &[u8]| {
            let mut bytes = b"RVACMAP".to_vec();
            bytes.push(version);
            bytes.extend([0, 0, 0, 2, 3, 9, 1, 5, 6, 0, 1, 0, 0, 1, 0, 0, 1]);
            bytes.extend(settings);
            bytes.extend(crc32(&bytes).to_le_bytes());
            StoredMap::decode(&bytes)
        };
        // Room, passes, suction, main brush, side brushes; since version 5 the pattern.
        let settings = |map: StoredMap| {
            let settings = *map.annotations().settings(2).unwrap();
            (settings.passes(), settings.pattern())
        };
        assert_eq!(
            settings(read(4, &[2, 3, 50, 100, 0]).unwrap()),
            (3, Pattern::Lines)
        );
        let newer = read(5, &[2, 3, 50, 100, 0, 1]).unwrap();
        assert_eq!(settings(newer), (3, Pattern::Contour));
        for bad in [[2, 4, 50, 100, 0], [2, 1, 101, 0, 0], [2, 1, 0, 0, 0]] {
            assert_eq!(read(4, &bad), Err(StoredMapError::RoomSettings), "{bad:?}");
        }
        let pattern = [2, 3, 50, 100, 0, 2];
        assert_eq!(read(5, &pattern), Err(StoredMapError::RoomSettings));
    }

    #[test]
    fn kinds_of_floor_are_read_since_version_nine_and_what_stood_there_before_is_not() {
        let floors = |version: u8, felt: u16| {
            let mut bytes = b"RVACMAP".to_vec();
            bytes.push(version);
            // Docks, window of six cells, next room, one run of cells, no rooms; nothing that people have said.
            let docks: &[u8] = if version < 6 { &[0] } else { &[0, 0] };
            bytes.extend(docks);
            bytes.extend([0, 0, 2, 3, 1, 1]);
            super::put(&mut bytes, u64::from(0x1400 | felt << 8));
            bytes.extend([6, 0]);
            bytes.extend(match version {
                1 => &[][..],
                2 => &[0; 3],
                _ => &[0; 9],
            });
            bytes.extend(crc32(&bytes).to_le_bytes());
            StoredMap::decode(&bytes).map(|stored| {
                let mut map = Map::new(BODY, SensorLayout::default());
                map.take_up(&stored);
                map.floor_kind(Cell { x: 1, y: 1 })
            })
        };
        assert_eq!(floors(9, 0), Ok(None));
        assert_eq!(floors(9, 1), Ok(Some(FloorKind::Hard)));
        assert_eq!(floors(9, 2), Ok(Some(FloorKind::Carpet)));
        assert_eq!(floors(9, 3), Err(StoredMapError::Floor));
        for felt in 0..4 {
            assert_eq!(floors(1, felt), Ok(None), "slip of {felt}");
            assert_eq!(floors(2, felt), Ok(None), "slip of {felt}");
        }
    }

    #[test]
    fn the_checksum_is_the_usual_one() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }

    #[test]
    fn a_map_comes_back_and_its_knowledge_with_it() {
        let told = DockPlace::from_parts(None, Some(Pose2::IDENTITY));
        let once = map().dock().map(|pose| Felt { pose, times: 1 });
        let both = DockPlace::from_parts(once, Some(Pose2::IDENTITY));
        let docks = [DockPlace::default(), told, both].map(|dock| map().with_dock_place(dock));
        for map in [map(), StoredMap::default()].into_iter().chain(docks) {
            let back = StoredMap::decode(&map.encode()).unwrap();
            assert_eq!(back, map);
            assert_eq!(back.knowledge(), map.knowledge());
        }
    }

    #[test]
    fn every_cut_and_every_flipped_bit_is_refused() {
        let bytes = map().encode();
        for length in 0..bytes.len() {
            assert!(StoredMap::decode(&bytes[..length]).is_err(), "cut at {length}");
        }
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(StoredMap::decode(&flipped).is_err(), "flipped bit {bit}");
        }
    }

    /// With a checksum that fits, as after a fault of the writer.
    fn refused(body: &[u8]) -> StoredMapError {
        let mut bytes = b"RVACMAP\x01".to_vec();
        bytes.extend(body);
        bytes.extend(crc32(&bytes).to_le_bytes());
        StoredMap::decode(&bytes).unwrap_err()
    }

    #[test]
    fn what_is_wrong_is_named() {
        assert_eq!(StoredMap::decode(b"RVACMOP"), Err(StoredMapError::NotAMap));
        assert_eq!(
            StoredMap::decode(b"RVACMAP\x0A"),
            Err(StoredMapError::Version(10))
        );
        assert_eq!(refused(&[0, 0, 0]), StoredMapError::Cut);
        let enormous = [0, 0, 0, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF, 0x7F, 1];
        assert!(matches!(refused(&enormous), StoredMapError::TooLarge { .. }));
        let seven_of_six = [0, 0, 0, 2, 3, 1, 1, 5, 7, 0];
        assert_eq!(
            refused(&seven_of_six),
            StoredMapError::Cells {
                expected: 6,
                found: 7
            }
        );
        assert_eq!(refused(&[0, 0, 0, 2, 3, 1, 0, 0, 9]), StoredMapError::Trailing);
        assert_eq!(refused(&[0xFF; 12]), StoredMapError::Number);
    }
}
