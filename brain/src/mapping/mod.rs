//! The map: what the robot remembers of its surroundings.
//!
//! It has two parts. The *job* holds the coverage grid, the path and the hazards; a new job starts with none of them. The *home*
//! holds the occupancy grid with obstacles and carpets, and accumulates over all jobs. Everything else derives from the occupancy
//! grid: cell knowledge and distances (updated every two seconds), reachable floor, walls, rooms and doors (on demand).
//!
//! Terms. *Cell*: a square of 2.5 cm with integer coordinates. *Tile*: 64 x 64 cells, allocated when first written. *Hazard*: a
//! position where the robot touched something or detected a cliff. *Cursor*: how much of the map a client has already received.
//! The map of a job only grows, so three slices hold everything since a cursor. *Generation*: the number of the map. It
//! increments with a new job and when the map is redrawn with corrected poses.

mod annotations;
mod beam_memory;
mod carpet;
mod cell;
mod cell_past;
mod coverage_grid;
mod derived;
mod distance;
mod dock_beam_filter;
mod dock_location;
mod doors;
mod flood_fill;
mod home;
mod home_floor;
mod inverse_sensor_model;
mod kept_home;
mod keyframe;
mod learning;
mod map;
mod next_numbers;
mod occupancy_grid;
mod path_and_hazards;
mod raster;
mod reach;
mod room_changes;
mod room_cut;
mod rooms;
mod sighting;
mod stored;
mod tile_grid;
mod wall_direction;
mod walls;
mod zone_cells;

pub use annotations::Annotations;
pub(crate) use beam_memory::{BeamMemory, BeamPlace};
pub(crate) use carpet::CarpetDetector;
pub use carpet::SurfaceKind;
pub use cell::{CELL_M, Cell};
pub use coverage_grid::{CellPasses, SweptRun};
pub use distance::{DistanceField, FAR_M};
pub(crate) use dock_beam_filter::{DockBeamFilter, Lobe};
pub use dock_location::{DockLocation, MeasuredDock};
pub use doors::Door;
pub(crate) use flood_fill::FloodFill;
pub(crate) use home::PlaceTrust;
pub(crate) use home_floor::HomeFloor;
pub use keyframe::Keyframe;
pub(crate) use map::Brushes;
pub use map::{LoadedHome, Map, MapConfidence, MapCursor, MapLoader, MapPart, MapWriter};
pub use next_numbers::NextNumbers;
pub use occupancy_grid::CellKnowledge;
pub(crate) use path_and_hazards::StampedOdometry;
pub use path_and_hazards::{Hazard, HazardKind, PathPoint};
pub use raster::Raster;
pub use reach::{covered, reachable};
pub(crate) use reach::{covered_in_steps, reachable_in_steps};
pub use room_changes::{RoomChange, RoomChanges, RoomJoin, RoomSplit};
pub use room_cut::PartSide;
pub use rooms::{Room, Rooms};
pub use stored::{CellRun, Numbered, StoredMap, StoredMapError, StoredMapParts};
pub(crate) use wall_direction::wall_direction_rad;
pub use walls::WallSegment;
