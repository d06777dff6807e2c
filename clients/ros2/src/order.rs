//! What can be asked for by a service of the type `std_srvs/Trigger`.

use rvac_api::{JobOrder, RequestBody};

/// An order without arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// Cleans the whole home.
    Clean,
    /// Cleans a small disc around the robot.
    Spot,
    /// Drives home.
    Dock,
    Pause,
    Resume,
    /// Ends the job; the robot stands.
    Stop,
    /// Beeps.
    Locate,
}

impl Order {
    pub(crate) const ALL: [Self; 7] = [
        Self::Clean,
        Self::Spot,
        Self::Dock,
        Self::Pause,
        Self::Resume,
        Self::Stop,
        Self::Locate,
    ];

    /// Name of the service, in the namespace of the robot.
    pub(crate) const fn service(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::Spot => "spot",
            Self::Dock => "dock",
            Self::Pause => "pause",
            Self::Resume => "resume",
            Self::Stop => "stop",
            Self::Locate => "locate",
        }
    }

    pub(crate) fn request(self) -> RequestBody {
        match self {
            Self::Clean => RequestBody::Clean(JobOrder::default()),
            Self::Spot => RequestBody::Spot,
            Self::Dock => RequestBody::Dock,
            Self::Pause => RequestBody::Pause,
            Self::Resume => RequestBody::Resume,
            Self::Stop => RequestBody::Stop,
            Self::Locate => RequestBody::Locate,
        }
    }
}
