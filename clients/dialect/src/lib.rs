//! States, maps and commands in the form that Valetudo's clients speak: what its MQTT topics and its REST interface have in common.
//! Formats are facts of an interface; no code is taken, and the robot never claims to be one of Valetudo's. No I/O, no clock.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod body;
mod map;
mod orders;
mod restrictions;
mod state;

pub use body::BodyError;
pub use map::{Frame, empty_map, map, segments};
pub use orders::{
    Operation, clean_segments, clean_zones, go_to, join_segments, preset, preset_named, rename_segment,
    split_segment, stick, with_speed,
};
pub use restrictions::{restriction_changes, restrictions};
pub use state::{Fault, Progress, StatusWords, attributes, battery, progress, status};
