//! Parameters of bouncing.

use core::ops::Range;

/// Bouncing in the open.
pub(super) struct BounceParameters {
    /// A longer straight without an encounter is implausible, metres, since a home has walls: perhaps the wheels spin.
    pub(super) straight_max_m: f64,
    /// Random turn after such a straight, radians.
    pub(super) long_straight_turn_rad: Range<f64>,
    /// Random turn away from a cliff, radians. It is close to a half turn, so that the robot does not meet the edge
    /// again at once: three cliffs in 5 s latch the firmware (S8).
    pub(super) cliff_turn_rad: Range<f64>,
    /// Random turn after a head-on contact, radians. It must be larger than after a touch on one side.
    pub(super) ahead_turn_rad: Range<f64>,
    /// Random turn after a touch on one side, radians.
    pub(super) side_turn_rad: Range<f64>,
    /// Distance to back off in the open and along an edge, metres.
    pub(super) back_m: f64,
}

pub(super) const BOUNCE: BounceParameters = BounceParameters {
    straight_max_m: 14.0,
    long_straight_turn_rad: 1.0..2.5,
    cliff_turn_rad: 1.9..2.8,
    ahead_turn_rad: 1.3..3.1,
    side_turn_rad: 0.7..2.6,
    back_m: 0.03,
};

/// Bouncing out of a pocket.
pub(super) struct PocketParameters {
    /// A straight below this is short, metres.
    pub(super) short_m: f64,
    /// A straight above this leads out of the pocket, metres.
    pub(super) free_m: f64,
    /// Short straights until the robot follows the edge by touch.
    pub(super) edge_after: u32,
    /// Short straights until it searches all round for an opening.
    pub(super) cage_after: u32,
    /// Short straights until the pocket counts as closed.
    pub(super) closed_after: u32,
    /// Random turn along an edge after a head-on contact, radians.
    pub(super) edge_ahead_turn_rad: Range<f64>,
    /// Random turn along an edge after a touch on one side, radians.
    pub(super) edge_side_turn_rad: Range<f64>,
    /// Random turn while searching for an opening, radians.
    pub(super) cage_turn_rad: Range<f64>,
    /// Distance to back off while searching, metres. Between chair legs the next turn needs a different position.
    pub(super) cage_back_m: f64,
}

pub(super) const POCKET: PocketParameters = PocketParameters {
    short_m: 0.25,
    free_m: 0.6,
    edge_after: 3,
    cage_after: 10,
    closed_after: 22,
    edge_ahead_turn_rad: 0.8..1.8,
    edge_side_turn_rad: 0.15..0.6,
    cage_turn_rad: 0.4..1.4,
    cage_back_m: 0.08,
};
