//! The names of our topics.

/// Below `PREFIX/ID`.
#[derive(Clone, Debug)]
pub(crate) struct Topics {
    base: String,
}

/// What we say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Saying {
    /// `online` or `offline`.
    Availability,
    /// The state of a vacuum as Home Assistant wants it.
    State,
    /// All readings, as one object.
    Readings,
    /// The map as a picture.
    Map,
    /// The robot has entered a room.
    RoomEntered,
    /// A run is over.
    RunEnded,
    /// The robot has refused something.
    Refused,
    /// How worn parts are.
    Wear,
    /// The run that ended last.
    LastRun,
}

/// What we hear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hearing {
    /// A word of Home Assistant's vacuum.
    Command,
    /// How hard to clean from the next job on.
    FanSpeed,
    /// Rooms to clean.
    Rooms,
    /// A request in the words of the daemon's interface.
    Request,
    /// The floor on which the robot is.
    Floor,
    /// The part that was cleaned or changed.
    WearReset,
    /// The part that was replaced, or whose sensors were cleaned.
    WearRenew,
}

impl Saying {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Availability => "availability",
            Self::State => "state",
            Self::Readings => "readings",
            Self::Map => "map",
            Self::RoomEntered => "event/room",
            Self::RunEnded => "event/run",
            Self::Refused => "event/refused",
            Self::Wear => "wear",
            Self::LastRun => "last-run",
        }
    }
}

impl Hearing {
    pub(crate) const ALL: [Self; 7] = [
        Self::Command,
        Self::FanSpeed,
        Self::Rooms,
        Self::Request,
        Self::Floor,
        Self::WearReset,
        Self::WearRenew,
    ];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Command => "command",
            Self::FanSpeed => "fan-speed/set",
            Self::Rooms => "rooms/clean",
            Self::Request => "request",
            Self::Floor => "floor/set",
            Self::WearReset => "wear/reset",
            Self::WearRenew => "wear/renew",
        }
    }
}

impl Topics {
    pub(crate) fn new(prefix: &str, id: &str) -> Self {
        Self {
            base: format!("{prefix}/{id}"),
        }
    }

    pub(crate) fn of(&self, saying: Saying) -> String {
        format!("{}/{}", self.base, saying.name())
    }

    pub(crate) fn of_command(&self, hearing: Hearing) -> String {
        format!("{}/{}", self.base, hearing.name())
    }

    /// What a message on this topic is; `None` when it is none of ours.
    pub(crate) fn heard(&self, topic: &str) -> Option<Hearing> {
        let name = topic.strip_prefix(&self.base)?.strip_prefix('/')?;
        Hearing::ALL.into_iter().find(|hearing| hearing.name() == name)
    }
}
