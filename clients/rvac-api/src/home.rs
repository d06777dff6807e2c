//! The robot's map of the home, over all of its jobs.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{NoGoView, PlaceView, Pose, Rle, RoomChangeView, RoomSettings};

/// The home as far as it is mapped, in the frame of the robot's poses.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HomeView {
    /// Grows when something is known that was not.
    pub revision: u32,
    /// Metres per cell; larger than the robot's own cells when those would be too many to be sent.
    pub cell_m: f64,
    /// Column of the lowest cell, which spans `x*cell_m` to `(x+1)*cell_m`.
    pub x: i32,
    /// Row of the lowest cell.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What each cell is: 0 not known, 1 free floor, 2 an obstacle, 3 the end of the floor, 4 not to be entered.
    pub cells: Rle,
    /// Room of each cell, 0 = none.
    pub room_cells: Rle,
    /// The rooms, by their identities.
    pub rooms: Vec<RoomView>,
    /// The doors between them.
    pub doors: Vec<DoorView>,
    /// Straight walls.
    pub walls: Vec<WallView>,
    /// Pose of a robot on the dock, if that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dock: Option<Pose>,
    /// A person reported it; the robot has not docked there yet.
    #[serde(default, rename = "dock_told", skip_serializing_if = "is_false")]
    pub dock_reported: bool,
    /// No-go zones and virtual walls, by their numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub no_go: Vec<NoGoView>,
    /// Zones and spots that are kept, by their numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<PlaceView>,
    /// How people have changed the rooms, in the order in which they did.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub room_changes: Vec<RoomChangeView>,
    /// How sure all of it is, then how sure each room is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sureness: Vec<SurenessView>,
    /// Where carpets lie, as far as the robot has detected them; absent where it does not measure motor currents.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carpet: Option<CarpetView>,
}

/// Where carpets lie, detected by the currents of wheels and main brush compared with those elsewhere in the home. Absent for
/// either kind of floor before the robot has driven over both.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CarpetView {
    /// Floor that is carpet, square metres.
    pub area_m2: f64,
    /// Floor that is none, square metres; the rest is not measured yet.
    pub hard_m2: f64,
    /// The surface detected in each cell of the home's window: 0 nothing, 1 hard floor, 2 carpet.
    pub cells: Rle,
}

/// Confidence of the map of the home or of a room. Shares are from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurenessView {
    /// Identity of the room; absent for the whole home.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room: Option<u16>,
    /// Standard deviation of the robot's place when it saw the floor best, metres; root of the mean square over the floor.
    pub sigma_m: f64,
    /// Share of the floor on which the robot's body has been; the rest it saw from afar.
    pub driven: f64,
    /// Share of the floor's border that the robot knows by contacts alone: as points, not as lines.
    pub touched: f64,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// A version of the map of the home that the daemon keeps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptMap {
    /// Its number; later versions have higher ones.
    pub number: u64,
    /// When it was kept, seconds since 1970.
    pub kept_s: u64,
    /// Free floor in it, square metres.
    pub area_m2: f64,
    /// Rooms in it.
    pub rooms: u32,
    /// A run with it, or before it, has doubted it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub doubted: bool,
    /// The version to take up when the newest is bad: a run with it met what it shows, or it is the newest from before a doubt.
    #[serde(default, skip_serializing_if = "is_false")]
    pub last_good: bool,
}

/// A room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomView {
    /// Identity, from 1; the same when the home is mapped again.
    pub id: u16,
    /// Its floor in square metres.
    pub area_m2: f64,
    /// A place in the middle of it, metres.
    pub x: f64,
    /// A place in the middle of it, metres.
    pub y: f64,
    /// What people call it, if anybody has named it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// How it is cleaned, if anybody has said it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<RoomSettings>,
}

/// A door between two rooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DoorView {
    /// Identities of the rooms.
    pub rooms: [u16; 2],
    /// Its middle, metres.
    pub x: f64,
    /// Its middle, metres.
    pub y: f64,
    /// Its width, metres.
    pub width_m: f64,
}

/// A straight wall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallView {
    /// One end, metres.
    pub from: [f64; 2],
    /// The other end, metres.
    pub to: [f64; 2],
    /// How sure its place is: standard deviation across, metres.
    pub sigma_m: f64,
}
