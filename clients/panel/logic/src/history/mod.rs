//! Runs that are over: as rows, as a picture, as a replay and as plots.

mod picture;
mod plots;
mod replay;
mod rows;

pub use picture::{RunDrawing, run_drawing};
pub use plots::{Plot, plots};
pub use replay::Replay;
pub use rows::{RunRow, StopRow, room_here_text, run_figures, run_rows, stop_rows};
