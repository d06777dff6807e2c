//! The floor plan as a grid, and what follows from it.

mod distance;
mod dock;
mod door;
mod grid;
mod reach;
mod surface;

pub(crate) use distance::DistanceField;
pub(crate) use dock::{DockSearch, docked_pose};
pub(crate) use door::Door;
pub use grid::{Cell, Grid};
pub(crate) use reach::{Regions, blocked_field, cliff_field, solid_field};
pub(crate) use surface::{Surface, SurfaceMap};
