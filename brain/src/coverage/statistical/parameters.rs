//! Parameters of the statistical strategy.

use core::ops::Range;

/// When the robot leaves a place, and when it is done.
pub(super) struct StatisticalParameters {
    /// The robot leaves a place when no more than this share of its floor is new.
    pub(super) leave_share: f64,
    /// A spiral is worth it where more than this share is new.
    pub(super) spiral_share: f64,
    /// Distance between two spirals, metres.
    pub(super) spiral_every_m: f64,
    /// The job is done when the low bound of the swept share reaches this.
    pub(super) enough_share: f64,
    /// Shortest and longest drive along the walls to another place, metres.
    pub(super) wall_m: Range<f64>,
    /// Points beside the wall that are sampled: distances to the left of the robot's centre, metres.
    pub(super) beside_m: [f64; 4],
    /// This many of these points must be new.
    pub(super) beside_new_min: usize,
    /// They must be new over this distance without interruption, metres.
    pub(super) beside_new_m: f64,
    /// Turn away from the wall afterwards, radians.
    pub(super) away_rad: Range<f64>,
}

pub(super) const STATISTICAL: StatisticalParameters = StatisticalParameters {
    leave_share: 0.35,
    spiral_share: 0.7,
    spiral_every_m: 25.0,
    enough_share: 0.9,
    wall_m: 3.0..20.0,
    beside_m: [0.45, 0.7, 0.95, 1.2],
    beside_new_min: 3,
    beside_new_m: 1.5,
    away_rad: 0.7..2.0,
};

/// The samples of new floor.
pub(super) struct NoveltyParameters {
    /// Distance over which the share is averaged, metres.
    pub(super) window_m: f64,
    /// Distance between samples, metres.
    pub(super) step_m: f64,
    /// Distance of the samples ahead of the robot's centre, metres: the brush has just swept what is nearer.
    pub(super) ahead_m: f64,
    /// Sample points across the swath, as shares of its width.
    pub(super) across: [f64; 4],
}

pub(super) const NOVELTY: NoveltyParameters = NoveltyParameters {
    window_m: 10.0,
    step_m: 0.05,
    ahead_m: 0.15,
    across: [-0.4, -0.15, 0.15, 0.4],
};

/// The law of random coverage.
pub(super) struct CoverageLaw {
    /// Floor that was swept longer ago counts as new, seconds: by then the position from wheel odometry alone is wrong
    /// by some decimetres.
    pub(super) memory_s: u32,
    /// No estimate before this time of sweeping, seconds, which is `memory_s`: the robot has seen a part of the home
    /// only and would take that for all of it.
    pub(super) estimate_after_s: f64,
    /// Range of the search for the floor area, square metres.
    pub(super) floor_m2: Range<f64>,
    /// Steps of the bisection: they leave less than a square centimetre.
    pub(super) bisections: u32,
    /// The low bound assumes a floor this many times as large. In four simulated homes the real floor was up to 2.5
    /// times the estimate after 20 minutes, 1.4 times after 45, 1.1 times after 120; the table of these runs is not kept.
    /// `docs/book/src/measurements/relax.md` shows how often the low bound is above the truth.
    pub(super) larger: f64,
    /// The low bound grows further by this factor of `estimate_after_s` over the time swept.
    pub(super) larger_early: f64,
    /// Share that is still unswept after the floor's area was swept `n` times: `exp(-pace n^slowing)`. That is slower
    /// than for independent points, since robots rarely leave a room and furniture hides floor. Chosen
    /// by hand in simulated homes; the fit is not kept.
    pub(super) pace: f64,
    /// As `pace`.
    pub(super) slowing: f64,
}

pub(super) const LAW: CoverageLaw = CoverageLaw {
    memory_s: 1_200,
    estimate_after_s: 1_200.0,
    floor_m2: 1.0..1_000.0,
    bisections: 24,
    larger: 1.4,
    larger_early: 1.5,
    pace: 0.69,
    slowing: 0.7,
};
