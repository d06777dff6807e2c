//! The decisions of the brain, each with its named cause.

use crate::model::edit_error::EditError;
use crate::model::job_refusal::JobRefusal;
use crate::model::named_enum::named_enum;
use crate::model::reason::Reason;

/// A decision and its cause, for the log, the recording and `rvac why`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// What was decided.
    pub kind: DecisionKind,
    /// Why.
    pub cause: DecisionCause,
    /// A value of the decision, for example the angle of a turn in radians; 0 where there is none.
    pub value: f64,
}

/// Why something was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DecisionCause {
    /// What the robot perceived, or what somebody asked for.
    Reason(Reason),
    /// Why a job command is refused.
    Refusal(JobRefusal),
    /// Why a map edit is refused.
    Edit(EditError),
}

impl DecisionCause {
    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reason(reason) => reason.name(),
            Self::Refusal(refusal) => refusal.name(),
            Self::Edit(error) => error.name(),
        }
    }
}

impl DecisionKind {
    /// Name of the state that is entered by this decision; `None` for any other decision.
    #[must_use]
    pub fn state_name(self) -> Option<&'static str> {
        self.name().strip_prefix("state-")
    }
}

named_enum! {
    /// What the brain decides. The names are what logs, recordings and clients carry.
    DecisionKind {
        /// Drives in to the dock by its beams.
        Approach => "approach",
        /// Follows an arc round the end of a wall.
        Arc => "arc",
        /// Backs off from a contact or a cliff.
        BackOff => "back-off",
        /// Begins the map of its first run anew: the robot was carried, and does not find its place in it.
        BeginMapAnew => "begin-map-anew",
        /// Turns away by a random angle.
        Bounce => "bounce",
        /// Cleans by statistics instead of by lanes.
        CleanByStatistics => "clean-by-statistics",
        /// The lap along the walls is closed.
        ContourClosed => "contour-closed",
        /// The floor to clean is covered.
        Covered => "covered",
        /// The floor that a doubted map shows is covered: how much of the home that is, nobody knows.
        CoveredByMap => "covered-by-map",
        /// Leaves the dock.
        Depart => "depart",
        /// The position of the dock is measured.
        DockFound => "dock-found",
        /// Follows the centreline of the dock.
        DockLine => "dock-line",
        /// Tries to dock once more.
        DockRetry => "dock-retry",
        /// Turns to find the centreline of the dock.
        DockScan => "dock-scan",
        /// Searches for the dock along the walls.
        DockSearch => "dock-search",
        /// Turns while it roams in search of the dock.
        DockSearchTurn => "dock-search-turn",
        /// Drives to where the dock is or was received.
        DockTravel => "dock-travel",
        /// Planned a path to the place to which it is sent.
        PlaceWay => "place-way",
        /// Planned a path to the dock.
        DockWay => "dock-way",
        /// Wiggles on the contacts of the dock.
        DockWiggle => "dock-wiggle",
        /// Doubts the map of the home: it predicts other things than the robot meets.
        DoubtMap => "doubt-map",
        /// A map edit that was admitted does not apply any more.
        EditRefused => "edit-refused",
        /// Ends the lap along the walls.
        EndLap => "end-lap",
        /// Recovery: backs out.
        EscapeBackOut => "escape-back-out",
        /// Recovery: follows the contour with the obstacle on the left.
        EscapeEdgeLeft => "escape-edge-left",
        /// Recovery: follows the contour with the obstacle on the right.
        EscapeEdgeRight => "escape-edge-right",
        /// Recovery: reverses.
        EscapeReverse => "escape-reverse",
        /// Recovery: waits.
        EscapeWait => "escape-wait",
        /// Recovery: wiggles.
        EscapeWiggle => "escape-wiggle",
        /// Drives about until beacons tell its heading.
        FindHeading => "find-heading",
        /// Has followed walls that tell its position.
        FixTaken => "fix-taken",
        /// Follows a wall.
        FollowWall => "follow-wall",
        /// Forgets where the radio beacon of this number was.
        ForgetBeacons => "forget-beacons",
        /// Forgets the obstructions of this job.
        ForgetObstructions => "forget-obstructions",
        /// Recovery succeeded.
        Free => "free",
        /// Beacons tell its heading: lanes begin.
        HeadingFound => "heading-found",
        /// Keeps no map in this job.
        KeepNoMap => "keep-no-map",
        /// Begins a lap along the walls.
        Lap => "lap",
        /// Leaves the gyro out of the estimate of the pose: only the wheels tell the heading.
        LeaveOutGyro => "leave-out-gyro",
        /// Leaves the wall that it follows.
        LeaveWall => "leave-wall",
        /// Leaves the planned path.
        LeaveWay => "leave-way",
        /// Knows its place between its radio beacons again.
        PlaceFound => "place-found",
        /// Planned the remaining floor.
        Plan => "plan",
        /// Refuses a job command.
        Refuse => "refuse",
        /// Stands still to measure the bias of the gyro.
        Rest => "rest",
        /// Looks for its place between its radio beacons.
        SearchPlace => "search-place",
        /// Drives a spiral.
        Spiral => "spiral",
        /// Plans with narrower margins.
        Squeeze => "squeeze",
        /// Enters the state `cleaning`.
        StateCleaning => "state-cleaning",
        /// Enters the state `disconnected`.
        StateDisconnected => "state-disconnected",
        /// Enters the state `docked`.
        StateDocked => "state-docked",
        /// Enters the state `docking`.
        StateDocking => "state-docking",
        /// Enters the state `error`.
        StateError => "state-error",
        /// Enters the state `idle`.
        StateIdle => "state-idle",
        /// Enters the state `manual`.
        StateManual => "state-manual",
        /// Enters the state `paused`.
        StatePaused => "state-paused",
        /// Enters the state `spot`.
        StateSpot => "state-spot",
        /// It drives to a place.
        StateGoing => "state-going",
        /// Enters the state `starting`.
        StateStarting => "state-starting",
        /// Enters the state `stuck`.
        StateStuck => "state-stuck",
        /// Goes to walls that tell its position.
        TakeFix => "take-fix",
        /// Takes the gyro into the estimate of the pose again.
        TakeUpGyro => "take-up-gyro",
        /// Turns on the spot.
        Turn => "turn",
        /// Goes on with the next part of the order.
        TurnToPart => "turn-to-part",
        /// Stands and waits.
        Wait => "wait",
        /// Waits for charging current on the contacts.
        WaitForCurrent => "wait-for-current",
        /// Rolls the map back to when the pose was last right.
        Withdraw => "withdraw",
    }
}
