//! What the bytes of a stored map hold: its parts, with lengths in whole micrometres and angles in whole microradians.

use std::collections::BTreeMap;

use brain::mapping::{self, MeasuredDock, RoomSplit, StoredMapParts};
use brain::{Cell, KnownBeacon, Point2, Pose2, StoredMap, StoredMapError};
use serde::{Deserialize, Serialize};

use super::annotations::{
    NoGo, Numbered, Place, RoomChange, RoomChanges, RoomSettings, millionths, of_millionths, room_name,
};

#[derive(Serialize, Deserialize)]
pub(super) struct Body {
    pub(super) measured_dock: Option<StoredDock>,
    pub(super) reported_dock: Option<Pose>,
    pub(super) layers: Layers,
    pub(super) no_go: Numbered<NoGo>,
    pub(super) names: Vec<(u16, String)>,
    pub(super) room_changes: RoomChanges,
    pub(super) room_settings: Vec<(u16, RoomSettings)>,
    pub(super) places: Numbered<Place>,
}

/// What a version 11 adds to a body: what earlier runs found in each cell.
pub(super) type Past = Vec<CellRun>;

/// What a version 12 adds to it: radio beacons.
pub(super) type Beacons = Vec<StoredBeacon>;

/// A radio beacon.
#[derive(Serialize, Deserialize)]
pub(super) struct StoredBeacon {
    number: u16,
    /// x, y, bias and standard deviations of the place and of ranges around a place.
    lengths: [i64; 5],
}

#[derive(Serialize, Deserialize)]
pub(super) struct StoredDock {
    pub(super) times: u8,
    pub(super) pose: Pose,
}

/// x, y and heading.
pub(super) type Pose = [i64; 3];

/// What so many cells side by side hold.
pub(super) type CellRun = (u16, u32);

/// What each cell of the window holds and in which room it lies.
#[derive(Serialize, Deserialize)]
pub(super) struct Layers {
    origin_x: i32,
    origin_y: i32,
    width: u32,
    height: u32,
    next_room: u16,
    pub(super) cells: Vec<CellRun>,
    rooms: Vec<CellRun>,
}

impl Body {
    pub(super) fn of(map: &StoredMap) -> (Self, Past, Beacons) {
        let parts = map.parts();
        let past = runs(parts.past);
        let beacons = parts.beacons.iter().map(StoredBeacon::of).collect();
        let body = Self {
            measured_dock: parts.measured_dock.map(|dock| StoredDock {
                times: dock.times,
                pose: pose(dock.pose),
            }),
            reported_dock: parts.reported_dock.map(pose),
            layers: Layers {
                origin_x: parts.origin.x,
                origin_y: parts.origin.y,
                width: parts.width,
                height: parts.height,
                next_room: parts.next_room,
                cells: runs(parts.cells),
                rooms: runs(parts.rooms),
            },
            no_go: Numbered::of(parts.no_go),
            names: parts
                .names
                .iter()
                .map(|(room, name)| (*room, name.as_str().to_owned()))
                .collect(),
            room_changes: RoomChanges {
                made: Numbered::of(parts.room_changes),
                taken_back: parts.undone_splits.into_iter().map(RoomChange::from).collect(),
            },
            room_settings: parts
                .room_settings
                .iter()
                .map(|(room, settings)| (*room, (*settings).into()))
                .collect(),
            places: Numbered::of(parts.places),
        };
        (body, past, beacons)
    }

    pub(super) fn into_map(self, past: Past, beacons: Beacons) -> Result<StoredMap, StoredMapError> {
        let layers = self.layers;
        let taken_back = self.room_changes.taken_back.into_iter().map(RoomSplit::try_from);
        StoredMap::from_parts(StoredMapParts {
            measured_dock: self.measured_dock.map(|dock| MeasuredDock {
                times: dock.times,
                pose: to_pose(dock.pose),
            }),
            reported_dock: self.reported_dock.map(to_pose),
            origin: Cell {
                x: layers.origin_x,
                y: layers.origin_y,
            },
            width: layers.width,
            height: layers.height,
            cells: to_runs(layers.cells),
            rooms: to_runs(layers.rooms),
            past: to_runs(past),
            next_room: layers.next_room,
            no_go: self.no_go.parts()?,
            names: by_room(self.names, |name| room_name(&name))?,
            undone_splits: taken_back.collect::<Result<_, _>>()?,
            room_changes: self.room_changes.made.parts()?,
            room_settings: by_room(self.room_settings, brain::RoomSettings::try_from)?,
            places: self.places.parts()?,
            beacons: beacons.into_iter().map(StoredBeacon::into_known).collect(),
        })
    }
}

impl StoredBeacon {
    fn of(known: &KnownBeacon) -> Self {
        let lengths = [
            known.place.x_m,
            known.place.y_m,
            known.bias_m,
            known.sigma_m,
            known.place_sigma_m,
        ];
        Self {
            number: known.number,
            lengths: lengths.map(millionths),
        }
    }

    fn into_known(self) -> KnownBeacon {
        let [x_m, y_m, bias_m, sigma_m, place_sigma_m] = self.lengths.map(of_millionths);
        KnownBeacon {
            number: self.number,
            place: Point2 { x_m, y_m },
            bias_m,
            sigma_m,
            place_sigma_m,
        }
    }
}

fn by_room<T, P>(
    rooms: Vec<(u16, T)>,
    part: impl Fn(T) -> Result<P, StoredMapError>,
) -> Result<BTreeMap<u16, P>, StoredMapError> {
    let parts = rooms.into_iter().map(|(room, kept)| Ok((room, part(kept)?)));
    parts.collect()
}

fn pose(pose: Pose2) -> Pose {
    [pose.x_m, pose.y_m, pose.heading_rad].map(millionths)
}

fn to_pose(pose: Pose) -> Pose2 {
    let [x_m, y_m, heading_rad] = pose.map(of_millionths);
    Pose2 {
        x_m,
        y_m,
        heading_rad,
    }
}

fn runs(runs: Vec<mapping::CellRun>) -> Vec<CellRun> {
    runs.into_iter().map(|run| (run.value, run.length)).collect()
}

fn to_runs(runs: Vec<CellRun>) -> Vec<mapping::CellRun> {
    let runs = runs.into_iter();
    runs.map(|(value, length)| mapping::CellRun { value, length })
        .collect()
}
