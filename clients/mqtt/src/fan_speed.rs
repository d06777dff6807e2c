//! How hard the robot cleans in jobs that begin here: the presets that a vacuum offers as its fan speeds.

use rvac_api::CleaningPower;

/// A preset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum FanSpeed {
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
    pub(crate) const ALL: [Self; 4] = [Self::Rooms, Self::Quiet, Self::Normal, Self::Full];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Rooms => "as set for rooms",
            Self::Quiet => "quiet",
            Self::Normal => "normal",
            Self::Full => "full",
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|speed| speed.name() == name)
    }

    pub(crate) const fn power(self) -> Option<CleaningPower> {
        match self {
            Self::Rooms => None,
            Self::Quiet => Some(CleaningPower::QUIET),
            Self::Normal => Some(CleaningPower::NORMAL),
            Self::Full => Some(CleaningPower::FULL),
        }
    }
}
