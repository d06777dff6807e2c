//! What people have said of the home, as bytes: the number of the next no-go zone, the zones and walls with their names, the names
//! of rooms. A name is its length in bytes and these; length 0 is no name.

use super::{Reader, StoredMapError, put, put_signed};
use crate::mapping::Annotations;
use crate::mapping::annotations::{KeptPlaces, NAMES_MAX, NO_GO_MAX, PLACES_MAX};
use crate::model::geometry::Point2;
use crate::model::kept_place::{KeptPlace, PlaceShape};
use crate::model::no_go::{NoGo, NoGoShape, RoomName};
use crate::model::zone::{CORNERS_MAX, Zone};

const ZONE: u64 = 0;
const WALL: u64 = 1;
const SPOT: u64 = 1;

pub(super) fn put_words(bytes: &mut Vec<u8>, words: &Annotations) {
    put(bytes, words.next_no_go.into());
    put(bytes, words.no_go.len() as u64);
    for (number, no_go) in &words.no_go {
        put(bytes, u64::from(*number));
        match no_go.shape() {
            NoGoShape::Zone => {
                put(bytes, ZONE);
                put_corners(bytes, no_go.area());
            }
            NoGoShape::Wall { from, to } => {
                put(bytes, WALL);
                put_point(bytes, from);
                put_point(bytes, to);
            }
        }
        put_name(bytes, no_go.name());
    }
    put(bytes, words.names.len() as u64);
    for (room, name) in &words.names {
        put(bytes, u64::from(*room));
        put_name(bytes, Some(name));
    }
}

/// The number of the next place, and the places: number, name, kind, corners or middle.
pub(super) fn put_places(bytes: &mut Vec<u8>, places: &KeptPlaces) {
    put(bytes, places.next.into());
    put(bytes, places.kept.len() as u64);
    for (number, place) in &places.kept {
        put(bytes, u64::from(*number));
        put_name(bytes, Some(place.name()));
        match place.shape() {
            PlaceShape::Zone(zone) => {
                put(bytes, ZONE);
                put_corners(bytes, zone);
            }
            PlaceShape::Spot(middle) => {
                put(bytes, SPOT);
                put_point(bytes, *middle);
            }
        }
    }
}

fn put_corners(bytes: &mut Vec<u8>, zone: &Zone) {
    put(bytes, zone.corners().len() as u64);
    for corner in zone.corners() {
        put_point(bytes, *corner);
    }
}

fn put_name(bytes: &mut Vec<u8>, name: Option<&RoomName>) {
    let name = name.map_or("", RoomName::as_str);
    put(bytes, name.len() as u64);
    bytes.extend_from_slice(name.as_bytes());
}

pub(super) fn put_point(bytes: &mut Vec<u8>, point: Point2) {
    for metres in [point.x_m, point.y_m] {
        put_signed(bytes, libm::round(metres * 1e6) as i64);
    }
}

impl Reader<'_> {
    /// Before version 7 what is forbidden has no names.
    pub(super) fn words(&mut self, version: u8) -> Result<Annotations, StoredMapError> {
        let mut words = Annotations {
            next_no_go: self.short()?,
            ..Annotations::default()
        };
        for _ in 0..self.count(NO_GO_MAX)? {
            let number = self.short()?;
            let no_go = match version {
                ..7 => self.no_go()?,
                _ => self.no_go()?.with_name(self.name_or_none()?),
            };
            if number >= words.next_no_go || words.no_go.insert(number, no_go).is_some() {
                return Err(StoredMapError::NoGo);
            }
        }
        for _ in 0..self.count(NAMES_MAX)? {
            let room = self.short()?;
            let name = self.name()?;
            words.names.insert(room, name);
        }
        Ok(words)
    }

    pub(super) fn places(&mut self) -> Result<KeptPlaces, StoredMapError> {
        let mut places = KeptPlaces {
            next: self.short()?,
            ..KeptPlaces::default()
        };
        for _ in 0..self.count(PLACES_MAX)? {
            let number = self.short()?;
            let place = self.place()?;
            if number >= places.next || places.kept.insert(number, place).is_some() {
                return Err(StoredMapError::Place);
            }
        }
        Ok(places)
    }

    fn place(&mut self) -> Result<KeptPlace, StoredMapError> {
        let name = self.name()?;
        let shape = match self.number()? {
            ZONE => PlaceShape::Zone(self.zone()?.ok_or(StoredMapError::Place)?),
            SPOT => PlaceShape::Spot(self.point()?),
            _ => return Err(StoredMapError::Place),
        };
        KeptPlace::new(name, &shape).map_err(|_| StoredMapError::Place)
    }

    /// `None` for corners that are those of no zone.
    fn zone(&mut self) -> Result<Option<Zone>, StoredMapError> {
        let count = self.number()?;
        if count > CORNERS_MAX as u64 {
            return Ok(None);
        }
        let corners: Result<Vec<Point2>, StoredMapError> = (0..count).map(|_| self.point()).collect();
        Ok(Zone::new(corners?).ok())
    }

    fn no_go(&mut self) -> Result<NoGo, StoredMapError> {
        let no_go = match self.number()? {
            ZONE => NoGo::zone(&self.zone()?.ok_or(StoredMapError::NoGo)?),
            WALL => NoGo::wall(self.point()?, self.point()?),
            _ => return Err(StoredMapError::NoGo),
        };
        no_go.map_err(|_| StoredMapError::NoGo)
    }

    fn name(&mut self) -> Result<RoomName, StoredMapError> {
        self.name_or_none()?.ok_or(StoredMapError::Name)
    }

    fn name_or_none(&mut self) -> Result<Option<RoomName>, StoredMapError> {
        let length = usize::try_from(self.number()?).map_err(|_| StoredMapError::Name)?;
        let (name, rest) = self.rest.split_at_checked(length).ok_or(StoredMapError::Cut)?;
        self.rest = rest;
        let name = core::str::from_utf8(name).map_err(|_| StoredMapError::Name)?;
        if name.is_empty() {
            return Ok(None);
        }
        RoomName::new(name).map(Some).map_err(|_| StoredMapError::Name)
    }

    pub(super) fn point(&mut self) -> Result<Point2, StoredMapError> {
        Ok(Point2 {
            x_m: self.millionths()?,
            y_m: self.millionths()?,
        })
    }

    pub(super) fn short(&mut self) -> Result<u16, StoredMapError> {
        self.number()?.try_into().map_err(|_| StoredMapError::Number)
    }

    pub(super) fn count(&mut self, most: usize) -> Result<u64, StoredMapError> {
        let count = self.number()?;
        if count > most as u64 {
            return Err(StoredMapError::Number);
        }
        Ok(count)
    }
}
