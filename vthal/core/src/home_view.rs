//! The map of the home in the types of the interface to clients, of bounded size.

use brain::mapping::{Annotations, Door, MapConfidence, Room, RoomChange, WallSegment};
use brain::{CELL_M, Cell, CellKnowledge, KeptPlace, Map, NoGo, Raster, SurfaceKind};
use rvac_api::{
    CarpetView, DoorView, HomeView, NoGoView, PlaceView, Rle, RoomChangeView, RoomView, SurenessView,
    WallView,
};

use crate::{api_forms, to_api};

/// Numbers that the runs of cells may have together: a message of a megabyte at most. A home of 150 square metres has
/// some 20,000.
const NUMBERS_MAX: usize = 150_000;
/// Kinds of floor as clients receive them.
const HARD: u8 = 1;
const CARPET: u8 = 2;
/// Coarsest cells, in cells of the map.
const COARSE_MAX: usize = 16;
/// Rooms, doors and walls that are sent at most. Walls come longest first.
const ITEMS_MAX: usize = 1_000;

/// Whether the robot can detect the floor's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SurfaceSensing {
    /// It measures what its motors draw.
    Measured,
    /// It does not, and nothing is sent about carpets.
    NotMeasured,
}

impl SurfaceSensing {
    /// For a map without its robot: a robot whose map contains surfaces can detect them.
    pub(crate) fn in_map(map: &Map) -> Self {
        match map.surface_kinds().next() {
            Some(_) => Self::Measured,
            None => Self::NotMeasured,
        }
    }
}

/// What is known of the home.
pub(crate) fn home_view(map: &Map, felt: SurfaceSensing) -> HomeView {
    let rooms = map.rooms();
    let floors = floors(map, felt);
    let view = cells(map.knowledge(), rooms.labels(), floors.as_ref());
    HomeView {
        revision: map.revision(),
        rooms: rooms
            .rooms()
            .iter()
            .take(ITEMS_MAX)
            .map(|known| room(known, map.annotations()))
            .collect(),
        doors: rooms.doors().iter().take(ITEMS_MAX).map(door).collect(),
        walls: map.walls().iter().take(ITEMS_MAX).map(wall).collect(),
        dock: map.dock().map(|dock| to_api::pose(dock, 0)),
        dock_reported: map.dock_location().is_reported(),
        no_go: map.annotations().no_go().map(no_go).collect(),
        places: map.annotations().places().map(place).collect(),
        room_changes: map.annotations().room_changes().made().map(room_change).collect(),
        sureness: sureness(map),
        ..view
    }
}

/// How sure the home is, then each room.
fn sureness(map: &Map) -> Vec<SurenessView> {
    let known = |room, sureness: MapConfidence| SurenessView {
        room,
        sigma_m: sureness.sigma_m,
        driven: sureness.driven,
        touched: sureness.touched,
    };
    let home = map.confidence().map(|sureness| known(None, sureness));
    let rooms = map.room_confidence().into_iter().take(ITEMS_MAX);
    home.into_iter()
        .chain(rooms.map(|(room, sureness)| known(Some(room), sureness)))
        .collect()
}

/// The surfaces in the known window: 0 not measured, 1 hard, 2 carpet.
fn floors(map: &Map, felt: SurfaceSensing) -> Option<Raster<u8>> {
    if felt == SurfaceSensing::NotMeasured {
        return None;
    }
    let knowledge = map.knowledge();
    let mut floors = Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), 0);
    for (cell, kind) in map.surface_kinds() {
        if let Some(place) = floors.get_mut(cell) {
            *place = match kind {
                SurfaceKind::Hard => HARD,
                SurfaceKind::Carpet => CARPET,
            };
        }
    }
    Some(floors)
}

/// The cells alone, as fine as they may be sent.
fn cells(knowledge: &Raster<CellKnowledge>, labels: &Raster<u16>, floors: Option<&Raster<u8>>) -> HomeView {
    let mut coarse = 1;
    loop {
        let view = HomeView {
            carpet: floors.map(|floors| carpet(coarse, floors)),
            ..cells_of(coarse, knowledge, labels)
        };
        let floor_numbers = view.carpet.as_ref().map_or(0, |carpet| carpet.cells.len());
        if view.cells.len() + view.room_cells.len() + floor_numbers <= NUMBERS_MAX {
            return view;
        }
        if coarse >= COARSE_MAX {
            // Such a pattern is no home; cells that are not sent are unknown.
            return HomeView {
                cells: Rle::new(),
                room_cells: Rle::new(),
                carpet: view.carpet.map(|carpet| CarpetView {
                    cells: Rle::new(),
                    ..carpet
                }),
                ..view
            };
        }
        coarse *= 2;
    }
}

