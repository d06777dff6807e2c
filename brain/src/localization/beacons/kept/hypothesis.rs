//! One hypothesis of where the robot is, and of which beacon was moved.

use super::parameters::{DOUBT, HYPOTHESIS, MOVED, SEARCH};
use crate::localization::beacons::filter::BeaconFilter;
use crate::localization::beacons::hop::Hop;
use crate::localization::beacons::parameters::BATCH;
use crate::model::geometry::{Point2, Pose2};
use crate::model::known_beacon::KnownBeacon;

/// A filter, and how well it explains the ranges.
#[derive(Clone, Debug)]
pub(super) struct PlaceHypothesis {
    pub(super) filter: BeaconFilter,
    /// The beacon that was moved if this holds. The filter locates it anew.
    pub(super) left_out: Option<LeftOutBeacon>,
    /// Sum of the robust squares of its deviations; those of long ago count less.
    pub(super) cost: f64,
    /// Mean robust square of the latest ranges.
    pub(super) lately: f64,
    slips: u32,
}

/// A kept beacon that a hypothesis says was moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeftOutBeacon {
    pub(super) number: u16,
    /// Where it was, and the standard deviation of that in metres.
    place: Point2,
    sigma_m: f64,
}

impl PlaceHypothesis {
    pub(super) fn new(filter: BeaconFilter, cost: f64) -> Self {
        Self {
            slips: filter.slips(),
            filter,
            left_out: None,
            cost,
            lately: HYPOTHESIS.usual,
        }
    }

    /// The same pose, if this beacon was moved.
    pub(super) fn without(filter: &BeaconFilter, known: &KnownBeacon) -> Option<Self> {
        let mut filter = filter.clone();
        filter.leave_out(filter.index_of(known.number)?);
        Some(Self {
            left_out: Some(LeftOutBeacon {
                number: known.number,
                place: known.place,
                sigma_m: known.sigma_m.max(MOVED.sigma_min_m),
            }),
            ..Self::new(filter, 0.0)
        })
    }

    /// Takes a hop.
    pub(super) fn take(&mut self, hop: &Hop) {
        let is_unlocated = |number: u16| {
            self.left_out.is_some_and(|left_out| left_out.number == number)
                && self.filter.index_of(number).is_none()
        };
        let unlocated = hop
            .ranges
            .iter()
            .filter(|range| is_unlocated(range.beacon))
            .count();
        let misfit = self.filter.take(hop);
        if misfit.count > 0 {
            let mean = misfit.sum / f64::from(misfit.count);
            let share = 1.0 - libm::pow(1.0 - HYPOTHESIS.lately_share, f64::from(misfit.count));
            self.lately += share * (mean - self.lately);
        }
        let slips = self.filter.slips().saturating_sub(self.slips);
        self.slips = self.filter.slips();
        self.cost = HYPOTHESIS.decay * self.cost
            + misfit.sum
            + HYPOTHESIS.usual * unlocated as f64
            + HYPOTHESIS.slip_cost * f64::from(slips);
    }

    /// Another estimator gives the pose.
    pub(super) fn restart_at(&mut self, pose: Pose2) {
        self.filter.place_at(pose);
        self.cost = 0.0;
        self.lately = HYPOTHESIS.usual;
    }

    /// Whether position and heading are known.
    pub(super) fn is_sure(&self) -> bool {
        let estimate = self.filter.estimate();
        estimate.sigma_m <= SEARCH.sure_m && estimate.sigma_rad <= SEARCH.sure_rad
    }

    /// How far the beacon that was left out is from where it was, once it is located.
    pub(super) fn displacement(&self) -> Option<Displacement> {
        let LeftOutBeacon {
            number,
            place,
            sigma_m,
        } = self.left_out?;
        let (_, now, now_sigma_m) = self
            .filter
            .places()
            .into_iter()
            .find(|located| located.0 == number)?;
        let is_located = now_sigma_m <= BATCH.sure_m && self.lately <= DOUBT.lately_max;
        let away_m = now.distance_m(place);
        is_located.then_some(Displacement {
            away_m,
            sigmas: away_m / libm::hypot(sigma_m, now_sigma_m),
        })
    }
}

/// Distance between two places of a beacon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displacement {
    away_m: f64,
    /// The same in standard deviations.
    sigmas: f64,
}

impl Displacement {
    /// Whether that is more than errors explain.
    pub(super) fn is_sure(self) -> bool {
        self.away_m >= MOVED.away_m && self.sigmas >= MOVED.away_sigmas
    }

    /// Whether another beacon hardly has one beside this.
    pub(super) fn outweighs(self, other: Option<Self>) -> bool {
        other.is_some_and(|other| other.sigmas <= MOVED.others_share * self.sigmas)
    }
}
