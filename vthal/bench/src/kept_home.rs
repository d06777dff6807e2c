//! The map of a home that an earlier daemon has kept.

use std::fs;
use std::io;
use std::path::PathBuf;

use brain::{Cell, CellKnowledge, Pose2, Raster, StoredMap};
use vthal_core::stored_map;

use crate::Scratch;

/// Keeps the map of an empty hall with the dock in it, as its first version; gives the folder of the maps.
///
/// # Errors
/// The folder cannot be written.
pub fn keep_home(scratch: &Scratch) -> io::Result<PathBuf> {
    let maps = scratch.join("state/maps");
    fs::create_dir_all(&maps)?;
    let floor = Raster::filled(Cell { x: -40, y: -40 }, 160, 120, CellKnowledge::Free);
    let home = StoredMap::from_raster(&floor, Some(Pose2::IDENTITY));
    fs::write(maps.join("000001.map"), stored_map::encode(&home))?;
    Ok(maps)
}
