//! Parameters of coverage plans. The work of each operation stands beside the function that spends it.

use crate::mapping::CELL_M;

/// Which lanes are worth driving.
pub(super) struct LaneParameters {
    /// Cells that one border edge less is worth.
    pub(super) border_cells: i16,
    /// Smallest share of the gain of a lane over fully open floor in the same time, for each round. The last round asks for what is
    /// left beside walls and legs, and comes when all else is swept.
    pub(super) round_shares: [f64; 3],
    /// Rounds where some floor is swept in rings: what these leave in their corners is not worth the last one.
    pub(super) rounds_beside_rings: usize,
    /// Cost to enter and leave a lane, in radians of turning, added to the time of a lane. Besides the turns it covers
    /// braking and the path between lanes.
    pub(super) enter_rad: f64,
}

pub(super) const LANES: LaneParameters = LaneParameters {
    border_cells: 1,
    round_shares: [0.35, 0.07, 0.03],
    rounds_beside_rings: 2,
    enter_rad: 6.0,
};

/// The order of lanes.
pub(super) struct TourParameters {
    /// Number of nearest ends to which a path is searched; the costs of others are guessed.
    pub(super) near_ends: usize,
    /// Ratio of a guessed path to the straight distance.
    pub(super) guess: f64,
    /// Turning on a guessed path, radians.
    pub(super) guess_turn_rad: f64,
    /// Most rounds of improvement.
    pub(super) passes_max: usize,
    /// Most lanes that are moved together.
    pub(super) moved_max: usize,
    /// Lanes of a later round are driven early where they sweep at least this share of what a lane over fully open floor
    /// sweeps in the same time.
    pub(super) take_along_share: f64,
    /// This many passes look for more of them.
    pub(super) take_along_passes: usize,
}

pub(super) const TOUR: TourParameters = TourParameters {
    near_ends: 20,
    guess: 1.6,
    guess_turn_rad: 4.0,
    passes_max: 30,
    moved_max: 3,
    take_along_share: 0.2,
    take_along_passes: 4,
};

/// Floor that is swept in rings.
pub(super) struct RingParameters {
    /// Number of nearest entries that are compared.
    pub(super) near_entries: usize,
    /// Cells along a section over which its direction is measured.
    pub(super) direction_cells: usize,
    /// Smallest share of what a ring sweeps over fully open floor that makes it worth driving: as for a lane of the
    /// first round.
    pub(super) worth_percent: usize,
    /// A job that has swept less than this share of the ringed floor begins at the wall or in the middle; a later plan
    /// continues where the robot is.
    pub(super) begun_share: f64,
    /// A corner may be left out where the straight line deviates by no more than this, metres: walls are drawn in steps
    /// of a cell.
    pub(super) off_max_m: f64,
}

pub(super) const RINGS: RingParameters = RingParameters {
    near_entries: 16,
    direction_cells: 8,
    worth_percent: 35,
    begun_share: 0.05,
    off_max_m: 1.3 * CELL_M,
};
