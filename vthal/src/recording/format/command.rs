//! Commands of people and schedules to the brain, as recordings have them.
//!
//! All forms are written without the level of nesting that [`Command`] has: `"spot"`, `{"add-no-go":...}`.

use brain::{Command, JobCommand, MapEdit, StrategyName};
use serde::{Deserialize, Serialize};

use super::map_edit::{GivenDockEdit, GivenNoGoEdit, GivenPlaceEdit, GivenRoomEdit};
use super::order::GivenOrder;

/// [`Command`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum GivenCommand {
    /// [`Command::Job`]
    Job(GivenJobCommand),
    /// [`MapEdit::NoGo`]
    NoGo(GivenNoGoEdit),
    /// [`MapEdit::Place`]
    Place(GivenPlaceEdit),
    /// [`MapEdit::Room`]
    Room(GivenRoomEdit),
    /// [`MapEdit::Dock`]
    Dock(GivenDockEdit),
}

impl From<&Command> for GivenCommand {
    fn from(command: &Command) -> Self {
        match command {
            Command::Job(command) => Self::Job(command.into()),
            Command::Edit(MapEdit::NoGo(edit)) => Self::NoGo(edit.into()),
            Command::Edit(MapEdit::Place(edit)) => Self::Place(edit.into()),
            Command::Edit(MapEdit::Room(edit)) => Self::Room(edit.into()),
            Command::Edit(MapEdit::Dock(pose)) => Self::Dock(pose.into()),
        }
    }
}

impl GivenCommand {
    /// Back to the brain's own type; `None` for a strategy that this version does not have.
    #[must_use]
    pub fn to_brain(&self) -> Option<Command> {
        Some(match self {
            Self::Job(command) => Command::Job(command.to_brain()?),
            Self::NoGo(edit) => Command::Edit(MapEdit::NoGo(edit.to_brain()?)),
            Self::Place(edit) => Command::Edit(MapEdit::Place(edit.to_brain()?)),
            Self::Room(edit) => Command::Edit(MapEdit::Room(edit.to_brain()?)),
            Self::Dock(edit) => Command::Edit(MapEdit::Dock(edit.to_brain())),
        })
    }
}

/// [`JobCommand`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenJobCommand {
    /// [`JobCommand::Clean`] by the strategy's name.
    Clean(String),
    /// [`JobCommand::CleanParts`]
    CleanParts(GivenOrder),
    /// [`JobCommand::Spot`]
    Spot,
    /// [`JobCommand::Pause`]
    Pause,
    /// [`JobCommand::Resume`]
    Resume,
    /// [`JobCommand::Stop`]
    Stop,
    /// [`JobCommand::Dock`]
    Dock,
    /// [`JobCommand::Manual`]
    Manual {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate.
        turn_rad_per_s: f64,
        /// End of the lease.
        valid_until_us: u64,
        /// Brushes and suction.
        cleaners: bool,
    },
    /// [`JobCommand::ManualEnd`]
    ManualEnd,
    /// [`JobCommand::ClearError`]
    ClearError,
}

impl From<&JobCommand> for GivenJobCommand {
    fn from(command: &JobCommand) -> Self {
        match command {
            JobCommand::Clean { strategy } => Self::Clean(strategy.name().to_owned()),
            JobCommand::CleanParts { order } => Self::CleanParts(order.into()),
            JobCommand::Spot => Self::Spot,
            JobCommand::Pause => Self::Pause,
            JobCommand::Resume => Self::Resume,
            JobCommand::Stop => Self::Stop,
            JobCommand::Dock => Self::Dock,
            JobCommand::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners,
            } => Self::Manual {
                speed_m_per_s: *speed_m_per_s,
                turn_rad_per_s: *turn_rad_per_s,
                valid_until_us: *valid_until_us,
                cleaners: *cleaners,
            },
            JobCommand::ManualEnd => Self::ManualEnd,
            JobCommand::ClearError => Self::ClearError,
        }
    }
}

impl GivenJobCommand {
    fn to_brain(&self) -> Option<JobCommand> {
        Some(match self {
            Self::Clean(strategy) => JobCommand::Clean {
                strategy: StrategyName::from_name(strategy)?,
            },
            Self::CleanParts(order) => JobCommand::CleanParts {
                order: order.to_brain()?,
            },
            Self::Spot => JobCommand::Spot,
            Self::Pause => JobCommand::Pause,
            Self::Resume => JobCommand::Resume,
            Self::Stop => JobCommand::Stop,
            Self::Dock => JobCommand::Dock,
            Self::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners,
            } => JobCommand::Manual {
                speed_m_per_s: *speed_m_per_s,
                turn_rad_per_s: *turn_rad_per_s,
                valid_until_us: *valid_until_us,
                cleaners: *cleaners,
            },
            Self::ManualEnd => JobCommand::ManualEnd,
            Self::ClearError => JobCommand::ClearError,
        })
    }
}
