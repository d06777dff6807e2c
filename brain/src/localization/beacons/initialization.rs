//! Batch initialization: solves the first metres at once for the path, the errors of the wheels and the positions of the beacons.
//!
//! It is a least-squares problem (Gauss-Newton) over the poses at the ends of all hops so far, the wheels and the beacons. It runs
//! every few metres until the solution is certain. A straight path cannot tell a beacon from its mirror image, so it needs more
//! hops.

use super::filter::{BeaconFilter, InitialState, WHEELS};
use super::hop::Hop;
use super::multilateration::{MeasuredRange, locate_beacon};
use super::parameters::{BATCH, FILTER};
use super::range_prediction::RangePrediction;
use super::weight::weight;
use crate::localization::skyline::{Factor, Solution, Summation, System};
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::pose_estimate::PoseEstimate;

/// Unknowns of a pose.
const POSE: usize = 3;

/// All motion and ranges since the first beacon was heard.
#[derive(Clone, Debug)]
pub(super) struct BatchInitializer {
    start: PoseEstimate,
    hops: Vec<Hop>,
    length_m: f64,
    next_m: f64,
}

/// The unknowns.
#[derive(Clone, Debug)]
struct BatchState {
    /// The start, then the end of each hop.
    poses: Vec<Pose2>,
    wheels: [f64; WHEELS],
    beacons: Vec<(u16, Point2)>,
}

impl BatchInitializer {
    pub(super) fn new(start: PoseEstimate) -> Self {
        Self {
            start: PoseEstimate {
                sigma_m: start.sigma_m.min(BATCH.start_sigma_max_m),
                sigma_rad: start.sigma_rad.min(BATCH.start_sigma_max_rad),
                ..start
            },
            hops: Vec::new(),
            length_m: 0.0,
            next_m: BATCH.first_m,
        }
    }

    /// Adds a hop. Returns the filter once there is a certain solution.
    pub(super) fn take(&mut self, hop: Hop) -> Option<BeaconFilter> {
        self.length_m += hop.length_m;
        self.hops.push(hop);
        if self.length_m < self.next_m {
            return None;
        }
        self.next_m = self.length_m + BATCH.again_m;
        self.solve()
    }

    /// Whether the path is too long for a solution, so that it should start again.
    pub(super) fn is_hopeless(&self) -> bool {
        self.hops.len() >= BATCH.hops_max
    }

    /// The path by odometry.
    fn poses(&self, wheels: [f64; WHEELS]) -> Vec<Pose2> {
        let mut pose = self.start.pose;
        let mut poses = vec![pose];
        for hop in &self.hops {
            pose = pose * hop.corrected(wheels);
            poses.push(pose);
        }
        poses
    }

    fn solve(&self) -> Option<BeaconFilter> {
        let mut state = self.initial_state()?;
        let mut fit = f64::INFINITY;
        for _ in 0..BATCH.iterations_max {
            let (change, factor, misfit) = self.step(&state)?;
            state.add(&change);
            fit = misfit;
            if change.iter().all(|change| change.abs() < BATCH.converged) {
                return self.answer(&state, &factor, fit);
            }
        }
        let (_, factor, misfit) = self.step(&state)?;
        fit = fit.min(misfit);
        self.answer(&state, &factor, fit)
    }

    fn initial_state(&self) -> Option<BatchState> {
        let poses = self.poses([0.0; WHEELS]);
        let mut numbers: Vec<u16> = self.ranges().map(|(_, range)| range.beacon).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let beacons: Vec<(u16, Point2)> = numbers
            .into_iter()
            .filter_map(|number| {
                let ranges: Vec<MeasuredRange> = self
                    .ranges()
                    .filter(|(_, range)| range.beacon == number)
                    .filter_map(|(hop, range)| {
                        let middle = self.hops.get(hop)?.middle();
                        Some(MeasuredRange {
                            from: poses.get(hop + 1)?.transform(middle),
                            range_m: range.range_m,
                        })
                    })
                    .collect();
                if ranges.len() < BATCH.ranges_min {
                    return None;
                }
                Some((number, locate_beacon(&ranges)?))
            })
            .collect();
        (beacons.len() >= BATCH.beacons_min).then_some(BatchState {
            poses,
            wheels: [0.0; WHEELS],
            beacons,
        })
    }

