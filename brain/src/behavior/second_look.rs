//! A first run that could not reach much of the home tries once more from its dock.
//!
//! A map that is still bent can shut a robot in: a wall that was drawn from a wrong place closes a door. On the dock the robot knows its
//! place, the map is drawn again with that, and what was shut in is mostly open then.

/// Whether a job has looked again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum SecondLook {
    /// Not yet.
    #[default]
    NotYet,
    /// As soon as it is on the dock.
    Due,
    /// It did.
    Had,
}

impl SecondLook {
    /// The job goes on from the dock.
    pub(super) fn begins(&mut self) {
        if *self == Self::Due {
            *self = Self::Had;
        }
    }
}
