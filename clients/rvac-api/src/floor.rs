//! The floors of a home. Each has a map of its own.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// Largest archive of floors that is written or taken. A floor of 150 square metres takes some ten kilobytes.
pub const ARCHIVE_BYTES_MAX: u64 = 8 << 20;
/// Piece of an archive that [`crate::RequestBody::ExportFloors`] gives at once, in bytes before they are spelled in base 64.
pub const ARCHIVE_PIECE_BYTES: u64 = 48 << 10;
/// The same of [`crate::RequestBody::ImportFloors`]: requests are shorter than answers may be.
pub const ARCHIVE_UPLOAD_BYTES: u64 = 8 << 10;

/// The floors of the home, and on which of them the robot is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FloorsView {
    /// By their numbers; removed ones, which can come back, are among them.
    pub floors: Vec<FloorView>,
    /// Number of the floor on which the robot is, if that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub here: Option<u16>,
    /// The robot searches for the floor on which it is. While it drives it compares its sensors with the maps.
    pub sought: bool,
    /// What a person should answer with `choose-floor` or `new-floor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<FloorQuestion>,
}

/// A floor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FloorView {
    /// Its number, from 1.
    pub number: u16,
    /// What people call it, if anybody has named it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Free floor in its map, square metres.
    pub area_m2: f64,
    /// Rooms in its map.
    pub rooms: u32,
    /// Its map contains the position of a dock.
    pub has_dock: bool,
    /// A person has removed it.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub removed: bool,
}

impl FloorView {
    /// What to call it in a list.
    #[must_use]
    pub fn title(&self) -> String {
        self.name
            .clone()
            .unwrap_or_else(|| format!("Floor {}", self.number))
    }
}

/// Why a person should say on which floor the robot is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FloorQuestion {
    /// Named reason: `which-dock` or `floor-unknown`.
    pub reason: String,
    /// One sentence for people.
    pub text: String,
}
