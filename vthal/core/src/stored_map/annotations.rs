//! What people have said of the home, as the bytes of a stored map hold it.

use brain::mapping::{self, PartSide, RoomJoin, RoomSplit};
use brain::{CutLine, KeptPlace, Point2, RoomName, RoomPower, StoredMapError, Zone};
use serde::{Deserialize, Serialize};

/// x and y.
type Point = [i64; 2];

/// Things with numbers that are given once, from 1.
#[derive(Serialize, Deserialize)]
pub(super) struct Numbered<T> {
    next: u16,
    items: Vec<(u16, T)>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct NoGo {
    pub(super) shape: NoGoShape,
    /// Empty if it has none.
    pub(super) name: String,
}

#[derive(Serialize, Deserialize)]
pub(super) enum NoGoShape {
    Zone(Vec<Point>),
    Wall { from: Point, to: Point },
}

#[derive(Default, Serialize, Deserialize)]
pub(super) struct RoomChanges {
    pub(super) made: Numbered<RoomChange>,
    pub(super) taken_back: Vec<RoomChange>,
}

#[derive(Serialize, Deserialize)]
pub(super) enum RoomChange {
    /// The part lies left of the line.
    SplitLeft(Change),
    Join(Change),
    /// The part lies right of the line.
    SplitRight(Change),
}

/// A room and its part with the ends of the line between them, or a room and the one that joins it with a place in each.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Change {
    rooms: [u16; 2],
    places: [Point; 2],
}

#[derive(Serialize, Deserialize)]
pub(super) struct RoomSettings {
    pub(super) passes: u8,
    pub(super) suction: u8,
    pub(super) main_brush: u8,
    pub(super) side_brushes: u8,
    pub(super) pattern: Pattern,
}

#[derive(Serialize, Deserialize)]
pub(super) enum Pattern {
    Lines,
    Contour,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Place {
    name: String,
    shape: PlaceShape,
}

#[derive(Serialize, Deserialize)]
enum PlaceShape {
    Zone(Vec<Point>),
    Spot(Point),
}

impl<T> Default for Numbered<T> {
    fn default() -> Self {
        Self {
            next: 1,
            items: Vec::new(),
        }
    }
}

impl<T> Numbered<T> {
    /// The same numbers with what `made` makes of each thing.
    pub(super) fn map<U>(self, made: impl Fn(T) -> U) -> Numbered<U> {
        let items = self.items.into_iter();
        Numbered {
            next: self.next,
            items: items.map(|(number, item)| (number, made(item))).collect(),
        }
    }

    pub(super) fn of<P: Into<T>>(parts: mapping::Numbered<P>) -> Self {
        let items = parts.items.into_iter();
        Self {
            next: parts.next,
            items: items.map(|(number, item)| (number, item.into())).collect(),
        }
    }

    pub(super) fn parts<P: TryFrom<T, Error = StoredMapError>>(
        self,
    ) -> Result<mapping::Numbered<P>, StoredMapError> {
        let items = self.items.into_iter();
        let items = items.map(|(number, item)| Ok((number, item.try_into()?)));
        Ok(mapping::Numbered {
            next: self.next,
            items: items.collect::<Result<_, _>>()?,
        })
    }
}

/// Whole millionths of a value that is far from the largest number.
pub(super) fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

pub(super) fn of_millionths(value: i64) -> f64 {
    value as f64 * 1e-6
}

fn point(point: Point2) -> Point {
    [point.x_m, point.y_m].map(millionths)
}

fn to_point(point: Point) -> Point2 {
    let [x_m, y_m] = point.map(of_millionths);
    Point2 { x_m, y_m }
}

fn corners(zone: &Zone) -> Vec<Point> {
    zone.corners().iter().copied().map(point).collect()
}

/// The zone of these corners, if any zone has them.
fn zone(corners: Vec<Point>) -> Option<Zone> {
    Zone::of_stored(corners.into_iter().map(to_point).collect()).ok()
}

pub(super) fn room_name(text: &str) -> Result<RoomName, StoredMapError> {
    RoomName::new(text).map_err(|_| StoredMapError::Name)
}

impl From<brain::NoGo> for NoGo {
    fn from(no_go: brain::NoGo) -> Self {
        let shape = match no_go.shape() {
            brain::NoGoShape::Zone => NoGoShape::Zone(corners(no_go.area())),
            brain::NoGoShape::Wall { from, to } => NoGoShape::Wall {
                from: point(from),
                to: point(to),
            },
        };
        let name = no_go.name().map_or("", RoomName::as_str).to_owned();
        Self { shape, name }
    }
}

impl TryFrom<NoGo> for brain::NoGo {
    type Error = StoredMapError;

