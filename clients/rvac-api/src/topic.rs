//! What a client can follow.

use serde::{Deserialize, Serialize};

/// Parts of the update stream a client can follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topic {
    /// [`crate::Update::Status`] on each change.
    Status,
    /// [`crate::Update::Pose`], 20 a second while the robot moves.
    Pose,
    /// [`crate::Update::Device`], twice a second.
    Device,
    /// A [`crate::Update::Map`] snapshot at once, then [`crate::Update::MapDelta`], five a second while the robot cleans.
    Map,
    /// [`crate::Update::Home`] at once, then when the robot knows more, at most every five seconds.
    Home,
    /// [`crate::Update::Estimate`] when it changes, at most twice a second.
    Estimate,
    /// [`crate::Update::PlannedPath`] when it changes, at most every two seconds. The wire says `way`.
    #[serde(rename = "way")]
    PlannedPath,
    /// [`crate::Update::Decision`]: the last 100 at once, then each new one.
    Decisions,
    /// [`crate::Update::Log`]: the last 200 entries at once, then each new one.
    Log,
    /// [`crate::Update::Packet`]: each packet of the wire, both directions.
    Packets,
    /// [`crate::Update::Schedules`] at once, then when it changes.
    Schedules,
    /// [`crate::Update::RunKept`] for each run that ends, when it is on the disk.
    Runs,
    /// [`crate::Update::Floors`] at once, then when it changes.
    Floors,
    /// [`crate::Update::Standstill`]: the last ten at once, then each new one.
    Standstills,
    /// [`crate::Update::Button`] for each press and each hold.
    Buttons,
    /// [`crate::Update::Inputs`] at once, then with each word of a client that tells some, and when one is gone.
    Inputs,
}
