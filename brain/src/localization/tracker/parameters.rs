//! Parameters of Monte Carlo localization over time. They are chosen by hand in simulated homes. Records compare values of `doubt` and of
//! `SEARCH` (second runs in a learned map, and relocalization by signal strength, in `docs/book/src/measurements/archive.md`); of the
//! others none does.

use crate::localization::particles::PoseSpread;

/// When the filter is weighed, when the robot is lost or found, and how far particles are spread.
pub(super) struct TrackingParameters {
    /// The filter is weighed after this distance, metres. More often gives no new information.
    pub(super) weigh_m: f64,
    /// The filter is weighed after this turn, radians, for the same reason.
    pub(super) weigh_rad: f64,
    /// A wrong scale has the same effect in all weighings of a turn. Particles draw independent errors, so theirs must be larger
    /// by this factor.
    pub(super) correlated_scale: f64,
    /// A lost robot is found when this share of its particles is in one narrow cluster.
    pub(super) found_share: f64,
    /// Standard deviation of a narrow cluster, metres.
    pub(super) found_sigma_m: f64,
    /// Distance between the place where people lift the robot and the place where they put it back.
    pub(super) carried: PoseSpread,
    /// Spread of the particles around a candidate pose.
    pub(super) candidate: PoseSpread,
    /// Spread of the particles of a doubtful robot: the error of walls in a map that a robot has drawn. With 0.15 m and 0.12 rad
    /// a robot jumped to other furniture when it touched a leg that the map does not have.
    pub(super) doubt: PoseSpread,
    /// The same for a hypothesis that competes with other storeys. It must not become sure too soon.
    pub(super) competitor_doubt: PoseSpread,
    /// Weighings between two such spreads.
    pub(super) doubt_weighings: u32,
}

pub(super) const TRACKING: TrackingParameters = TrackingParameters {
    weigh_m: 0.05,
    weigh_rad: 0.15,
    correlated_scale: 3.0,
    found_share: 0.9,
    found_sigma_m: 0.2,
    carried: PoseSpread {
        sigma_m: 0.3,
        sigma_rad: 0.5,
    },
    candidate: PoseSpread {
        sigma_m: 0.06,
        sigma_rad: 0.03,
    },
    doubt: PoseSpread {
        sigma_m: 0.04,
        sigma_rad: 0.03,
    },
    competitor_doubt: PoseSpread {
        sigma_m: 0.15,
        sigma_rad: 0.12,
    },
    doubt_weighings: 40,
};

/// When global localization starts.
pub(super) struct SearchSchedule {
    /// The history has this length, metres.
    pub(super) from_m: f64,
    /// It starts again after so many more metres.
    pub(super) every_m: f64,
    /// The same with RSSI fingerprints, which exclude most of the poses that a few metres leave open.
    pub(super) rssi_from_m: f64,
    /// It starts again after so many more metres with RSSI fingerprints.
    pub(super) rssi_every_m: f64,
}

pub(super) const SEARCH: SearchSchedule = SearchSchedule {
    from_m: 4.0,
    every_m: 2.5,
    rssi_from_m: 2.5,
    rssi_every_m: 1.5,
};
