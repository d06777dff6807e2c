//! The filter of a robot that knows the beacons from an earlier run, or knows its place from a map.

use super::{BEACONS, BeaconFilter, ERRORS, POSE};
use crate::localization::beacons::beacon::{BEACON, Beacon};
use crate::localization::beacons::hop::Anchor;
use crate::localization::beacons::parameters::{BATCH, FILTER, KNOWN, RANGE};
use crate::localization::beacons::weight::weight;
use crate::model::geometry::normalize_rad;
use crate::model::known_beacon::KnownBeacon;
use crate::model::pose_estimate::PoseEstimate;

impl BeaconFilter {
    /// Begins between kept beacons, whose places hold exactly: their errors count as errors of the ranges.
    pub(in crate::localization::beacons) fn between(known: &[KnownBeacon], start: PoseEstimate) -> Self {
        let beacons: Vec<Beacon> = known
            .iter()
            .map(|known| Beacon {
                bias_m: known.bias_m,
                place_sigma_m: libm::hypot(known.place_sigma_m.max(KNOWN.place_sigma_min_m), known.sigma_m)
                    .clamp(RANGE.place_sigma_min_m, RANGE.place_sigma_max_m),
                ..Beacon::new(known.number, known.place)
            })
            .collect();
        let mut sigmas = vec![
            start.sigma_m.max(KNOWN.start_sigma_min_m),
            start.sigma_m.max(KNOWN.start_sigma_min_m),
            start.sigma_rad.max(KNOWN.start_sigma_min_rad),
            FILTER.bend_sigma_rad_per_m,
            FILTER.turn_scale_sigma,
            FILTER.distance_scale_sigma,
            FILTER.antenna_sigma_m,
            FILTER.antenna_sigma_m,
        ];
        for _ in known {
            sigmas.extend([0.0, 0.0, KNOWN.bias_sigma_m]);
        }
        let count = sigmas.len();
        let covariance = sigmas
            .into_iter()
            .enumerate()
            .map(|(number, sigma)| {
                let mut row = vec![0.0; count];
                if let Some(own) = row.get_mut(number) {
                    *own = sigma * sigma;
                }
                row
            })
            .collect();
        Self {
            pose: start.pose,
            errors: [0.0; ERRORS],
            beacons,
            covariance,
            unexplained: 0.0,
            slips: 0,
            late: Vec::new(),
            left_out: None,
        }
    }

    /// The located beacons, as an earlier run leaves them to the next one: with the errors that they have beside the map, for the map
    /// has those of the pose too.
    pub(in crate::localization::beacons) fn known(&self) -> Vec<KnownBeacon> {
        let seen = self.seen_from_pose();
        seen.beacons
            .iter()
            .enumerate()
            .map(|(number, beacon)| KnownBeacon {
                number: beacon.number,
                place: beacon.place,
                bias_m: beacon.bias_m,
                sigma_m: seen.widest_m(BEACONS + BEACON * number),
                place_sigma_m: beacon.place_sigma_m,
            })
            .filter(|known| known.sigma_m <= BATCH.sure_m && known.is_possible())
            .collect()
    }

    /// Takes the pose that a map gives.
    pub(super) fn compare_with_map(&mut self, anchor: &Anchor) {
        for place in 0..POSE {
            let (off, sigma) = match place {
                0 => (anchor.pose.x_m - self.pose.x_m, anchor.sigma_m),
                1 => (anchor.pose.y_m - self.pose.y_m, anchor.sigma_m),
                _ => (
                    normalize_rad(anchor.pose.heading_rad - self.pose.heading_rad),
                    anchor.sigma_rad,
                ),
            };
            let gains = self.covariance.get(place).cloned().unwrap_or_default();
            let own = self.at(place, place);
            let noise = sigma * sigma;
            let variance = own + noise / weight(off / libm::sqrt(own + noise));
            self.correct(&gains, off / variance);
            self.shrink(&gains, variance);
        }
    }

    /// Forgets a beacon whose ranges contradict the others for long: somebody has moved it. It is located anew. Gives its number.
    pub(in crate::localization::beacons) fn forget_moved(&mut self) -> Option<u16> {
        let count = self.beacons.len();
        if count < KNOWN.others_min {
            return None;
        }
        let all: f64 = self.beacons.iter().map(|beacon| beacon.unexplained).sum();
        let is_moved = |beacon: &Beacon| {
            let others = (all - beacon.unexplained) / (count as f64 - 1.0);
            beacon.unexplained > KNOWN.moved_share && others < KNOWN.others_share
        };
        let index = self.beacons.iter().position(is_moved)?;
        let number = self.beacons.get(index)?.number;
        self.forget(index);
        Some(number)
    }

    /// How often ranges contradicted the estimate until it was given up.
    pub(in crate::localization::beacons) const fn slips(&self) -> u32 {
        self.slips
    }
}
