//! The states a person sees, and what belongs to them.

use crate::model::command::StrategyName;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;

/// What the robot is doing. Exactly one of these holds at any time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BehaviorState {
    /// No fresh telemetry.
    Disconnected,
    /// Nothing to do.
    Idle,
    /// Announces itself before the first autonomous motion (S24).
    Starting,
    /// Cleans everything.
    Cleaning,
    /// Cleans a small disc.
    Spot,
    /// Drives to a place without cleaning.
    Going,
    /// Searches for the dock or drives onto it.
    Docking,
    /// On the dock.
    Docked,
    /// A person drives.
    Manual,
    /// A job waits.
    Paused,
    /// Could not get unstuck; waits for a person.
    Stuck,
    /// A fault; waits until it is gone and acknowledged.
    Error,
}

impl BehaviorState {
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

    /// The name in the interface, in logs and in recordings.
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

    /// Whether the wheels may turn in this state.
    #[must_use]
    pub const fn moves(self) -> bool {
        matches!(
            self,
            Self::Cleaning | Self::Spot | Self::Going | Self::Docking | Self::Manual
        )
    }

    /// What the decision to enter this state is called.
    pub(crate) const fn decision(self) -> DecisionKind {
        match self {
            Self::Disconnected => DecisionKind::StateDisconnected,
            Self::Idle => DecisionKind::StateIdle,
            Self::Starting => DecisionKind::StateStarting,
            Self::Cleaning => DecisionKind::StateCleaning,
            Self::Spot => DecisionKind::StateSpot,
            Self::Going => DecisionKind::StateGoing,
            Self::Docking => DecisionKind::StateDocking,
            Self::Docked => DecisionKind::StateDocked,
            Self::Manual => DecisionKind::StateManual,
            Self::Paused => DecisionKind::StatePaused,
            Self::Stuck => DecisionKind::StateStuck,
            Self::Error => DecisionKind::StateError,
        }
    }
}

/// What the robot is doing and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// What.
    pub state: BehaviorState,
    /// Why.
    pub reason: Reason,
    /// Strategy of the running or waiting job; `None` without a job and for jobs of other kinds.
    pub strategy: Option<StrategyName>,
    /// A waiting job would resume now on `resume`.
    pub resumable: bool,
}

/// What the running or last job has done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobFigures {
    /// Seconds spent in motion states.
    pub time_s: f64,
    /// Swept area in square metres by the robot's own estimate.
    pub swept_m2: f64,
    /// Travel of the robot's centre in metres, in both directions.
    pub path_m: f64,
    /// Bumps.
    pub bumps: u32,
}

/// What a job is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// Clean everything.
    Clean(StrategyName),
    /// Clean a small disc.
    Spot,
    /// Drive to the only place of the order.
    GoTo,
    /// Find the dock.
    Dock,
}

impl JobKind {
    /// Whether floor is swept, and not only crossed.
    pub(crate) const fn cleans(self) -> bool {
        matches!(self, Self::Clean(_) | Self::Spot)
    }
}
