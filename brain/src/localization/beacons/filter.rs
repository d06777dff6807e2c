//! An extended Kalman filter over the pose, the errors of the wheels and the positions of the beacons.

mod known;

use super::beacon::{BEACON, Beacon};
use super::hop::{Hop, HopRange};
use super::located_range::LocatedRange;
use super::multilateration::{MeasuredRange, locate_beacon};
use super::parameters::{FILTER, KNOWN, RANGE, SLIP};
use super::weight::robust_square;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::pose_estimate::PoseEstimate;

/// Parameters of the wheels' errors: curvature of a straight path in radians a metre, scale error of turns, scale error of
/// distances, both relative.
pub(super) const ERRORS: usize = 5;
/// Numbers of the pose.
const POSE: usize = 3;
/// Index of the antenna's place in the state.
const ANTENNA: usize = POSE + ERRORS - 2;
/// Index of the first beacon in the state.
const BEACONS: usize = POSE + ERRORS;

/// Result of the batch initialization.
#[derive(Debug)]
pub(super) struct InitialState<'batch> {
    pub(super) pose: Pose2,
    pub(super) errors: [f64; ERRORS],
    pub(super) beacons: &'batch [Beacon],
    /// Of pose, wheels and beacons, in this order.
    pub(super) covariance: Vec<Vec<f64>>,
}

/// How badly ranges were predicted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Misfit {
    /// Sum of their robust squares.
    pub(super) sum: f64,
    /// Number of ranges.
    pub(super) count: u32,
}

impl Misfit {
    fn add(&mut self, robust_square: f64) {
        self.sum += robust_square;
        self.count += 1;
    }
}

/// The filter.
#[derive(Clone, Debug)]
pub(super) struct BeaconFilter {
    pose: Pose2,
    errors: [f64; ERRORS],
    beacons: Vec<Beacon>,
    covariance: Vec<Vec<f64>>,
    /// Share of the latest ranges that the estimate does not explain.
    unexplained: f64,
    /// How often that was so many that the pose counted as unknown.
    slips: u32,
    /// Ranges to beacons that are not located yet.
    late: Vec<(u16, MeasuredRange)>,
    /// A beacon that was left out; the errors of its ranges stay its own when it is located anew.
    left_out: Option<Beacon>,
}

impl BeaconFilter {
    pub(super) fn begin(start: InitialState<'_>) -> Self {
        Self {
            pose: start.pose,
            errors: start.errors,
            beacons: start.beacons.to_vec(),
            covariance: start.covariance,
            unexplained: 0.0,
            slips: 0,
            late: Vec::new(),
            left_out: None,
        }
    }

    /// Drops the beacons whose positions, seen from the robot, have a larger standard deviation than this, metres. How the robot and
    /// all beacons together lie to the start of the path does not count: it harms no map that is drawn from now on.
    pub(super) fn forget_beyond(&mut self, sigma_m: f64) {
        let mut number = 0;
        while number < self.beacons.len() {
            let at = BEACONS + BEACON * number;
            if self.seen_from_pose().widest_m(at) <= sigma_m {
                number += 1;
                continue;
            }
            self.forget(number);
        }
    }

    /// Drops a beacon by its index.
    fn forget(&mut self, number: usize) {
        let at = BEACONS + BEACON * number;
        self.beacons.remove(number);
        let is_kept = |place: usize| !(at..at + BEACON).contains(&place);
        let mut place = 0..;
        self.covariance.retain(|_| place.next().is_some_and(is_kept));
        for row in &mut self.covariance {
            let mut place = 0..;
            row.retain(|_| place.next().is_some_and(is_kept));
        }
    }

    /// The same filter with a pose that is known exactly.
    fn seen_from_pose(&self) -> Self {
        let mut known = self.clone();
        for place in 0..POSE {
            let own = known.at(place, place);
            let gains = known.covariance.get(place).cloned().unwrap_or_default();
            if own > 0.0 {
                known.shrink(&gains, own);
            }
        }
        known
    }

    /// Takes away what a measurement with these gains and this variance tells.
    fn shrink(&mut self, gains: &[f64], variance: f64) {
        for (row, gain) in self.covariance.iter_mut().zip(gains) {
            for (value, other) in row.iter_mut().zip(gains) {
                *value -= gain * other / variance;
            }
        }
    }