    /// Index of the hop, and the range.
    fn ranges(&self) -> impl Iterator<Item = (usize, &crate::model::observation::BeaconRange)> {
        self.hops
            .iter()
            .enumerate()
            .flat_map(|(number, hop)| hop.ranges.iter().map(move |range| (number, range)))
    }

    /// One iteration: the step, the factor of its system, and the misfit of the ranges before it.
    fn step(&self, state: &BatchState) -> Option<(Vec<f64>, Factor, f64)> {
        let common = POSE * state.poses.len();
        let unknowns = common + WHEELS + 2 * state.beacons.len();
        let first = (0..unknowns).map(|row| {
            if row < common {
                (row / POSE).saturating_sub(1) * POSE
            } else {
                0
            }
        });
        let mut system = System::new(first.collect(), Summation::InOrder);
        self.measure_start(state, &mut system, common);
        for (number, hop) in self.hops.iter().enumerate() {
            let (from, to) = (state.poses.get(number)?, state.poses.get(number + 1)?);
            let ends = HopEnds {
                from: *from,
                to: *to,
                wheels: state.wheels,
                pose_at: POSE * number,
                wheels_at: common,
            };
            measure_hop(hop, &ends, &mut system);
        }
        let (mut misfit, mut count) = (0.0, 0_u32);
        for (number, range) in self.ranges() {
            let Some(beacon) = state.beacons.iter().position(|known| known.0 == range.beacon) else {
                continue;
            };
            let place = state.beacons.get(beacon)?.1;
            let pose = *state.poses.get(number + 1)?;
            let predicted = RangePrediction::new(pose, self.hops.get(number)?.middle(), place);
            let off = (predicted.away_m - range.range_m) / range.sigma_m;
            let weight = weight(off);
            misfit += weight * off * off;
            count += 1;
            let per = libm::sqrt(weight) / range.sigma_m;
            let at = POSE * (number + 1);
            let beacon_at = common + WHEELS + 2 * beacon;
            measure(
                &mut system,
                libm::sqrt(weight) * off,
                &[
                    (at, per * predicted.by_x),
                    (at + 1, per * predicted.by_y),
                    (at + 2, per * predicted.by_heading),
                    (beacon_at, -per * predicted.by_x),
                    (beacon_at + 1, -per * predicted.by_y),
                ],
            );
        }
        let Solution { values, factor } = at_once(system.solve(&mut StepBudget::unlimited()))?;
        Some((values, factor, libm::sqrt(misfit / f64::from(count.max(1)))))
    }

    fn measure_start(&self, state: &BatchState, system: &mut System, common: usize) {
        let (start, sigma) = (self.start.pose, self.start.sigma_m.max(BATCH.start_sigma_min_m));
        let now = state.poses.first().copied().unwrap_or(start);
        measure(system, (now.x_m - start.x_m) / sigma, &[(0, 1.0 / sigma)]);
        measure(system, (now.y_m - start.y_m) / sigma, &[(1, 1.0 / sigma)]);
        let sigma_rad = self.start.sigma_rad.max(BATCH.start_sigma_min_rad);
        let off_rad = normalize_rad(now.heading_rad - start.heading_rad);
        measure(system, off_rad / sigma_rad, &[(2, 1.0 / sigma_rad)]);
        let sigmas = [
            FILTER.bend_sigma_rad_per_m,
            FILTER.turn_scale_sigma,
            FILTER.distance_scale_sigma,
        ];
        for (number, (value, sigma)) in state.wheels.iter().zip(sigmas).enumerate() {
            measure(system, value / sigma, &[(common + number, 1.0 / sigma)]);
        }
    }

    fn answer(&self, state: &BatchState, factor: &Factor, fit: f64) -> Option<BeaconFilter> {
        // Written so that NaN does not fit.
        let fits = fit <= BATCH.misfit_max;
        if !fits {
            return None;
        }
        let common = POSE * state.poses.len();
        let unknowns = common + WHEELS + 2 * state.beacons.len();
        let kept: Vec<usize> = (common - POSE..unknowns).collect();
        let covariance: Option<Vec<Vec<f64>>> = kept
            .iter()
            .map(|&row| {
                let mut unit = vec![0.0; unknowns];
                if let Some(one) = unit.get_mut(row) {
                    *one = 1.0;
                }
                let column = at_once(factor.solve(unit, &mut StepBudget::unlimited()))?;
                Some(column.get(common - POSE..).unwrap_or_default().to_vec())
            })
            .collect();
        let mut follower = BeaconFilter::begin(InitialState {
            pose: *state.poses.last()?,
            wheels: state.wheels,
            beacons: &state.beacons,
            covariance: covariance?,
        });
        follower.forget_beyond(BATCH.sure_m);
        (follower.places().len() >= BATCH.beacons_min).then_some(follower)
    }
}

