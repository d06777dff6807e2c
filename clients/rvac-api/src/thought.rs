//! The robot's estimates, its planned path, and the reasons of its decisions.

use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// How certain the robot is of its position and of its coverage. Unknown values are absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Standard deviation of its place along the worst direction, metres.
    pub sigma_m: f64,
    /// Standard deviation of its heading, radians.
    pub sigma_rad: f64,
    /// It does not know where it is: its pose is where odometry has carried the last one that it believed.
    pub lost: bool,
    /// Share of the recent sensor readings that the map explains, 0..1. Only of a robot that compares with a map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub agreement: Option<f64>,
    /// Share of the reachable floor, as far as mapped, that the running or waiting job has swept, 0..1. Only of
    /// strategies that know the floor to sweep or estimate it by statistics. For a job for parts of the home it is the share of the current part, for one
    /// with several passes the share of the current pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covered: Option<f64>,
    /// The same if the true position error is twice the estimated one; by statistics, if there is more floor than estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covered_low: Option<f64>,
    /// Why the map of the home is doubted. Then no share is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map_doubt: Option<MapDoubt>,
}

/// How map and home disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapDoubt {
    /// Nothing is where the map has walls and furniture.
    MappedNotMet,
    /// Walls and furniture stand where the map has floor.
    MetNotMapped,
    /// The robot, which nobody has carried, does not find its place in the map for most of its way.
    PlaceNotInMap,
}

impl MapDoubt {
    /// Its code in the catalogue of reasons.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::MappedNotMet => "mapped-not-met",
            Self::MetNotMapped => "met-not-mapped",
            Self::PlaceNotInMap => "place-not-in-map",
        }
    }
}

/// The planned path of the running or waiting job from here on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedPath {
    /// Its corners as `[x0,y0,x1,y1,...]` in millimetres of the map frame; empty where the robot decides as it goes.
    pub points_mm: Vec<i32>,
    /// Length of the rest of the plan, behind a wall that it did not know: the robot plans anew there.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub beyond_mm: u32,
}

/// Serde asks for a reference.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives one")]
const fn is_zero(number: &u32) -> bool {
    *number == 0
}

/// Something that the robot decided.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Rising number.
    pub number: u64,
    /// Seconds since the daemon's start.
    pub t: f64,
    /// What, by name: `back-off`, `turn`, `plan`, `state-cleaning` and so on.
    pub what: String,
    /// Why, by name: `bump-left`, `battery-low` and so on.
    pub reason: String,
    /// A number that belongs to it, for example the angle of a turn in radians; 0 where there is none.
    pub value: f64,
    /// The same as one sentence for people.
    pub text: String,
}