    /// Leaves a beacon out that may have been moved, and locates it anew.
    pub(super) fn leave_out(&mut self, number: usize) {
        self.left_out = self.beacons.get(number).copied();
        self.forget(number);
    }

    /// A beacon of which nothing but the errors of its ranges is known, if these are.
    fn unlocated(&self, number: u16) -> Beacon {
        let known = self.left_out.filter(|left_out| left_out.number == number);
        known.unwrap_or_else(|| Beacon::new(number, Point2 { x_m: 0.0, y_m: 0.0 }))
    }

    pub(super) fn index_of(&self, beacon: u16) -> Option<usize> {
        self.beacons.iter().position(|known| known.number == beacon)
    }

    /// Predicts the motion of a hop and updates with its ranges. Gives how badly it had predicted them.
    pub(super) fn take(&mut self, hop: &Hop) -> Misfit {
        let mut misfit = Misfit::default();
        self.advance(hop);
        if let Some(anchor) = &hop.anchor {
            self.compare_with_map(anchor);
        }
        self.watch_slip(hop);
        for range in &hop.ranges {
            match self.index_of(range.beacon) {
                Some(beacon) => misfit.add(self.compare(range, beacon)),
                None => self.keep(
                    range.beacon,
                    MeasuredRange {
                        from: self.pose.transform(range.at),
                        range_m: range.range_m - self.unlocated(range.beacon).bias_m,
                    },
                ),
            }
        }
        misfit
    }

    /// When hop after hop most ranges contradict the estimate, the wheels have slipped or something pushed the robot: single wrong
    /// ranges do not agree for so long. Then the pose may be far off, so that the next ranges count fully.
    fn watch_slip(&mut self, hop: &Hop) {
        for range in &hop.ranges {
            let Some(number) = self.index_of(range.beacon) else {
                continue;
            };
            let Some(known) = self.beacons.get(number) else {
                continue;
            };
            let innovation = known.innovation(self.pose, self.errors, range);
            let at = BEACONS + BEACON * number;
            let own_m2 = libm::pow(self.widest_m(0), 2.0) + libm::pow(self.widest_m(at), 2.0);
            let is_far = innovation.off_m.abs() > SLIP.far_sigmas * libm::sqrt(own_m2 + innovation.noise_m2);
            let far = f64::from(u8::from(is_far));
            self.unexplained += SLIP.share * (far - self.unexplained);
            if let Some(known) = self.beacons.get_mut(number) {
                known.unexplained += KNOWN.share * (far - known.unexplained);
            }
        }
        if self.unexplained > SLIP.unexplained_max {
            self.unexplained = 0.0;
            self.slips = self.slips.saturating_add(1);
            self.grow(0, 0, SLIP.sigma_m * SLIP.sigma_m);
            self.grow(1, 1, SLIP.sigma_m * SLIP.sigma_m);
            self.grow(2, 2, SLIP.sigma_rad * SLIP.sigma_rad);
        }
    }

    fn advance(&mut self, hop: &Hop) {
        let step = hop.corrected(self.errors);
        let (sin, cos) = libm::sincos(self.pose.heading_rad);
        let (dx, dy) = (cos * step.x_m - sin * step.y_m, sin * step.x_m + cos * step.y_m);
        let (by_bend, by_scale) = hop.turn_by_errors();
        self.pose = Pose2 {
            x_m: self.pose.x_m + dx,
            y_m: self.pose.y_m + dy,
            heading_rad: normalize_rad(self.pose.heading_rad + step.heading_rad),
        };
        // Derivatives of the pose by the previous heading, curvature, scale and stretch.
        let (turn_x, turn_y) = (-dy, dx);
        let rows: [&[(usize, f64)]; POSE] = [
            &[
                (2, turn_x),
                (3, 0.5 * by_bend * turn_x),
                (4, 0.5 * by_scale * turn_x),
                (5, dx),
            ],
            &[
                (2, turn_y),
                (3, 0.5 * by_bend * turn_y),
                (4, 0.5 * by_scale * turn_y),
                (5, dy),
            ],
            &[(3, by_bend), (4, by_scale)],
        ];
        self.propagate(rows);
        let side_m2 = 0.1 * hop.distance_variance_m2;
        let half_rad2 = 0.5 * hop.turn_variance_rad2;
        self.grow(
            0,
            0,
            cos * cos * hop.distance_variance_m2 + sin * sin * side_m2 + 0.5 * half_rad2 * turn_x * turn_x,
        );
        self.grow(
            1,
            1,
            sin * sin * hop.distance_variance_m2 + cos * cos * side_m2 + 0.5 * half_rad2 * turn_y * turn_y,
        );
        let both_m2 = cos * sin * (hop.distance_variance_m2 - side_m2) + 0.5 * half_rad2 * turn_x * turn_y;
        self.grow(0, 1, both_m2);
        self.grow(1, 0, both_m2);
        self.grow(2, 2, hop.turn_variance_rad2);
        for (place, turned) in [(0, turn_x), (1, turn_y)] {
            self.grow(place, 2, half_rad2 * turned);
            self.grow(2, place, half_rad2 * turned);
        }
        for (number, walk) in FILTER.errors_walk.into_iter().enumerate() {
            self.grow(POSE + number, POSE + number, walk * walk * hop.length_m);
        }
    }

