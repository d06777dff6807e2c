//! What the robot remembers of its surroundings.
//!
//! Two parts. *The job*: the swept layer, the way and where something was met; a new job starts it anew. *The home*: what
//! stands where and where carpets lie, gathered over all jobs in [`layers`], from which everything else is derived: knowledge and distances
//! (brought up to date every other second), what the body can reach, walls, rooms and doors (on demand).
//!
//! Terms. *Cell*: a square of 2.5 cm with integer coordinates. *Tile*: 64 x 64 cells, allocated when first painted.
//! *Mark*: a place where a contact or a cliff was met. *Cursor*: how much of the map somebody has already seen; the map
//! of a job only grows, so what is new since a cursor is three slices. *Generation*: number of the map; a new job starts a
//! new one, and so does a map that was drawn again with better poses.

mod annotations;
mod beam_memory;
mod carpet;
mod cell;
mod derived;
mod distance;
mod dock;
mod dock_beams;
mod doors;
mod draw;
mod flood_fill;
mod home;
mod keyframe;
mod layers;
mod map;
mod raster;
mod reach;
mod room_changes;
mod room_cut;
mod rooms;
mod sighting;
mod stored;
mod swept;
mod tile_grid;
mod traces;
mod wall_direction;
mod walls;
mod zone_cells;

pub use annotations::Annotations;
pub(crate) use beam_memory::{BeamMemory, BeamPlace};
pub(crate) use carpet::CarpetSense;
pub use carpet::FloorKind;
pub use cell::{CELL_M, Cell};
pub use distance::{DistanceField, FAR_M};
pub use dock::{DockPlace, Felt};
pub(crate) use dock_beams::{Hearing, Lobe};
pub use doors::Door;
pub(crate) use flood_fill::FloodFill;
pub use keyframe::Keyframe;
pub use layers::CellKnowledge;
pub(crate) use map::Brushes;
pub use map::{Map, MapCursor, MapPart, ReadyHome, Sureness, TakingUp};
pub use raster::Raster;
pub use reach::reachable;
pub use room_changes::{RoomChange, RoomChanges, RoomJoin, RoomSplit};
pub use room_cut::PartSide;
pub use rooms::{Room, Rooms};
pub use stored::{Numbered, Run, StoredMap, StoredMapError, StoredMapParts};
pub use swept::{Sweeping, SweptRun};
pub(crate) use traces::SeenAt;
pub use traces::{Mark, MarkKind, PathPoint};
pub(crate) use wall_direction::wall_direction_rad;
pub use walls::WallSegment;
