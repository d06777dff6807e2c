//! Commands of people and schedules to the brain, as recordings have them.
//!
//! All forms are written without the level of nesting that [`Command`] has: `"spot"`, `{"c":"remove-no-go","number":2}`.

use brain::{Command, JobCommand, Point2, StrategyName};
use rvac_api::RequestBody;
use serde::{Deserialize, Serialize};
use vthal_core::api_forms;

use super::earlier_map_edit::EarlierMapEdit;
use super::order::GivenOrder;

/// [`Command`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum GivenCommand {
    /// [`Command::Job`]
    Job(GivenJobCommand),
    /// [`Command::Edit`], as a client asks for it on the socket.
    Edit(RequestBody),
    /// [`Command::Edit`] in recordings of earlier versions.
    EarlierEdit(EarlierMapEdit),
}

impl From<&Command> for GivenCommand {
    fn from(command: &Command) -> Self {
        match command {
            Command::Job(command) => Self::Job(command.into()),
            Command::Edit(edit) => Self::Edit(api_forms::map_edit(edit)),
        }
    }
}

impl GivenCommand {
    /// Back to the brain's own type; `None` for what this version does not have.
    #[must_use]
    pub fn to_brain(&self) -> Option<Command> {
        Some(match self {
            Self::Job(command) => Command::Job(command.to_brain()?),
            Self::Edit(asked) => Command::Edit(api_forms::to_map_edit(asked.clone())?),
            Self::EarlierEdit(edit) => Command::Edit(api_forms::to_map_edit(edit.to_request())?),
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
    /// [`JobCommand::GoTo`]
    GoTo {
        /// Metres in the map.
        x_m: f64,
        /// The same.
        y_m: f64,
    },
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
            JobCommand::GoTo { place } => Self::GoTo {
                x_m: place.x_m,
                y_m: place.y_m,
            },
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
            Self::GoTo { x_m, y_m } => JobCommand::GoTo {
                place: Point2 { x_m: *x_m, y_m: *y_m },
            },
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
