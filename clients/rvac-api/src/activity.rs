//! What the robot is doing as a closed set, and the words by which other systems know it.

/// What the robot is doing: the closed set behind [`crate::Status::state`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Activity {
    /// No robot answers.
    Disconnected,
    /// Nothing to do.
    Idle,
    /// Announces itself before it moves.
    Starting,
    /// Cleans.
    Cleaning,
    /// Cleans a small disc.
    Spot,
    /// Drives to a place without cleaning.
    Going,
    /// Drives to its dock.
    Docking,
    /// On the dock.
    Docked,
    /// A person drives.
    Manual,
    /// A job waits.
    Paused,
    /// Waits for a person to free it.
    Stuck,
    /// Waits for a person to remove a fault.
    Error,
}

/// An activity in the words of others. A new system of theirs is a new column here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActivityWords {
    /// `state` of a vacuum in Home Assistant.
    pub home_assistant: &'static str,
    /// `value` of a `StatusStateAttribute` in Valetudo's interface.
    pub status_value: &'static str,
    /// `flag` of the same.
    pub status_flag: &'static str,
    /// `OperationalState` of a robotic vacuum cleaner in Matter.
    pub matter_state: u8,
}

const fn words(
    home_assistant: &'static str,
    (status_value, status_flag): (&'static str, &'static str),
    matter_state: u8,
) -> ActivityWords {
    ActivityWords {
        home_assistant,
        status_value,
        status_flag,
        matter_state,
    }
}

impl Activity {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Disconnected,
        Self::Idle,
        Self::Starting,
        Self::Cleaning,
        Self::Spot,
        Self::Going,
        Self::Docking,
        Self::Docked,
        Self::Manual,
        Self::Paused,
        Self::Stuck,
        Self::Error,
    ];

    /// As in [`crate::Status::state`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Disconnected => "disconnected",
            Self::Idle => "idle",
            Self::Starting => "starting",
            Self::Cleaning => "cleaning",
            Self::Spot => "spot",
            Self::Going => "going",
            Self::Docking => "docking",
            Self::Docked => "docked",
            Self::Manual => "manual",
            Self::Paused => "paused",
            Self::Stuck => "stuck",
            Self::Error => "error",
        }
    }

    /// The one with exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|activity| activity.name() == name)
    }

    /// In the words of others.
    #[must_use]
    pub const fn words(self) -> ActivityWords {
        match self {
            Self::Disconnected | Self::Error | Self::Stuck => words("error", ("error", "none"), 0x03),
            Self::Idle => words("idle", ("idle", "none"), 0x00),
            Self::Starting | Self::Cleaning => words("cleaning", ("cleaning", "none"), 0x01),
            Self::Spot => words("cleaning", ("cleaning", "spot"), 0x01),
            Self::Going => words("cleaning", ("moving", "target"), 0x01),
            Self::Docking => words("returning", ("returning", "none"), 0x40),
            Self::Docked => words("docked", ("docked", "none"), 0x42),
            Self::Manual => words("cleaning", ("manual_control", "none"), 0x01),
            Self::Paused => words("paused", ("paused", "resumable"), 0x02),
        }
    }

    /// Its wheels turn, or will at any moment.
    #[must_use]
    pub const fn moves(self) -> bool {
        match self {
            Self::Starting | Self::Cleaning | Self::Spot | Self::Going | Self::Docking | Self::Manual => true,
            Self::Disconnected | Self::Idle | Self::Docked | Self::Paused | Self::Stuck | Self::Error => {
                false
            }
        }
    }

    /// It waits for a person.
    #[must_use]
    pub const fn needs_help(self) -> bool {
        matches!(self, Self::Disconnected | Self::Stuck | Self::Error)
    }
}

#[cfg(test)]
mod tests {
    use super::Activity;

    #[test]
    fn every_activity_has_words_that_the_others_know() {
        // Home Assistant ignores any other state and shows the old one; see its `VacuumActivity`.
        let home_assistant = ["cleaning", "docked", "paused", "idle", "returning", "error"];
        let values = [
            "error",
            "docked",
            "idle",
            "returning",
            "cleaning",
            "paused",
            "manual_control",
            "moving",
        ];
        let flags = [
            "none",
            "zone",
            "segment",
            "spot",
            "target",
            "resumable",
            "mapping",
        ];
        // Stopped, running, paused, error, seeking charger, charging, docked.
        let matter_states = [0x00, 0x01, 0x02, 0x03, 0x40, 0x41, 0x42];
        for activity in Activity::ALL {
            let words = activity.words();
            assert!(matter_states.contains(&words.matter_state), "{activity:?}");
            // A controller that shows an error asks what it is.
            assert_eq!(words.matter_state == 0x03, activity.needs_help(), "{activity:?}");
            assert!(home_assistant.contains(&words.home_assistant), "{activity:?}");
            assert!(values.contains(&words.status_value), "{activity:?}");
            assert!(flags.contains(&words.status_flag), "{activity:?}");
            assert_eq!(Activity::from_name(activity.name()), Some(activity));
        }
    }
}