/// The surfaces detected, in the window of [`cells_of`].
fn carpet(coarse: usize, floors: &Raster<u8>) -> CarpetView {
    let window = Window::of(coarse, floors);
    let mut kinds = vec![0_u32; window.width * window.height];
    let (mut hard, mut carpet) = (0_u32, 0_u32);
    for (index, kind) in floors.values().iter().enumerate() {
        hard += u32::from(*kind == HARD);
        carpet += u32::from(*kind == CARPET);
        if let Some(merged) = kinds.get_mut(window.place(floors.cell(index))) {
            *merged = (*merged).max(u32::from(*kind));
        }
    }
    let area_m2 = |cells: u32| f64::from(cells) * CELL_M * CELL_M;
    CarpetView {
        area_m2: area_m2(carpet),
        hard_m2: area_m2(hard),
        cells: runs(&kinds),
    }
}

/// Cells that are `coarse` cells of the map wide and high. Each is what weighs most of what it holds.
fn cells_of(coarse: usize, knowledge: &Raster<CellKnowledge>, labels: &Raster<u16>) -> HomeView {
    let window = Window::of(coarse, knowledge);
    let (width, height) = (window.width, window.height);
    let mut kinds = vec![0_u32; width * height];
    let mut rooms = vec![0_u32; width * height];
    for (index, kind) in knowledge.values().iter().enumerate() {
        let cell = knowledge.cell(index);
        let place = window.place(cell);
        if let Some(merged) = kinds.get_mut(place)
            && weight(number(*kind)) > weight(*merged)
        {
            *merged = number(*kind);
        }
        let label = labels.get(cell).copied().map_or(0, u32::from);
        if let Some(room) = rooms.get_mut(place) {
            *room = (*room).max(label);
        }
    }
    HomeView {
        cell_m: CELL_M * coarse as f64,
        x: window.x,
        y: window.y,
        width: u32::try_from(width).unwrap_or(u32::MAX),
        height: u32::try_from(height).unwrap_or(u32::MAX),
        cells: runs(&kinds),
        room_cells: runs(&rooms),
        ..HomeView::default()
    }
}

/// A window of cells that are some cells of the map wide and high.
struct Window {
    step: i32,
    x: i32,
    y: i32,
    width: usize,
    height: usize,
}

impl Window {
    fn of<T: Clone>(coarse: usize, raster: &Raster<T>) -> Self {
        let origin = raster.origin();
        let step = i32::try_from(coarse).unwrap_or(1);
        let ahead = origin.x.rem_euclid(step) as usize;
        let below = origin.y.rem_euclid(step) as usize;
        Self {
            step,
            x: origin.x.div_euclid(step),
            y: origin.y.div_euclid(step),
            width: (raster.width() + ahead).div_ceil(coarse),
            height: (raster.height() + below).div_ceil(coarse),
        }
    }

    /// Where a cell of the map lies in it.
    fn place(&self, cell: Cell) -> usize {
        let column = (cell.x.div_euclid(self.step) - self.x) as usize;
        let row = (cell.y.div_euclid(self.step) - self.y) as usize;
        row * self.width + column
    }
}

fn number(kind: CellKnowledge) -> u32 {
    match kind {
        CellKnowledge::Unknown => 0,
        CellKnowledge::Free => 1,
        CellKnowledge::Occupied => 2,
        CellKnowledge::Cliff => 3,
        CellKnowledge::NoGo => 4,
    }
}

/// What wins when cells are merged: what a robot must not overlook.
fn weight(number: u32) -> u32 {
    match number {
        3 => 4,
        2 => 3,
        4 => 2,
        1 => 1,
        _ => 0,
    }
}

