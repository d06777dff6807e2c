//! Parameters of localization by RSSI fingerprints. They are chosen by hand for the simulator's own model of radio
//! (`sim/home/src/linux_board/strength.rs`, with its sources). `docs/book/src/measurements/relocalization.md` shows what they achieve
//! together; no record compares values of a single one.

/// How means of receiver powers become a map.
pub(super) struct FingerprintParameters {
    /// Distance over which a mean is taken, metres: fading differs from one to the next, the shadow of walls hardly.
    pub(super) averaging_m: f64,
    /// Least plausible receiver power, dBm.
    pub(super) least_dbm: f64,
    /// Greatest plausible receiver power, dBm.
    pub(super) most_dbm: f64,
    /// Edge of a cell, metres.
    pub(super) cell_m: f64,
    /// Neighbouring cells on each side that contribute to a position.
    pub(super) neighbours: i32,
    /// Width of their weight, metres: shadows of walls are a metre or two wide.
    pub(super) reach_m: f64,
    /// A position is known when its weights sum up to at least this, in means of the cell itself.
    pub(super) known_min: f64,
    /// Greatest number of means that a cell counts: the home changes, and the last means count most.
    pub(super) count_max: f64,
    /// Greatest number of means by which a cell contributes to its neighbours.
    pub(super) contribution_max: f64,
}

pub(super) const FINGERPRINT: FingerprintParameters = FingerprintParameters {
    averaging_m: 0.3,
    least_dbm: -130.0,
    most_dbm: 0.0,
    cell_m: 0.5,
    neighbours: 2,
    reach_m: 0.6,
    known_min: 0.5,
    count_max: 12.0,
    contribution_max: 3.0,
};

/// What a pose costs in global localization when its fingerprints differ from the means that were taken.
pub(super) struct MatchParameters {
    /// Standard deviation between a mean and the fingerprint of the same position, decibels: remaining fading, direction of the
    /// antenna, interpolation.
    pub(super) sigma_db: f64,
    /// Greatest deviation that counts, in standard deviations: somebody may be in the path.
    pub(super) off_max: f64,
    /// Cost of a pose, in the score of global localization, for each unit by which the mean square of the deviations exceeds 1.
    pub(super) cost: f64,
    /// Fewest comparisons for a cost.
    pub(super) compared_min: usize,
}

pub(super) const MATCH: MatchParameters = MatchParameters {
    sigma_db: 3.5,
    off_max: 3.0,
    cost: 0.08,
    compared_min: 4,
};
