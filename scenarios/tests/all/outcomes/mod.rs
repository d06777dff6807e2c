//! What comes of runs, as tables. A change of behaviour shows as a difference of a table: look at it, and when it is what you
//! wanted write the new one with `UPDATE_EXPECTED=1 cargo test -p scenarios outcomes`.
//!
//! Besides figures for people most rows hold hashes of all that happened, so that a change which shall not change behaviour can
//! be told from one that does.

mod bounce;
mod docking;
mod kept_map;
mod life;
mod linux_board;
mod orders;
mod strategies;
mod systematic;
