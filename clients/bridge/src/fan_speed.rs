//! How hard the robot cleans in jobs that begin here: the presets that a vacuum offers as its fan speeds.

use rvac_api::{CleaningPower, RobotDescription};

/// A preset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FanSpeed {
    /// As is set for each room.
    #[default]
    Rooms,
    /// As little as still cleans.
    Quiet,
    /// For daily dust.
    Normal,
    /// As hard as it can.
    Full,
}

impl FanSpeed {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Rooms, Self::Quiet, Self::Normal, Self::Full];

    /// Its name in Home Assistant.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rooms => "as set for rooms",
            Self::Quiet => "quiet",
            Self::Normal => "normal",
            Self::Full => "full",
        }
    }

    /// The one of exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|speed| speed.name() == name)
    }

    /// What it asks of brushes and suction; `None` = as is set for each room.
    #[must_use]
    pub const fn power(self) -> Option<CleaningPower> {
        match self {
            Self::Rooms => None,
            Self::Quiet => Some(CleaningPower::QUIET),
            Self::Normal => Some(CleaningPower::NORMAL),
            Self::Full => Some(CleaningPower::FULL),
        }
    }

    /// Whether a robot has anything that can run harder or softer.
    #[must_use]
    pub fn is_had_by(robot: &RobotDescription) -> bool {
        let cleans = ["vacuum", "brush-main", "brush-sides"];
        robot.parts.iter().any(|part| cleans.contains(&part.as_str()))
    }
}
