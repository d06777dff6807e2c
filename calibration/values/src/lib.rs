//! The values of a robot that nobody could read off its board: which there are, what an owner measured of them, and the record in which
//! the robot's firmware finds them.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod catalog;
mod error;
#[cfg(test)]
#[path = "../../../clients/panel-server/tests/folder/mod.rs"]
mod folder;
mod measurements;
mod record;

pub use catalog::{Catalog, Item, RobotTables};
pub use error::ValuesError;
pub use measurements::Measurements;
pub use record::{MAGIC, RECORD_ADDRESS, record};
