//! Jobs for parts of the home, what they will take, and what people say of the home.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::CleaningPower;

/// A job for parts of the home.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JobOrder {
    /// Up to 32 parts, cleaned in this order; none means the whole home.
    #[serde(default)]
    pub parts: Vec<JobPart>,
    /// How often each part is cleaned before the next, 1..=3.
    #[serde(default = "once")]
    pub passes: u8,
    /// Up to 16 places that the robot keeps out of until the next job begins.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub avoid: Vec<NoGoShape>,
    /// How hard brushes and suction run in this job, in whole percent; absent = as is set for each room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power: Option<CleaningPower>,
    /// By which pattern this job sweeps; absent = as is set for each room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pattern: Option<CleaningPattern>,
}

/// The pattern by which floor is swept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CleaningPattern {
    /// Straight lanes side by side.
    #[default]
    Lines,
    /// Rings along walls and furniture, from the wall inwards.
    Contour,
}

impl CleaningPattern {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Lines, Self::Contour];

    /// Its name, as in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Contour => "contour",
        }
    }

    /// The one of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|pattern| pattern.name() == name)
    }

    /// Whether it is the default.
    #[must_use]
    pub fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

fn once() -> u8 {
    1
}

impl Default for JobOrder {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            passes: once(),
            avoid: Vec::new(),
            power: None,
            pattern: None,
        }
    }
}

/// A part of the home.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum JobPart {
    /// A room by its identity.
    Room(u16),
    /// A polygon of 3 to 64 corners, metres in the frame of the map.
    Zone(Vec<[f64; 2]>),
    /// The disc of [`SPOT_RADIUS_M`] around a place, metres.
    Spot([f64; 2]),
    /// A zone or spot that is kept, by its number, as it is when the job starts.
    Place(u16),
}

/// What can be kept under a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaceShape {
    /// As [`JobPart::Zone`].
    Zone(Vec<[f64; 2]>),
    /// As [`JobPart::Spot`].
    Spot([f64; 2]),
}

/// A zone or spot that is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceView {
    /// Its number, from 1; it stays the same.
    pub number: u16,
    /// What people call it.
    pub name: String,
    /// Where it is.
    pub shape: PlaceShape,
}

/// Radius of a spot, metres.
pub const SPOT_RADIUS_M: f64 = 0.5;

/// What a job will take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JobEstimate {
    /// Number of the request that asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
    /// Floor that can be swept, square metres.
    pub floor_m2: f64,
    /// Time, seconds, without pauses for charging.
    pub time_s: f64,
    /// Share of a full battery that the job and the drive home take.
    pub charge: f64,
    /// How often the robot must charge in between, from what the battery holds now.
    #[serde(default)]
    pub recharges: u32,
    /// Share of `floor_m2` that is expected to be swept, 0..1.
    pub share: f64,
    /// The same if the true position error is twice the estimated one.
    pub share_low: f64,
}

/// Floor that the robot must not enter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoGoShape {
    /// A polygon of 3 to 64 corners, metres.
    Zone(Vec<[f64; 2]>),
    /// A virtual wall between two places, metres.
    Wall([[f64; 2]; 2]),
}

/// A no-go zone or virtual wall of the map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NoGoView {
    /// Its number, from 1; never used twice in a map.
    pub number: u16,
    /// What it forbids.
    pub shape: NoGoShape,
    /// What people call it, if anybody has named it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// How a room was cleaned before a change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RoomBefore {
    /// How; absent = as any other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<RoomSettings>,
}

/// How a room is cleaned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomSettings {
    /// How often at least, 1..=3, whenever a job names the room.
    #[serde(default = "once")]
    pub passes: u8,
    /// How hard brushes and suction run in it, in whole percent. What a robot lacks is ignored.
    #[serde(default = "full_power")]
    pub power: CleaningPower,
    /// The pattern by which it is swept; absent = lines.
    #[serde(default, skip_serializing_if = "CleaningPattern::is_usual")]
    pub pattern: CleaningPattern,
}

fn full_power() -> CleaningPower {
    CleaningPower::FULL
}

impl Default for RoomSettings {
    fn default() -> Self {
        Self {
            passes: once(),
            power: full_power(),
            pattern: CleaningPattern::Lines,
        }
    }
}

/// A line that cuts a room in two.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomSplitting {
    /// Identity of the room; absent = the room in which the line is longest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room: Option<u16>,
    /// Two places, metres; the line goes on for half a metre beyond them, or to the border of the room.
    pub line: [[f64; 2]; 2],
}

/// A change that people have made of the rooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomChangeView {
    /// Its number, from 1; never used twice in a map.
    pub number: u16,
    /// The room that was cut and the part that was cut off; or the room that both are now, and the one that went into it.
    pub rooms: [u16; 2],
    /// Where the room was cut; absent = the two were joined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<[[f64; 2]; 2]>,
}

/// A name for a room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomNaming {
    /// Identity of the room.
    pub room: u16,
    /// 1 to 40 characters; absent = the room has none any more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
