//! Why what people say of the home cannot be.

use super::named_enum::named_enum;

named_enum! {
    /// Why an edit of the map cannot be made, or an order for parts of the home cannot be carried out.
    EditError {
        /// The robot has no map of the home.
        NoMap => "no-map",
        /// Too many parts, or another number of passes than 1 to 3.
        BadOrder => "bad-order",
        /// A zone has 3 to 64 corners near the home.
        BadZone => "bad-zone",
        /// The edges of a zone cross, fold back or touch.
        ZoneCrosses => "zone-crosses",
        /// A zone has less than half a square decimetre, or is narrower than 2 cm on the whole.
        ZoneTooThin => "zone-too-thin",
        /// The map has no room with this identity.
        NoSuchRoom => "no-such-room",
        /// There is no no-go zone or virtual wall of this number.
        NoSuchNoGo => "no-such-no-go",
        /// As many no-go zones and virtual walls as a home can have.
        TooManyNoGos => "too-many-no-gos",
        /// No zone or spot is kept under this number.
        NoSuchPlace => "no-such-place",
        /// As many zones and spots as a home can keep.
        TooManyPlaces => "too-many-places",
        /// The robot could not reach its dock any more.
        DockInside => "dock-inside",
        /// Most of the floor would be shut off from the dock.
        DockShutOff => "dock-shut-off",
        /// A name is one line of 1 to 40 characters.
        BadName => "bad-name",
        /// Another room is called so.
        NameTaken => "name-taken",
        /// Settings of a room have 1 to 3 passes and shares up to 100 percent, one of them above 0.
        BadSettings => "bad-settings",
        /// A line between rooms has two ends near the home.
        BadLine => "bad-line",
        /// A line that was to cut a room lies in none, or beside the one that is meant.
        LineMissesRoom => "line-misses-room",
        /// A line that was to cut a room leaves a way round it.
        LineEndsInRoom => "line-ends-in-room",
        /// What a line would cut off is too small for a room.
        PartTooSmall => "part-too-small",
        /// Rooms that are not beside each other.
        RoomsApart => "rooms-apart",
        /// There is no change of the rooms of this number.
        NoSuchRoomChange => "no-such-room-change",
        /// Another change of the rooms builds on it.
        RoomChangeInUse => "room-change-in-use",
        /// The rooms were changed as often as those of a home can be.
        TooManyRoomChanges => "too-many-room-changes",
        /// A zone without any floor that the map knows.
        NoFloorThere => "no-floor-there",
    }
}
