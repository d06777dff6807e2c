//! Why the robot doubts the map of its home.

use super::named_enum::named_enum;

named_enum! {
    /// How map and home disagree.
    MapDoubt {
        /// Nothing is where the map has walls and furniture.
        MappedNotMet => "mapped-not-met",
        /// Walls and furniture stand where the map has floor.
        MetNotMapped => "met-not-mapped",
        /// The robot, which nobody has carried, does not find its place in the map for most of its way.
        PlaceNotInMap => "place-not-in-map",
    }
}
