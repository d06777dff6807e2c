//! Numbers of drives over known floor. They were measured in the simulated homes (`cargo xtask bench docking`).

/// The path by the map.
pub(super) struct TravelParameters {
    /// Gaps between the body and known obstacles on planned paths, metres, the widest first, since docking is in no
    /// hurry. With the last one cells of the map may lie under the rim: a passage that is hardly wider than the body is
    /// one cell too narrow on the map.
    pub(super) clearances_m: [f64; 3],
    /// The same on the way back to where the robot has been, metres. It fits through there, and the map of that place
    /// was drawn with a pose that has drifted since.
    pub(super) clearances_back_m: [f64; 5],
    /// Nearer to the dock than this the robot searches for its beams instead of opening unknown floor, metres.
    pub(super) by_beams_m: f64,
    /// Farther from the robot than this no path over opened floor begins, metres.
    pub(super) set_out_max_m: f64,
    /// Distances from the dock at which the approach by beams begins, metres: the best one first.
    pub(super) front_m: [f64; 6],
    /// Sideways offsets from the centreline, metres.
    pub(super) beside_m: [f64; 5],
    /// Detour per metre that a place beside the centreline counts more than one on it.
    pub(super) beside_detour: f64,
    /// The same per metre of distance from the best place in front of the dock.
    pub(super) front_detour: f64,
    /// Difference between two neighbours in `front_m` for that purpose, metres.
    pub(super) front_step_m: f64,
    /// Distance to back off after a contact, metres.
    pub(super) contact_back_m: f64,
    /// What each plan without progress adds to it, metres.
    pub(super) more_back_m: f64,
    /// Nearer than this to the start of the last plan, that plan made no progress, metres.
    pub(super) progress_min_m: f64,
    /// Plans without progress in a row until the path counts as blocked.
    pub(super) failed_plans_max: u32,
    /// Plans in total until the path counts as blocked.
    pub(super) plans_max: u32,
    /// Times that obstructions are forgotten.
    pub(super) forget_max: u32,
    /// Distances from a place that a person names at which the robot is there as well, metres: the nearest first.
    pub(super) near_m: [f64; 4],
    /// Directions in which such places are looked for.
    pub(super) near_directions: u32,
    /// Detour per metre that such a place counts more than the one that was named.
    pub(super) near_detour: f64,
}

pub(super) const TRAVEL: TravelParameters = TravelParameters {
    clearances_m: [0.05, 0.01, -0.015],
    clearances_back_m: [0.05, 0.01, -0.015, -0.05, -0.09],
    by_beams_m: 3.0,
    set_out_max_m: 0.4,
    front_m: [1.1, 1.3, 0.9, 0.75, 0.6, 0.5],
    beside_m: [0.0, 0.12, -0.12, 0.25, -0.25],
    beside_detour: 6.0,
    front_detour: 1.5,
    front_step_m: 0.2,
    contact_back_m: 0.03,
    more_back_m: 0.02,
    progress_min_m: 0.15,
    failed_plans_max: 6,
    plans_max: 40,
    forget_max: 2,
    near_m: [0.12, 0.25, 0.4, 0.6],
    near_directions: 12,
    near_detour: 20.0,
};
