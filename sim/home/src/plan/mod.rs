//! The floor plan as a grid, and what follows from it.

mod distance;
mod dock;
mod door;
mod grid;
mod reach;
mod solid;
mod surface;
mod walk;

pub(crate) use distance::DistanceField;
pub(crate) use dock::{DockSearch, docked_pose};
pub(crate) use door::Door;
pub use grid::{Cell, Grid};
pub(crate) use reach::{Regions, blocked_field, cliff_field, solid_field};
pub(crate) use solid::{Foot, Solid};
pub(crate) use surface::{Surface, SurfaceMap};
pub(crate) use walk::{WalkerKind, WalkerPlan, Ways};
