//! What the bytes of a stored map hold: its parts, with lengths in whole micrometres and angles in microradians.

use std::collections::BTreeMap;

use brain::mapping::{self, Felt, PartSide, RoomJoin, RoomSplit, StoredMapParts};
use brain::{Cell, CutLine, KeptPlace, Point2, Pose2, RoomName, RoomPower, StoredMap, StoredMapError, Zone};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
pub(super) struct Body {
    pub(super) felt_dock: Option<FeltDock>,
    pub(super) told_dock: Option<Pose>,
    pub(super) layers: Layers,
    pub(super) no_go: Numbered<NoGo>,
    pub(super) names: Vec<(u16, String)>,
    pub(super) room_changes: RoomChanges,
    pub(super) room_settings: Vec<(u16, RoomSettings)>,
    pub(super) places: Numbered<Place>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct FeltDock {
    pub(super) times: u8,
    pub(super) pose: Pose,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Pose {
    x_um: i64,
    y_um: i64,
    heading_urad: i64,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Point {
    x_um: i64,
    y_um: i64,
}

/// What each cell of the window holds and in which room it lies.
#[derive(Serialize, Deserialize)]
pub(super) struct Layers {
    origin_x: i32,
    origin_y: i32,
    width: u32,
    height: u32,
    next_room: u16,
    pub(super) cells: Vec<Run>,
    rooms: Vec<Run>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Run {
    pub(super) value: u16,
    length: u32,
}

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
    made: Numbered<RoomChange>,
    taken_back: Vec<RoomChange>,
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

impl Body {
    pub(super) fn of(map: &StoredMap) -> Self {
        let parts = map.parts();
        Self {
            felt_dock: parts.felt_dock.map(|felt| FeltDock {
                times: felt.times,
                pose: felt.pose.into(),
            }),
            told_dock: parts.told_dock.map(Pose::from),
            layers: Layers {
                origin_x: parts.origin.x,
                origin_y: parts.origin.y,
                width: parts.width,
                height: parts.height,
                next_room: parts.next_room,
                cells: parts.cells.iter().copied().map(Run::from).collect(),
                rooms: parts.rooms.iter().copied().map(Run::from).collect(),
            },
            no_go: Numbered::of(parts.no_go),
            names: parts
                .names
                .iter()
                .map(|(room, name)| (*room, name.as_str().to_owned()))
                .collect(),
            room_changes: RoomChanges {
                made: Numbered::of(parts.room_changes),
                taken_back: parts
                    .splits_taken_back
                    .into_iter()
                    .map(RoomChange::from)
                    .collect(),
            },
            room_settings: parts
                .room_settings
                .iter()
                .map(|(room, settings)| (*room, (*settings).into()))
                .collect(),
            places: Numbered::of(parts.places),
        }
    }

    pub(super) fn into_map(self) -> Result<StoredMap, StoredMapError> {
        let layers = self.layers;
        let taken_back = self.room_changes.taken_back.into_iter().map(RoomSplit::try_from);
        StoredMap::from_parts(StoredMapParts {
            felt_dock: self.felt_dock.map(|felt| Felt {
                times: felt.times,
                pose: felt.pose.into(),
            }),
            told_dock: self.told_dock.map(Pose2::from),
            origin: Cell {
                x: layers.origin_x,
                y: layers.origin_y,
            },
            width: layers.width,
            height: layers.height,
            cells: layers.cells.into_iter().map(mapping::Run::from).collect(),
            rooms: layers.rooms.into_iter().map(mapping::Run::from).collect(),
            next_room: layers.next_room,
            no_go: self.no_go.parts()?,
            names: by_room(self.names, |name| room_name(&name))?,
            splits_taken_back: taken_back.collect::<Result<_, _>>()?,
            room_changes: self.room_changes.made.parts()?,
            room_settings: by_room(self.room_settings, brain::RoomSettings::try_from)?,
            places: self.places.parts()?,
        })
    }
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

    fn of<P: Into<T>>(parts: mapping::Numbered<P>) -> Self {
        let items = parts.items.into_iter();
        Self {
            next: parts.next,
            items: items.map(|(number, item)| (number, item.into())).collect(),
        }
    }

    fn parts<P: TryFrom<T, Error = StoredMapError>>(self) -> Result<mapping::Numbered<P>, StoredMapError> {
        let items = self.items.into_iter();
        let items = items.map(|(number, item)| Ok((number, item.try_into()?)));
        Ok(mapping::Numbered {
            next: self.next,
            items: items.collect::<Result<_, _>>()?,
        })
    }
}

fn by_room<T, P>(
    rooms: Vec<(u16, T)>,
    part: impl Fn(T) -> Result<P, StoredMapError>,
) -> Result<BTreeMap<u16, P>, StoredMapError> {
    let parts = rooms.into_iter().map(|(room, kept)| Ok((room, part(kept)?)));
    parts.collect()
}

/// Whole millionths of a value that is far from the largest number.
fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

fn of_millionths(value: i64) -> f64 {
    value as f64 * 1e-6
}

impl From<Pose2> for Pose {
    fn from(pose: Pose2) -> Self {
        Self {
            x_um: millionths(pose.x_m),
            y_um: millionths(pose.y_m),
            heading_urad: millionths(pose.heading_rad),
        }
    }
}

impl From<Pose> for Pose2 {
    fn from(pose: Pose) -> Self {
        Self {
            x_m: of_millionths(pose.x_um),
            y_m: of_millionths(pose.y_um),
            heading_rad: of_millionths(pose.heading_urad),
        }
    }
}

impl From<Point2> for Point {
    fn from(point: Point2) -> Self {
        Self {
            x_um: millionths(point.x_m),
            y_um: millionths(point.y_m),
        }
    }
}

impl From<Point> for Point2 {
    fn from(point: Point) -> Self {
        Self {
            x_m: of_millionths(point.x_um),
            y_m: of_millionths(point.y_um),
        }
    }
}

impl From<mapping::Run> for Run {
    fn from(run: mapping::Run) -> Self {
        Self {
            value: run.value,
            length: run.length,
        }
    }
}

impl From<Run> for mapping::Run {
    fn from(run: Run) -> Self {
        Self {
            value: run.value,
            length: run.length,
        }
    }
}

fn corners(zone: &Zone) -> Vec<Point> {
    zone.corners().iter().copied().map(Point::from).collect()
}

/// The zone of these corners, if any zone has them.
fn zone(corners: Vec<Point>) -> Option<Zone> {
    Zone::new(corners.into_iter().map(Point2::from).collect()).ok()
}

fn room_name(text: &str) -> Result<RoomName, StoredMapError> {
    RoomName::new(text).map_err(|_| StoredMapError::Name)
}

impl From<brain::NoGo> for NoGo {
    fn from(no_go: brain::NoGo) -> Self {
        let shape = match no_go.shape() {
            brain::NoGoShape::Zone => NoGoShape::Zone(corners(no_go.area())),
            brain::NoGoShape::Wall { from, to } => NoGoShape::Wall {
                from: from.into(),
                to: to.into(),
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
            NoGoShape::Wall { from, to } => Self::wall(from.into(), to.into()),
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
                brain::PlaceShape::Spot(middle) => PlaceShape::Spot((*middle).into()),
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
            PlaceShape::Spot(middle) => brain::PlaceShape::Spot(middle.into()),
        };
        Self::new(name, &shape).map_err(|_| StoredMapError::Place)
    }
}

impl From<RoomSplit> for RoomChange {
    fn from(split: RoomSplit) -> Self {
        let change = Change {
            rooms: [split.room, split.part],
            places: split.line.ends().map(Point::from),
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
                places: join.at.map(Point::from),
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
                let at = change.places.map(Point2::from);
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
        let [from, to] = self.places.map(Point2::from);
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
