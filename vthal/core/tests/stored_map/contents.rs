//! A map that holds something of each kind, as the files of earlier versions keep it.

use std::collections::BTreeMap;

use brain::mapping::{
    CellRun, MeasuredDock, Numbered, PartSide, RoomChange, RoomJoin, RoomSplit, StoredMapParts,
};
use brain::{
    Cell, CutLine, KeptPlace, KnownBeacon, NoGo, Pattern, PlaceShape, Point2, Pose2, RoomName, RoomPower,
    RoomSettings, StoredMap, Zone,
};

fn at(x_m: f64, y_m: f64) -> Point2 {
    Point2 { x_m, y_m }
}

fn name(text: &str) -> RoomName {
    RoomName::new(text).expect("a name")
}

pub(crate) fn map() -> StoredMap {
    StoredMap::from_parts(parts()).expect("a good map")
}

/// What the file of version 12 holds.
pub(crate) fn parts() -> StoredMapParts {
    StoredMapParts {
        measured_dock: Some(MeasuredDock {
            pose: Pose2 {
                x_m: -1.25,
                y_m: 2.5,
                heading_rad: -3.0,
            },
            times: 4,
        }),
        reported_dock: Some(Pose2 {
            x_m: 0.5,
            y_m: -0.25,
            heading_rad: 1.5,
        }),
        origin: Cell { x: -7, y: 300 },
        width: 9,
        height: 5,
        cells: cells(),
        rooms: [(3, 20), (0, 5), (2, 20)].map(run).to_vec(),
        past: [(0, 12), (0b1001, 3), (0, 20), (0b10_0011, 10)].map(run).to_vec(),
        next_room: 7,
        no_go: no_go(),
        names: BTreeMap::from([(3, name("Köök"))]),
        room_changes: room_changes(),
        undone_splits: vec![split(5)],
        room_settings: room_settings(Pattern::Contour),
        places: places(),
        beacons: beacons(),
    }
}

fn beacons() -> Vec<KnownBeacon> {
    let beacon = |number, x_m, bias_m| KnownBeacon {
        number,
        place: at(x_m, -2.125),
        bias_m,
        sigma_m: 0.0625,
        place_sigma_m: 0.3,
    };
    vec![beacon(52_301, 4.75, -0.04), beacon(7, -0.5, 0.125)]
}

/// What the file of a version holds: the less, the older it is.
pub(crate) fn parts_of_version(version: u8) -> StoredMapParts {
    let mut parts = parts();
    if version < 12 {
        parts.beacons = Vec::new();
    }
    if version < 11 {
        parts.past = Vec::new();
    }
    if version < 9 {
        // The kind of floor.
        parts.cells.iter_mut().for_each(|run| run.value &= !0x300);
    }
    if version < 8 {
        parts.places = none();
    }
    if version < 7 {
        for (_, no_go) in &mut parts.no_go.items {
            *no_go = no_go.clone().with_name(None);
        }
    }
    if version < 6 {
        parts.reported_dock = None;
        // Such a dock counts as felt often enough.
        parts.measured_dock = parts.measured_dock.map(|felt| MeasuredDock { times: 6, ..felt });
    }
    match version {
        ..4 => parts.room_settings = BTreeMap::new(),
        4 => parts.room_settings = room_settings(Pattern::Lines),
        _ => {}
    }
    if version < 3 {
        parts.room_changes = none();
        parts.undone_splits = Vec::new();
    }
    if version < 2 {
        parts.no_go = none();
        parts.names = BTreeMap::new();
    }
    parts
}

fn none<T>() -> Numbered<T> {
    Numbered {
        next: 1,
        items: Vec::new(),
    }
}

fn run((value, length): (u16, u32)) -> CellRun {
    CellRun { value, length }
}

fn cells() -> Vec<CellRun> {
    let values = [
        0, 4361, 4800, 6144, 4359, 4617, 4288, 6400, 4615, 4105, 4544, 6656, 4103, 4361, 4800,
    ];
    values.map(|value| run((value, 3))).to_vec()
}

fn triangle() -> Zone {
    Zone::new(vec![at(0.1, 0.2), at(1.0 / 3.0, 0.2), at(0.1, -7.0)]).expect("a zone")
}

fn no_go() -> Numbered<NoGo> {
    let zone = NoGo::zone(&triangle()).expect("a zone");
    let wall = NoGo::wall(at(0.0, 0.0), at(2.0 / 3.0, 1e-5)).expect("a wall");
    Numbered {
        next: 3,
        items: vec![(1, zone.with_name(Some(name("Cats")))), (2, wall)],
    }
}

fn split(part: u16) -> RoomSplit {
    RoomSplit {
        room: 3,
        part,
        side: PartSide::Right,
        line: CutLine::new(at(-1.0, 1.0 / 3.0), at(2.0, 0.5)).expect("a line"),
    }
}

fn room_changes() -> Numbered<RoomChange> {
    let join = RoomJoin {
        kept: 3,
        lost: 2,
        at: [at(0.5, 0.25), at(-1.5, 2.0)],
    };
    Numbered {
        next: 4,
        items: vec![(2, RoomChange::Split(split(6))), (3, RoomChange::Join(join))],
    }
}

fn room_settings(pattern: Pattern) -> BTreeMap<u16, RoomSettings> {
    let power = RoomPower {
        suction: 25,
        ..RoomPower::FULL
    };
    let settings = RoomSettings::new(2, power).expect("settings");
    BTreeMap::from([(3, settings.with_pattern(pattern))])
}

fn places() -> Numbered<KeptPlace> {
    let table = KeptPlace::new(name("Table"), &PlaceShape::Zone(triangle())).expect("a place");
    let bowl = KeptPlace::new(name("Bowl"), &PlaceShape::Spot(at(1.0 / 7.0, -0.2))).expect("a place");
    Numbered {
        next: 9,
        items: vec![(2, table), (4, bowl)],
    }
}