    fn try_from(kept: NoGo) -> Result<Self, StoredMapError> {
        let no_go = match kept.shape {
            NoGoShape::Zone(corners) => Self::zone(&zone(corners).ok_or(StoredMapError::NoGo)?),
            NoGoShape::Wall { from, to } => Self::wall(to_point(from), to_point(to)),
        };
        let no_go = no_go.map_err(|_| StoredMapError::NoGo)?;
        match kept.name.as_str() {
            "" => Ok(no_go),
            name => Ok(no_go.with_name(Some(room_name(name)?))),
        }
    }
}

impl From<KeptPlace> for Place {
    fn from(place: KeptPlace) -> Self {
        Self {
            name: place.name().as_str().to_owned(),
            shape: match place.shape() {
                brain::PlaceShape::Zone(zone) => PlaceShape::Zone(corners(zone)),
                brain::PlaceShape::Spot(middle) => PlaceShape::Spot(point(*middle)),
            },
        }
    }
}

impl TryFrom<Place> for KeptPlace {
    type Error = StoredMapError;

    fn try_from(kept: Place) -> Result<Self, StoredMapError> {
        let name = room_name(&kept.name)?;
        let shape = match kept.shape {
            PlaceShape::Zone(corners) => brain::PlaceShape::Zone(zone(corners).ok_or(StoredMapError::Place)?),
            PlaceShape::Spot(middle) => brain::PlaceShape::Spot(to_point(middle)),
        };
        Self::new(name, &shape).map_err(|_| StoredMapError::Place)
    }
}

impl From<RoomSplit> for RoomChange {
    fn from(split: RoomSplit) -> Self {
        let change = Change {
            rooms: [split.room, split.part],
            places: split.line.ends().map(point),
        };
        match split.side {
            PartSide::Left => Self::SplitLeft(change),
            PartSide::Right => Self::SplitRight(change),
        }
    }
}

impl From<mapping::RoomChange> for RoomChange {
    fn from(change: mapping::RoomChange) -> Self {
        match change {
            mapping::RoomChange::Split(split) => split.into(),
            mapping::RoomChange::Join(join) => Self::Join(Change {
                rooms: [join.kept, join.lost],
                places: join.at.map(point),
            }),
        }
    }
}

impl TryFrom<RoomChange> for mapping::RoomChange {
    type Error = StoredMapError;

    fn try_from(change: RoomChange) -> Result<Self, StoredMapError> {
        match change {
            RoomChange::SplitLeft(change) => Ok(Self::Split(change.split(PartSide::Left)?)),
            RoomChange::SplitRight(change) => Ok(Self::Split(change.split(PartSide::Right)?)),
            RoomChange::Join(change) => {
                let [kept, lost] = change.rooms;
                let at = change.places.map(to_point);
                Ok(Self::Join(RoomJoin { kept, lost, at }))
            }
        }
    }
}

impl TryFrom<RoomChange> for RoomSplit {
    type Error = StoredMapError;

    fn try_from(change: RoomChange) -> Result<Self, StoredMapError> {
        match change.try_into()? {
            mapping::RoomChange::Split(split) => Ok(split),
            mapping::RoomChange::Join(_) => Err(StoredMapError::RoomChange),
        }
    }
}

impl Change {
    fn split(self, side: PartSide) -> Result<RoomSplit, StoredMapError> {
        let [room, part] = self.rooms;
        let [from, to] = self.places.map(to_point);
        let line = CutLine::new(from, to).map_err(|_| StoredMapError::RoomChange)?;
        Ok(RoomSplit {
            room,
            part,
            side,
            line,
        })
    }
}

impl From<brain::RoomSettings> for RoomSettings {
    fn from(settings: brain::RoomSettings) -> Self {
        let power = settings.power();
        Self {
            passes: settings.passes(),
            suction: power.suction,
            main_brush: power.main_brush,
            side_brushes: power.side_brushes,
            pattern: match settings.pattern() {
                brain::Pattern::Lines => Pattern::Lines,
                brain::Pattern::Contour => Pattern::Contour,
            },
        }
    }
}

impl TryFrom<RoomSettings> for brain::RoomSettings {
    type Error = StoredMapError;

    fn try_from(kept: RoomSettings) -> Result<Self, StoredMapError> {
        let power = RoomPower {
            suction: kept.suction,
            main_brush: kept.main_brush,
            side_brushes: kept.side_brushes,
        };
        let settings = Self::new(kept.passes, power).map_err(|_| StoredMapError::RoomSettings)?;
        Ok(settings.with_pattern(match kept.pattern {
            Pattern::Lines => brain::Pattern::Lines,
            Pattern::Contour => brain::Pattern::Contour,
        }))
    }
}
