//! How people changed the rooms, as bytes: the number of the next change, the changes, and the splits that were taken back;
//! and how rooms are cleaned.

use std::collections::BTreeMap;

use super::{Reader, StoredMapError, put};
use crate::mapping::annotations::NAMES_MAX;
use crate::mapping::room_changes::CHANGES_MAX;
use crate::mapping::{PartSide, RoomChange, RoomChanges, RoomJoin, RoomSplit};
use crate::model::cut_line::CutLine;
use crate::model::geometry::Point2;
use crate::model::room_settings::{Pattern, RoomPower, RoomSettings};

const LEFT: u64 = 0;
const JOIN: u64 = 1;
const RIGHT: u64 = 2;

const LINES: u8 = 0;
const CONTOUR: u8 = 1;

pub(super) fn put_room_changes(bytes: &mut Vec<u8>, changes: &RoomChanges) {
    put(bytes, changes.next.into());
    put(bytes, changes.made.len() as u64);
    for (number, change) in &changes.made {
        put(bytes, u64::from(*number));
        match change {
            RoomChange::Split(split) => put_split(bytes, split),
            RoomChange::Join(join) => put_change(bytes, (JOIN, [join.kept, join.lost], join.at)),
        }
    }
    put(bytes, changes.taken_back.len() as u64);
    for split in &changes.taken_back {
        put_split(bytes, split);
    }
}

pub(super) fn put_room_settings(bytes: &mut Vec<u8>, settings: &BTreeMap<u16, RoomSettings>) {
    put(bytes, settings.len() as u64);
    for (room, settings) in settings {
        let power = settings.power();
        put(bytes, u64::from(*room));
        for value in [
            settings.passes(),
            power.suction,
            power.main_brush,
            power.side_brushes,
            match settings.pattern() {
                Pattern::Lines => LINES,
                Pattern::Contour => CONTOUR,
            },
        ] {
            put(bytes, u64::from(value));
        }
    }
}

fn put_split(bytes: &mut Vec<u8>, split: &RoomSplit) {
    let kind = match split.side {
        PartSide::Left => LEFT,
        PartSide::Right => RIGHT,
    };
    put_change(bytes, (kind, [split.room, split.part], split.line.ends()));
}

fn put_change(bytes: &mut Vec<u8>, (kind, rooms, places): (u64, [u16; 2], [Point2; 2])) {
    put(bytes, kind);
    rooms.iter().for_each(|room| put(bytes, u64::from(*room)));
    places
        .iter()
        .for_each(|place| super::words::put_point(bytes, *place));
}

impl Reader<'_> {
    /// Changes that speak of rooms before `next_room`.
    pub(super) fn room_changes(&mut self, next_room: u16) -> Result<RoomChanges, StoredMapError> {
        let mut changes = RoomChanges {
            next: self.short()?,
            ..RoomChanges::default()
        };
        for _ in 0..self.count(CHANGES_MAX)? {
            let number = self.short()?;
            let change = self.room_change(next_room)?;
            if number >= changes.next || changes.made.insert(number, change).is_some() {
                return Err(StoredMapError::RoomChange);
            }
        }
        for _ in 0..self.count(CHANGES_MAX)? {
            match self.room_change(next_room)? {
                RoomChange::Split(split) => changes.taken_back.push(split),
                RoomChange::Join(_) => return Err(StoredMapError::RoomChange),
            }
        }
        Ok(changes)
    }

    /// Before version 5 all rooms are swept in lines.
    pub(super) fn room_settings(
        &mut self,
        version: u8,
    ) -> Result<BTreeMap<u16, RoomSettings>, StoredMapError> {
        let mut all = BTreeMap::new();
        for _ in 0..self.count(NAMES_MAX)? {
            let room = self.short()?;
            let mut byte = || u8::try_from(self.number()?).map_err(|_| StoredMapError::RoomSettings);
            let passes = byte()?;
            let power = RoomPower {
                suction: byte()?,
                main_brush: byte()?,
                side_brushes: byte()?,
            };
            let settings = RoomSettings::new(passes, power).map_err(|_| StoredMapError::RoomSettings)?;
            let pattern = match version {
                ..5 => Pattern::Lines,
                _ => self.pattern()?,
            };
            all.insert(room, settings.with_pattern(pattern));
        }
        Ok(all)
    }

    fn pattern(&mut self) -> Result<Pattern, StoredMapError> {
        match u8::try_from(self.number()?) {
            Ok(LINES) => Ok(Pattern::Lines),
            Ok(CONTOUR) => Ok(Pattern::Contour),
            _ => Err(StoredMapError::RoomSettings),
        }
    }

    fn room_change(&mut self, next_room: u16) -> Result<RoomChange, StoredMapError> {
        let kind = self.number()?;
        let rooms = [self.short()?, self.short()?];
        let known = 1..next_room;
        if rooms[0] == rooms[1] || !rooms.iter().all(|room| known.contains(room)) {
            return Err(StoredMapError::RoomChange);
        }
        let at = [self.point()?, self.point()?];
        let [room, part] = rooms;
        let split = |side| {
            let line = CutLine::new(at[0], at[1]).map_err(|_| StoredMapError::RoomChange)?;
            Ok(RoomChange::Split(RoomSplit {
                room,
                part,
                side,
                line,
            }))
        };
        match kind {
            LEFT => split(PartSide::Left),
            RIGHT => split(PartSide::Right),
            JOIN => Ok(RoomChange::Join(RoomJoin {
                kept: room,
                lost: part,
                at,
            })),
            _ => Err(StoredMapError::RoomChange),
        }
    }
}
