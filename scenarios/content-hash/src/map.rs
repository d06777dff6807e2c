//! What a map holds.

use std::collections::BTreeSet;

use brain::{Cell, CellKnowledge, KnownBeacon, Map, StoredMap, SurfaceKind};

use crate::ContentHash;

const fn number_of(kind: CellKnowledge) -> u8 {
    match kind {
        CellKnowledge::Unknown => 0,
        CellKnowledge::Free => 1,
        CellKnowledge::Occupied => 2,
        CellKnowledge::Cliff => 3,
        CellKnowledge::NoGo => 4,
    }
}

const fn floor_number(kind: Option<SurfaceKind>) -> u8 {
    match kind {
        None => 0,
        Some(SurfaceKind::Hard) => 1,
        Some(SurfaceKind::Carpet) => 2,
    }
}

impl ContentHash {
    /// Of a map: what is known of each cell and how surely, kinds of floor, rooms, dock, what people have said, and what the last
    /// job has swept.
    #[must_use]
    pub fn of_map(map: &Map) -> Self {
        let mut hash = Self::default();
        let (knowledge, labels) = (map.knowledge(), map.rooms().labels());
        for (index, kind) in knowledge.values().iter().enumerate() {
            let cell = knowledge.cell(index);
            let sigma_m = map.sigma_m(cell);
            let floor = floor_number(map.surface_kind(cell));
            let room = labels.get(cell).copied().unwrap_or(0);
            let kind = number_of(*kind);
            // The window around what is known may be of any size.
            if kind != 0 || floor != 0 || room != 0 || sigma_m.is_some() {
                hash.add_cell(cell);
                hash.add_bytes(&[kind, floor]);
                hash.add(room);
                hash.add_bits(sigma_m.unwrap_or(-1.0));
            }
        }
        hash.add_rooms(map);
        hash.add_dock(map.dock_location());
        hash.add_annotations(map.annotations());
        hash.add_beacons(map.beacons());
        hash.add_swept(&map.swept_runs());
        for cell in swept_cells(&map.swept_runs()) {
            let sweeping = map.cell_passes(Cell { x: cell.1, y: cell.0 });
            hash.add(sweeping.map_or(0, |sweeping| sweeping.passes));
            hash.add(sweeping.map_or(0, |sweeping| sweeping.last_s));
        }
        hash.add_bits(map.path_length_m());
        hash
    }

    /// Of a stored map, as far as it tells without being taken up.
    #[must_use]
    pub fn of_stored_map(map: &StoredMap) -> Self {
        let mut hash = Self::default();
        let knowledge = map.knowledge();
        for (index, kind) in knowledge.values().iter().enumerate() {
            if *kind != CellKnowledge::Unknown {
                hash.add_cell(knowledge.cell(index));
                hash.add(number_of(*kind));
            }
        }
        hash.add_dock(map.dock_location());
        hash.add_annotations(map.annotations());
        hash.add_beacons(map.beacons());
        hash.add(map.room_count() as u64);
        hash
    }

    fn add_beacons(&mut self, beacons: &[KnownBeacon]) {
        for beacon in beacons {
            self.add(beacon.number);
            for length_m in [
                beacon.place.x_m,
                beacon.place.y_m,
                beacon.bias_m,
                beacon.sigma_m,
                beacon.place_sigma_m,
            ] {
                self.add_bits(length_m);
            }
        }
    }

    pub(crate) fn add_cell(&mut self, cell: Cell) {
        self.add(cell.x);
        self.add(cell.y);
    }

    fn add_dock(&mut self, dock: brain::mapping::DockLocation) {
        self.add_flag(dock.is_reported());
        self.add_flag(dock.is_converged());
        if let Some(pose) = dock.pose() {
            self.add_pose(pose);
        }
    }

    fn add_rooms(&mut self, map: &Map) {
        for room in map.rooms().rooms() {
            self.add(room.id);
            self.add_bits(room.area_m2);
            self.add_point(room.middle);
        }
        self.add(map.rooms().doors().len() as u64);
    }

    pub(crate) fn add_swept(&mut self, runs: &[brain::SweptRun]) {
        for (y, x) in swept_cells(runs) {
            self.add_cell(Cell { x, y });
        }
    }
}

/// Row and column of each, in rows.
fn swept_cells(runs: &[brain::SweptRun]) -> BTreeSet<(i32, i32)> {
    let cells = |run: &brain::SweptRun| {
        let Cell { x, y } = run.start;
        (x..).take(run.length as usize).map(move |x| (y, x))
    };
    runs.iter().flat_map(cells).collect()
}
