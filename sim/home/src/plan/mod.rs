//! The floor plan as a grid.

mod grid;

pub use grid::{Cell, Grid};
