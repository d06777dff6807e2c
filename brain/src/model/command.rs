//! What people and schedules ask of the brain.

use super::geometry::Point2;
use super::map_edit::MapEdit;
use super::order::CleaningOrder;

/// A request, already arbitrated (see `vthal-core`): at most one source speaks at a time.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Changes the map.
    Edit(MapEdit),
    /// Changes what the robot does.
    Job(JobCommand),
}

impl From<MapEdit> for Command {
    fn from(edit: MapEdit) -> Self {
        Self::Edit(edit)
    }
}

impl From<JobCommand> for Command {
    fn from(command: JobCommand) -> Self {
        Self::Job(command)
    }
}

/// A request about what the robot does.
#[derive(Clone, Debug, PartialEq)]
pub enum JobCommand {
    /// Clean everything with the named strategy.
    Clean {
        /// Which.
        strategy: StrategyName,
    },
    /// Clean parts of a known home with `systematic`.
    CleanParts {
        /// Which, and how often.
        order: CleaningOrder,
    },
    /// Clean a small disc around the present place.
    Spot,
    /// Drive to a place on the map without cleaning, and stand there.
    GoTo {
        /// Which.
        place: Point2,
    },
    /// Stand still, keep the job.
    Pause,
    /// Go on with the paused job.
    Resume,
    /// End the job and stand still.
    Stop,
    /// Finish the job, drive to the dock without cleaning, then stop.
    Dock,
    /// A person drives. Valid until `valid_until_us`.
    Manual {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate.
        turn_rad_per_s: f64,
        /// Host time at which the lease ends.
        valid_until_us: u64,
        /// Brushes and suction run while driving.
        cleaners: bool,
    },
    /// The person lets go.
    ManualEnd,
    /// A person acknowledges an error whose cause is gone.
    ClearError,
}

/// Strategies that can be chosen by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StrategyName {
    /// `bounce`: drive until a bump, back off, turn by a random angle. What the software of 2016 did.
    #[default]
    Bounce,
    /// `statistical`: bouncing towards floor that was not swept lately, along the walls to the next place. For robots whose only
    /// source of heading is their wheels.
    Statistical,
    /// `systematic`: lanes over a home whose map is known, with few turns.
    Systematic,
    /// `wall-bounce`: bouncing with stretches along the walls and spirals on open floor.
    WallBounce,
}

impl StrategyName {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Bounce,
        Self::Statistical,
        Self::Systematic,
        Self::WallBounce,
    ];

    /// The name people type.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::Statistical => "statistical",
            Self::Systematic => "systematic",
            Self::WallBounce => "wall-bounce",
        }
    }

    /// The strategy with exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|strategy| strategy.name() == name)
    }
}
