//! How sure a pose is that comes from the dock, from a person or from a map.

/// Standard deviations of given poses.
pub(super) struct PlacingParameters {
    /// Standard deviation of a position on the dock, metres: the dock is wider than the robot's contacts.
    pub(super) dock_sigma_m: f64,
    /// Standard deviation of a heading on the dock, radians.
    pub(super) dock_sigma_rad: f64,
    /// Standard deviation of a position that a person has pointed out, metres.
    pub(super) person_sigma_m: f64,
    /// Standard deviation of a heading that a person has pointed out, radians.
    pub(super) person_sigma_rad: f64,
    /// Standard deviation of a position in a map that a robot has drawn, against the home, metres: walls of such maps are wrong by 3 to
    /// 4 cm. It is part of what is told, not of what the filter works with.
    pub(super) map_sigma_m: f64,
    /// Greatest standard deviation that is accepted, metres or radians.
    pub(super) sigma_max: f64,
    /// A given position that is closer than this to the present one does not reset the filter, metres.
    pub(super) same_m: f64,
    /// A given heading that is closer than this to the present one does not reset the filter, radians.
    pub(super) same_rad: f64,
    /// A pose with a smaller standard deviation than this may be used as a reference, metres.
    pub(super) confirmed_sigma_m: f64,
    /// The map must explain this share of the sensor readings for what they show to be learnt: as for holding what the filter has learnt.
    pub(super) trusted_explained: f64,
}

pub(super) const PLACING: PlacingParameters = PlacingParameters {
    dock_sigma_m: 0.02,
    dock_sigma_rad: 0.03,
    person_sigma_m: 0.3,
    person_sigma_rad: 0.4,
    map_sigma_m: 0.025,
    sigma_max: 1.0,
    same_m: 0.05,
    same_rad: 0.05,
    confirmed_sigma_m: 0.15,
    trusted_explained: 0.75,
};
