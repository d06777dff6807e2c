//! The map of a large home that an earlier daemon has kept.

use std::io;

use brain::{Cell, CellKnowledge, Pose2, Raster, StoredMap};
use vthal_bench::Scratch;

/// Side of the home in cells of 2.5 cm: 400 square metres.
const SIDE_CELLS: usize = 800;
/// Cells between two walls.
const ROOM_CELLS: usize = 160;
/// Cells of a wall that are left open.
const DOOR_CELLS: usize = 40;

/// Keeps the map of a home of 400 square metres, as its first version.
///
/// # Errors
/// The folder cannot be written.
pub fn keep_large_home(scratch: &Scratch) -> io::Result<()> {
    let maps = scratch.join("state/maps");
    std::fs::create_dir_all(&maps)?;
    std::fs::write(maps.join("000001.map"), home())
}

/// Rooms in rows and columns, each with a door to its neighbours, and the dock in one of them.
fn home() -> Vec<u8> {
    let corner = Cell { x: -40, y: -40 };
    let mut floor = Raster::filled(corner, SIDE_CELLS, SIDE_CELLS, CellKnowledge::Free);
    for (index, cell) in floor.values_mut().iter_mut().enumerate() {
        let [along, across] = [index % SIDE_CELLS, index / SIDE_CELLS].map(|at| at % ROOM_CELLS);
        let is_wall = (along == 0 && across >= DOOR_CELLS) || (across == 0 && along >= DOOR_CELLS);
        if is_wall {
            *cell = CellKnowledge::Occupied;
        }
    }
    vthal_core::stored_map::encode(&StoredMap::from_raster(&floor, Some(Pose2::IDENTITY)))
}
