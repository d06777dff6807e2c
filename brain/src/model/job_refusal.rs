//! Why the robot does not obey.

use super::edit_error::EditError;
use super::fault::Fault;
use super::link_fault::LinkFault;
use super::named_enum::named_enum;

named_enum! {
    /// Why a [`crate::JobCommand`] is refused.
    JobRefusal {
        /// No fresh telemetry, so the robot cannot be commanded.
        LinkLost => "link-lost",
        /// A wheel hangs: lifted or fallen.
        WheelDrop => "wheel-drop",
        /// An error must be acknowledged first.
        ErrorStands => "error-stands",
        /// There is no error to acknowledge.
        NoError => "no-error",
        /// Such a job already runs.
        AlreadyRunning => "already-running",
        /// There is nothing to pause or resume.
        NoJob => "no-job",
        /// The wheels are the only source of heading, which is not enough for a plan.
        NoHeading => "no-heading",
        /// Little charge is left.
        BatteryLow => "battery-low",
        /// It is on the dock already.
        Docked => "docked",
        /// Something presses the bumper of a robot on its dock.
        Bumper => "bumper",
        /// The stick must come back to the centre before it drives again (S23).
        CentreFirst => "centre-first",
        /// Values that this robot needs to move safely were never measured.
        NotCalibrated => "not-calibrated",
        /// The robot can reach nothing of what is ordered.
        RestOutOfReach => "rest-out-of-reach",
        /// It is not sure where it is, and would not find the place.
        PlaceUnknown => "place-unknown",
        /// A no-go zone shuts off what is ordered.
        NoGoInTheWay => "no-go-in-the-way",
        /// A virtual wall shuts off what is ordered.
        VirtualWallInTheWay => "virtual-wall-in-the-way",
        /// A door that was open shuts off what is ordered, or something stands in it.
        DoorShut => "door-shut",
        /// Something that was not there before shuts off what is ordered.
        NewObstacleInTheWay => "new-obstacle-in-the-way",
    }
    nested {
        /// A fault stands.
        Fault(Fault),
        /// The link cannot be relied upon.
        Link(LinkFault),
        /// The order does not fit the home.
        Order(EditError),
    }
}

impl From<EditError> for JobRefusal {
    fn from(error: EditError) -> Self {
        Self::Order(error)
    }
}