    /// `covariance = F covariance F'` for an F that is 1 on its diagonal and has these entries beside it.
    fn propagate(&mut self, rows: [&[(usize, f64)]; POSE]) {
        let before = self.covariance.clone();
        for (number, entries) in rows.iter().enumerate() {
            let Some(row) = self.covariance.get_mut(number) else {
                continue;
            };
            for (from, factor) in entries.iter() {
                for (value, other) in row
                    .iter_mut()
                    .zip(before.get(*from).map_or(&[][..], Vec::as_slice))
                {
                    *value += factor * other;
                }
            }
        }
        for row in &mut self.covariance {
            let before = row.clone();
            for (number, entries) in rows.iter().enumerate() {
                let Some(value) = row.get_mut(number) else {
                    continue;
                };
                for (from, factor) in entries.iter() {
                    *value += factor * before.get(*from).copied().unwrap_or(0.0);
                }
            }
        }
    }

    fn grow(&mut self, row: usize, column: usize, by: f64) {
        if let Some(value) = self.covariance.get_mut(row).and_then(|row| row.get_mut(column)) {
            *value += by;
        }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.covariance
            .get(row)
            .and_then(|row| row.get(column))
            .copied()
            .unwrap_or(0.0)
    }

    /// Updates with a range. Gives how badly it was predicted.
    fn compare(&mut self, range: &HopRange, beacon: usize) -> f64 {
        let Some(known) = self.beacons.get(beacon).copied() else {
            return 0.0;
        };
        let innovation = known.innovation(self.pose, self.errors, range);
        let predicted = innovation.predicted;
        let at = BEACONS + BEACON * beacon;
        let by = [
            (0, predicted.by_x),
            (1, predicted.by_y),
            (2, predicted.by_heading),
            (ANTENNA, predicted.by_antenna[0]),
            (ANTENNA + 1, predicted.by_antenna[1]),
            (at, -predicted.by_x),
            (at + 1, -predicted.by_y),
            (at + 2, 1.0),
        ];
        let gains: Vec<f64> = self
            .covariance
            .iter()
            .map(|row| {
                by.iter()
                    .map(|(place, by)| row.get(*place).unwrap_or(&0.0) * by)
                    .sum()
            })
            .collect();
        let own_m2: f64 = by
            .iter()
            .map(|(place, by)| gains.get(*place).copied().unwrap_or(0.0) * by)
            .sum();
        let variance_m2 = own_m2 + innovation.noise_m2 / innovation.weight(own_m2);
        self.correct(&gains, innovation.off_m / variance_m2);
        self.shrink(&gains, variance_m2);
        robust_square(innovation.off_m / libm::sqrt(own_m2 + innovation.noise_m2))
    }

    fn correct(&mut self, gains: &[f64], by: f64) {
        let (own, beacons) = gains.split_at(gains.len().min(BEACONS));
        if let [x, y, heading, errors @ ..] = own {
            self.pose = Pose2 {
                x_m: self.pose.x_m + x * by,
                y_m: self.pose.y_m + y * by,
                heading_rad: normalize_rad(self.pose.heading_rad + heading * by),
            };
            for (value, gain) in self.errors.iter_mut().zip(errors) {
                *value += gain * by;
            }
        }
        for (beacon, gain) in self.beacons.iter_mut().zip(beacons.chunks_exact(BEACON)) {
            beacon.add(gain, by);
        }
    }