/// Equal values side by side as pairs of value and number.
fn runs(values: &[u32]) -> Rle {
    values
        .chunk_by(|one, other| one == other)
        .flat_map(|run| {
            let value = run.first().copied().unwrap_or_default();
            [value, u32::try_from(run.len()).unwrap_or(u32::MAX)]
        })
        .collect()
}

fn no_go((number, no_go): (u16, &NoGo)) -> NoGoView {
    NoGoView {
        number,
        shape: api_forms::no_go(no_go),
        name: no_go.name().map(|name| name.as_str().to_owned()),
    }
}

fn place((number, place): (u16, &KeptPlace)) -> PlaceView {
    PlaceView {
        number,
        name: place.name().as_str().to_owned(),
        shape: api_forms::place(place.shape()),
    }
}

fn room_change((number, change): (u16, &RoomChange)) -> RoomChangeView {
    match change {
        RoomChange::Split(split) => RoomChangeView {
            number,
            rooms: [split.room, split.part],
            line: Some(split.line.ends().map(|end| [end.x_m, end.y_m])),
        },
        RoomChange::Join(join) => RoomChangeView {
            number,
            rooms: [join.kept, join.lost],
            line: None,
        },
    }
}

fn room(room: &Room, annotations: &Annotations) -> RoomView {
    RoomView {
        id: room.id,
        area_m2: room.area_m2,
        x: room.middle.x_m,
        y: room.middle.y_m,
        name: annotations.name(room.id).map(|name| name.as_str().to_owned()),
        settings: annotations.settings(room.id).map(crate::desk::room_power::to_api),
    }
}

fn door(door: &Door) -> DoorView {
    DoorView {
        rooms: door.rooms,
        x: door.at.x_m,
        y: door.at.y_m,
        width_m: door.width_m,
    }
}

fn wall(wall: &WallSegment) -> WallView {
    WallView {
        from: [wall.from.x_m, wall.from.y_m],
        to: [wall.to.x_m, wall.to.y_m],
        sigma_m: wall.sigma_m,
    }
}

#[cfg(test)]
mod tests {
    use brain::{Cell, CellKnowledge, Raster};

    use super::{NUMBERS_MAX, cells};

    fn raster(width: usize, height: usize, kind: impl Fn(usize) -> CellKnowledge) -> Raster<CellKnowledge> {
        let mut raster = Raster::filled(Cell { x: -3, y: 5 }, width, height, CellKnowledge::Unknown);
        for (index, value) in raster.values_mut().iter_mut().enumerate() {
            *value = kind(index);
        }
        raster
    }

    fn no_rooms() -> Raster<u16> {
        Raster::filled(Cell { x: 0, y: 0 }, 0, 0, 0)
    }

    #[test]
    fn a_home_is_reported_cell_by_cell() {
        let known = raster(4, 2, |index| match index {
            0 | 1 => CellKnowledge::Free,
            2 => CellKnowledge::Occupied,
            7 => CellKnowledge::Cliff,
            _ => CellKnowledge::Unknown,
        });
        let view = cells(&known, &no_rooms(), None);
        assert_eq!((view.x, view.y, view.width, view.height), (-3, 5, 4, 2));
        assert_eq!(view.cells, [1, 2, 2, 1, 0, 4, 3, 1]);
        assert_eq!(view.room_cells, [0, 8]);
    }

    #[test]
    fn a_chessboard_as_large_as_a_map_can_be_is_reported_coarsely_and_no_obstacle_is_lost() {
        let known = raster(1_600, 1_600, |index| {
            if (index + index / 1_600).is_multiple_of(2) {
                CellKnowledge::Occupied
            } else {
                CellKnowledge::Free
            }
        });
        let view = cells(&known, &no_rooms(), None);
        assert!(view.cells.len() + view.room_cells.len() <= NUMBERS_MAX);
        assert!(view.cell_m > 0.025);
        let total: u32 = view.cells.chunks_exact(2).map(|run| run[1]).sum();
        assert_eq!(total, view.width * view.height);
        // A corner that holds a single cell may be free.
        let obstacles: u32 = view
            .cells
            .chunks_exact(2)
            .filter(|run| run[0] == 2)
            .map(|run| run[1])
            .sum();
        assert!(obstacles >= total - 4, "{obstacles} of {total}");
    }
}
