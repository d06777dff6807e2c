//! A beacon whose position is estimated.

use super::filter::ERRORS;
use super::hop::HopRange;
use super::parameters::RANGE;
use super::range_prediction::RangePrediction;
use super::weight::weight;
use crate::model::geometry::{Point2, Pose2};

/// Unknowns of a beacon: its position, and by how much its ranges are too long on average.
pub(super) const BEACON: usize = 3;

/// A beacon in the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beacon {
    pub(super) number: u16,
    pub(super) place: Point2,
    /// Its ranges are too long by so much on average, metres: delays of its radio, and walls around it.
    pub(super) bias_m: f64,
    /// Standard deviation of the range error that stays the same around a place, metres.
    pub(super) place_sigma_m: f64,
    /// Share of its latest ranges that the estimate does not explain.
    pub(super) unexplained: f64,
}

/// A range beside what the estimate predicts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovation {
    pub(super) predicted: RangePrediction,
    /// By so much the range is longer, metres.
    pub(super) off_m: f64,
    /// Variance of the range in line of sight.
    pub(super) noise_m2: f64,
}

impl Beacon {
    pub(super) const fn new(number: u16, place: Point2) -> Self {
        Self {
            number,
            place,
            bias_m: 0.0,
            place_sigma_m: RANGE.place_sigma_m,
            unexplained: 0.0,
        }
    }

    /// Compares a range of a hop that ends at `pose`, of a robot with these errors.
    pub(super) fn innovation(&self, pose: Pose2, errors: [f64; ERRORS], range: &HopRange) -> Innovation {
        let [.., antenna_x_m, antenna_y_m] = errors;
        let at = Point2 {
            x_m: range.at.x_m + antenna_x_m,
            y_m: range.at.y_m + antenna_y_m,
        };
        let predicted = RangePrediction::new(pose, at, self.place);
        Innovation {
            predicted,
            off_m: range.range_m - predicted.away_m - self.bias_m,
            noise_m2: range.sigma_m * range.sigma_m + range.repeats * self.place_sigma_m * self.place_sigma_m,
        }
    }

    /// Adds a change of its unknowns.
    pub(super) fn add(&mut self, change: &[f64], share: f64) {
        if let [x, y, bias] = *change {
            self.place.x_m += share * x;
            self.place.y_m += share * y;
            self.bias_m += share * bias;
        }
    }
}

impl Innovation {
    /// Weight of the range, when the prediction itself has this variance.
    pub(super) fn weight(&self, own_m2: f64) -> f64 {
        weight(self.off_m / libm::sqrt(own_m2 + self.noise_m2))
    }
}
