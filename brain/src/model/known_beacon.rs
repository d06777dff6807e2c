//! Radio beacons whose places are known from earlier runs.

use super::geometry::Point2;

/// Most beacons of a home.
pub const KNOWN_BEACONS_MAX: usize = 8;
/// Farthest from the origin of the map, metres.
const FAR_M: f64 = 1_000.0;
/// Greatest bias and greatest standard deviations, metres.
const BIAS_MAX_M: f64 = 10.0;
const SIGMA_MAX_M: f64 = 10.0;

/// A radio beacon with its place in the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownBeacon {
    /// Its number, the same in each run.
    pub number: u16,
    /// Where it is.
    pub place: Point2,
    /// By so much its ranges are too long on average, metres.
    pub bias_m: f64,
    /// Standard deviation of its place along the worst direction, metres.
    pub sigma_m: f64,
    /// Standard deviation of the range error that stays the same around a place, metres.
    pub place_sigma_m: f64,
}

impl KnownBeacon {
    /// Whether a home can have such a beacon. Written so that NaN is none.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        let is_sigma = |sigma_m: f64| (0.0..=SIGMA_MAX_M).contains(&sigma_m);
        self.place.x_m.abs() <= FAR_M
            && self.place.y_m.abs() <= FAR_M
            && self.bias_m.abs() <= BIAS_MAX_M
            && is_sigma(self.sigma_m)
            && is_sigma(self.place_sigma_m)
    }
}
