//! Numbers that are given next on a floor. People, schedules and scripts keep numbers, so none is given a second time, whatever becomes of
//! the map.

/// The next numbers of a floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NextNumbers {
    /// Of the next new room.
    pub room: u16,
    /// Of the next split or join of rooms.
    pub room_change: u16,
    /// Of the next no-go zone or virtual wall.
    pub no_go: u16,
    /// Of the next saved place.
    pub place: u16,
}

impl Default for NextNumbers {
    fn default() -> Self {
        Self::FIRST
    }
}

impl NextNumbers {
    /// Those of a floor on which nothing has had a number yet.
    pub const FIRST: Self = Self {
        room: 1,
        room_change: 1,
        no_go: 1,
        place: 1,
    };

    /// Numbers that neither has given.
    #[must_use]
    pub fn after(self, other: Self) -> Self {
        Self {
            room: self.room.max(other.room),
            room_change: self.room_change.max(other.room_change),
            no_go: self.no_go.max(other.no_go),
            place: self.place.max(other.place),
        }
    }
}