impl BatchState {
    fn add(&mut self, change: &[f64]) {
        let (poses, rest) = change.split_at(change.len().min(POSE * self.poses.len()));
        for (pose, change) in self.poses.iter_mut().zip(poses.chunks_exact(POSE)) {
            if let [x, y, heading] = *change {
                pose.x_m += x;
                pose.y_m += y;
                pose.heading_rad = normalize_rad(pose.heading_rad + heading);
            }
        }
        let (wheels, beacons) = rest.split_at(rest.len().min(WHEELS));
        for (value, change) in self.wheels.iter_mut().zip(wheels) {
            *value += change;
        }
        for ((_, place), change) in self.beacons.iter_mut().zip(beacons.chunks_exact(2)) {
            if let [x, y] = *change {
                place.x_m += x;
                place.y_m += y;
            }
        }
    }
}

/// Adds a measurement that is off by so many standard deviations, with its derivatives by the unknowns.
fn measure(system: &mut System, off: f64, derivatives: &[(usize, f64)]) {
    system.add_residual(derivatives, off, 1.0);
}

/// The part of a [`BatchState`] that a hop constrains.
#[derive(Clone, Copy, Debug)]
struct HopEnds {
    from: Pose2,
    to: Pose2,
    wheels: [f64; WHEELS],
    /// Row of the pose at the start in the system; that of the pose at the end comes next.
    pose_at: usize,
    /// Row of the wheels' errors.
    wheels_at: usize,
}

/// Adds the residuals of a hop.
fn measure_hop(hop: &Hop, ends: &HopEnds, system: &mut System) {
    let HopEnds { from, to, .. } = *ends;
    let expected = hop.corrected(ends.wheels);
    let (sin, cos) = libm::sincos(from.heading_rad);
    let (dx, dy) = (to.x_m - from.x_m, to.y_m - from.y_m);
    let (along_m, left_m) = (cos * dx + sin * dy, cos * dy - sin * dx);
    let (by_bend, by_scale) = if hop.by_gyro {
        (0.0, 0.0)
    } else {
        (hop.distance_m, hop.wheel_turn_rad)
    };
    let bent = |of: f64, towards: f64| 0.5 * of * towards;
    let at = ends.pose_at;
    let [bend, scale, stretch] = [0, 1, 2].map(|number| ends.wheels_at + number);
    let per = 1.0 / libm::sqrt(hop.distance_variance_m2);
    measure(
        system,
        per * (along_m - expected.x_m),
        &[
            (at, -per * cos),
            (at + 1, -per * sin),
            (at + 2, per * left_m),
            (at + 3, per * cos),
            (at + 4, per * sin),
            (bend, per * bent(by_bend, expected.y_m)),
            (scale, per * bent(by_scale, expected.y_m)),
            (stretch, -per * hop.step.x_m),
        ],
    );
    // Wheels do not slide sideways. Only the turn within the hop is uncertain.
    let side_m2 = 0.1 * hop.distance_variance_m2 + 0.1 * hop.turn_variance_rad2 * hop.length_m * hop.length_m;
    let per = 1.0 / libm::sqrt(side_m2 + 1e-6);
    measure(
        system,
        per * (left_m - expected.y_m),
        &[
            (at, per * sin),
            (at + 1, -per * cos),
            (at + 2, -per * along_m),
            (at + 3, -per * sin),
            (at + 4, per * cos),
            (bend, -per * bent(by_bend, expected.x_m)),
            (scale, -per * bent(by_scale, expected.x_m)),
            (stretch, -per * hop.step.y_m),
        ],
    );
    let per = 1.0 / libm::sqrt(hop.turn_variance_rad2 + 1e-8);
    let off_rad = normalize_rad(to.heading_rad - from.heading_rad - expected.heading_rad);
    measure(
        system,
        per * off_rad,
        &[
            (at + 2, -per),
            (at + 5, per),
            (bend, -per * by_bend),
            (scale, -per * by_scale),
        ],
    );
}