    /// Stores a range to an unknown beacon, until its ranges locate it.
    fn keep(&mut self, beacon: u16, ranged: MeasuredRange) {
        if self.beacons.len() >= RANGE.beacons_max {
            return;
        }
        self.late.push((beacon, ranged));
        let of_it: Vec<MeasuredRange> = self
            .late
            .iter()
            .filter(|late| late.0 == beacon)
            .map(|late| late.1)
            .collect();
        if of_it.len() < FILTER.late_ranges {
            return;
        }
        self.late.retain(|late| late.0 != beacon);
        if let Some(place) = locate_beacon(&of_it) {
            self.add_beacon(beacon, place);
        }
    }

    /// Adds a beacon to the state. Its position has the error of the pose and an error of its own.
    fn add_beacon(&mut self, beacon: u16, place: Point2) {
        self.beacons.push(Beacon {
            place,
            unexplained: 0.0,
            ..self.unlocated(beacon)
        });
        for row in &mut self.covariance {
            let (x, y) = (row.first().copied(), row.get(1).copied());
            row.extend([x.unwrap_or(0.0), y.unwrap_or(0.0), 0.0]);
        }
        for from in [0, 1] {
            let row = self.covariance.get(from).cloned().unwrap_or_default();
            self.covariance.push(row);
        }
        let at = self.covariance.len();
        self.covariance.push(vec![0.0; at + 1]);
        for number in [at.saturating_sub(2), at.saturating_sub(1)] {
            self.grow(number, number, FILTER.late_sigma_m * FILTER.late_sigma_m);
        }
        self.grow(at, at, FILTER.bias_sigma_m * FILTER.bias_sigma_m);
    }

    /// Another estimator gives the pose.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        self.pose = pose;
        for number in 0..POSE {
            for other in 0..self.covariance.len() {
                let (down, across) = (self.at(number, other), self.at(other, number));
                self.grow(number, other, -down);
                if other != number {
                    self.grow(other, number, -across);
                }
            }
        }
        for (number, sigma) in [
            FILTER.placed_sigma_m,
            FILTER.placed_sigma_m,
            FILTER.placed_sigma_rad,
        ]
        .into_iter()
        .enumerate()
        {
            self.grow(number, number, sigma * sigma);
        }
    }

    pub(super) fn estimate(&self) -> PoseEstimate {
        PoseEstimate {
            pose: self.pose,
            sigma_m: self.widest_m(0),
            sigma_rad: libm::sqrt(self.at(2, 2).max(0.0)),
            ..PoseEstimate::default()
        }
    }

    /// Standard deviation along the worst direction of the position at index `at`.
    fn widest_m(&self, at: usize) -> f64 {
        let (xx, yy, xy) = (self.at(at, at), self.at(at + 1, at + 1), self.at(at, at + 1));
        let half = 0.5 * (xx - yy);
        libm::sqrt((0.5 * (xx + yy) + libm::sqrt(half * half + xy * xy)).max(0.0))
    }

    /// Number, position and standard deviation of each located beacon.
    pub(super) fn places(&self) -> Vec<(u16, Point2, f64)> {
        self.beacons
            .iter()
            .enumerate()
            .map(|(number, beacon)| {
                (
                    beacon.number,
                    beacon.place,
                    self.widest_m(BEACONS + BEACON * number),
                )
            })
            .collect()
    }

    /// Ranges of a hop to located beacons, for the particle filter.
    pub(super) fn locate_ranges(&self, hop: &Hop, located_ranges: &mut Vec<LocatedRange>) {
        located_ranges.extend(hop.ranges.iter().filter_map(|range| {
            let number = self.index_of(range.beacon)?;
            let beacon = self.beacons.get(number)?;
            let at = BEACONS + BEACON * number;
            let known_m2 = libm::pow(self.widest_m(at), 2.0) + self.at(at + 2, at + 2);
            let place_m2 = beacon.place_sigma_m * beacon.place_sigma_m;
            Some(LocatedRange {
                at: beacon.place,
                range_m: range.range_m - beacon.bias_m,
                sigma_m: libm::sqrt(range.sigma_m * range.sigma_m + place_m2 + known_m2)
                    .max(RANGE.told_sigma_min_m),
            })
        }));
    }
}
