//! Smoother: solves the whole path so far at once for its poses, the errors of the robot and the positions of the beacons.
//!
//! It is range-only SLAM as a least-squares problem over the whole path, as of Newman and Leonard (Pure Range-Only Sub-Sea SLAM, 2003),
//! solved by Gauss-Newton with robust weights, in steps. It runs every few metres: first until the solution is certain, then again on
//! the longer path, since ranges that come later tell how the first metres went. A straight path cannot tell a beacon from its mirror
//! image, so it needs more hops.

use core::task::Poll;

use super::beacon::{BEACON, Beacon};
use super::filter::{BeaconFilter, ERRORS, InitialState};
use super::hop::{Anchor, Hop, HopRange};
use super::multilateration::{MeasuredRange, locate_beacon};
use super::parameters::{BATCH, FILTER, RANGE, REDRAW};
use super::weight::weight;
use crate::localization::skyline::{Factor, Solution, Summation, System};
use crate::mapping::Keyframe;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::gradual::{Gradual, StepBudget};
use crate::model::pose_estimate::PoseEstimate;

/// Work of adding a hop and a range to the system.
const HOP_WORK: usize = 400;
const RANGE_WORK: usize = 250;
/// Unknowns of a pose.
const POSE: usize = 3;

/// All motion and ranges since the first beacon was heard.
#[derive(Debug)]
pub(super) struct BatchSmoother {
    start: PoseEstimate,
    hops: Vec<Hop>,
    length_m: f64,
    next_m: f64,
    /// The last solution.
    solved: Option<BatchState>,
    solving: Option<Gradual<Option<BatchSolution>>>,
}

/// What is solved: the path so far.
#[derive(Debug)]
struct BatchProblem {
    start: PoseEstimate,
    hops: Vec<Hop>,
    solved: Option<BatchState>,
}

/// A solution, and the filter that goes on from there.
#[derive(Debug)]
struct BatchSolution {
    state: BatchState,
    filter: BeaconFilter,
}

/// The unknowns.
#[derive(Clone, Debug)]
struct BatchState {
    /// The start, then the end of each hop.
    poses: Vec<Pose2>,
    errors: [f64; ERRORS],
    beacons: Vec<Beacon>,
}

impl BatchSmoother {
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
            solved: None,
            solving: None,
        }
    }

    /// Adds a hop, and begins a solution when it is time.
    pub(super) fn take(&mut self, hop: Hop) {
        self.length_m += hop.length_m;
        self.hops.push(hop);
        if self.length_m < self.next_m || self.solving.is_some() {
            return;
        }
        self.next_m = self.length_m + BATCH.again_m.max(BATCH.again_share * self.length_m);
        let problem = BatchProblem {
            start: self.start,
            hops: self.hops.clone(),
            solved: self.solved.clone(),
        };
        self.solving = Some(Gradual::new(problem.solve(StepBudget::short())));
    }

    /// Whether a solved path is so long that it is not solved again.
    pub(super) fn is_long(&self) -> bool {
        self.hops.len() >= BATCH.smoothed_max
    }

    /// Whether the path is too long for a solution, so that it should start again.
    pub(super) fn is_hopeless(&self) -> bool {
        self.hops.len() >= BATCH.hops_max
    }

    /// The poses of the path so far by the last solution, if they differ from those at which the map was drawn; from now on it counts as
    /// drawn at them.
    pub(super) fn redraw(&mut self) -> Option<Vec<Keyframe>> {
        let solved = self.solved.as_ref()?;
        let ends = || self.hops.iter().zip(solved.poses.iter().skip(1));
        let (mut squares_m2, mut count) = (0.0, 0_u32);
        for (hop, pose) in ends() {
            squares_m2 += libm::pow(hop.end.drawn.position().distance_m(pose.position()), 2.0);
            count += 1;
        }
        if squares_m2 < REDRAW.change_m * REDRAW.change_m * f64::from(count.max(1)) {
            return None;
        }
        let keyframes = ends()
            .step_by(REDRAW.hops)
            .map(|(hop, pose)| Keyframe {
                time_us: hop.end.time_us,
                odom_from_base: hop.end.odom,
                map_from_base: *pose,
            })
            .collect();
        for (hop, pose) in self.hops.iter_mut().zip(solved.poses.iter().skip(1)) {
            hop.end.drawn = *pose;
        }
        Some(keyframes)
    }

    /// Does the next step of a solution in progress. Returns the filter once it is there and certain.
    pub(super) fn go_on(&mut self) -> Option<BeaconFilter> {
        let Poll::Ready(solution) = self.solving.as_mut()?.go_on() else {
            return None;
        };
        self.solving = None;
        let BatchSolution { state, mut filter } = solution?;
        // What was driven while it was computed.
        for hop in self.hops.get(state.poses.len().saturating_sub(1)..)? {
            filter.take(hop);
        }
        self.solved = Some(state);
        Some(filter)
    }
}

impl BatchProblem {
    async fn solve(self, mut budget: StepBudget) -> Option<BatchSolution> {
        let mut state = self.initial_state()?;
        budget.pause().await;
        for _ in 0..BATCH.iterations_max {
            let (change, ..) = self.step(&state, &mut budget).await?;
            state.add(&change);
            if change.iter().all(|change| change.abs() < BATCH.converged) {
                break;
            }
        }
        let (_, factor, misfit) = self.step(&state, &mut budget).await?;
        let filter = self.answer(&state, (factor, misfit), &mut budget).await?;
        self.learn_noise(&mut state);
        Some(BatchSolution { state, filter })
    }

    /// The last solution, continued by odometry, and beacons that can be located since.
    fn initial_state(&self) -> Option<BatchState> {
        let mut state = match &self.solved {
            Some(solved) => solved.clone(),
            None => BatchState {
                poses: vec![self.start.pose],
                errors: [0.0; ERRORS],
                beacons: Vec::new(),
            },
        };
        let mut pose = *state.poses.last()?;
        for hop in self.hops.get(state.poses.len() - 1..)? {
            pose = pose * hop.corrected(state.errors);
            state.poses.push(pose);
        }
        let mut numbers: Vec<u16> = self.ranges().map(|(_, range)| range.beacon).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for number in numbers {
            if state.beacons.iter().any(|known| known.number == number) {
                continue;
            }
            let ranges = self.ranges_of(number, &state.poses);
            if ranges.len() >= BATCH.ranges_min
                && let Some(place) = locate_beacon(&ranges)
            {
                state.beacons.push(Beacon::new(number, place));
            }
        }
        (state.beacons.len() >= BATCH.beacons_min).then_some(state)
    }

    /// Ranges to a beacon, and where they were measured on this path.
    fn ranges_of(&self, number: u16, poses: &[Pose2]) -> Vec<MeasuredRange> {
        self.ranges()
            .filter(|(_, range)| range.beacon == number)
            .filter_map(|(hop, range)| {
                Some(MeasuredRange {
                    from: poses.get(hop + 1)?.transform(range.at),
                    range_m: range.range_m,
                })
            })
            .collect()
    }

    /// Learns from the deviations of each beacon's ranges how large those are that stay the same around a place.
    fn learn_noise(&self, state: &mut BatchState) {
        for beacon in &mut state.beacons {
            let mut sizes: Vec<f64> = Vec::new();
            let (mut own_m2, mut product, mut square, mut last) = (0.0, 0.0, 0.0, None);
            for (number, range) in self.ranges().filter(|(_, range)| range.beacon == beacon.number) {
                let Some(pose) = state.poses.get(number + 1) else {
                    continue;
                };
                let off_m = beacon.innovation(*pose, state.errors, range).off_m;
                sizes.push(off_m.abs());
                own_m2 += range.sigma_m * range.sigma_m;
                if off_m.abs() > 3.0 * beacon.place_sigma_m {
                    last = None;
                    continue;
                }
                product += last.map_or(0.0, |last: f64| last * off_m);
                square += off_m * off_m;
                last = Some(off_m);
            }
            if sizes.len() < BATCH.learn_ranges {
                continue;
            }
            sizes.sort_by(f64::total_cmp);
            let median_m = sizes.get(sizes.len() / 2).copied().unwrap_or_default();
            let spread_m2 = libm::pow(1.4826 * median_m, 2.0);
            let alike = (product / square).clamp(0.0, BATCH.alike_max);
            let inflated_m2 = spread_m2 * (1.0 + alike) / (1.0 - alike);
            let place_m2 = inflated_m2 - own_m2 / sizes.len() as f64;
            beacon.place_sigma_m =
                libm::sqrt(place_m2.max(0.0)).clamp(RANGE.place_sigma_min_m, RANGE.place_sigma_max_m);
        }
    }

    /// Index of the hop, and the range.
    fn ranges(&self) -> impl Iterator<Item = (usize, &HopRange)> {
        self.hops
            .iter()
            .enumerate()
            .flat_map(|(number, hop)| hop.ranges.iter().map(move |range| (number, range)))
    }

    /// One iteration: the step, the factor of its system, and the misfit of the ranges before it.
    async fn step(&self, state: &BatchState, budget: &mut StepBudget) -> Option<(Vec<f64>, Factor, f64)> {
        let common = POSE * state.poses.len();
        let unknowns = common + ERRORS + BEACON * state.beacons.len();
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
                errors: state.errors,
                pose_at: POSE * number,
                errors_at: common,
            };
            measure_hop(hop, &ends, &mut system);
            if let Some(anchor) = &hop.anchor {
                measure_anchor(anchor, (*to, POSE * (number + 1)), &mut system);
            }
            budget.spend(HOP_WORK).await;
        }
        let (mut misfit, mut count) = (0.0, 0_u32);
        for (number, range) in self.ranges() {
            budget.spend(RANGE_WORK).await;
            let Some(beacon) = state
                .beacons
                .iter()
                .position(|known| known.number == range.beacon)
            else {
                continue;
            };
            let pose = *state.poses.get(number + 1)?;
            let innovation = state.beacons.get(beacon)?.innovation(pose, state.errors, range);
            let predicted = innovation.predicted;
            let weight = innovation.weight(0.0);
            misfit += weight * innovation.off_m * innovation.off_m / innovation.noise_m2;
            count += 1;
            let per = libm::sqrt(weight / innovation.noise_m2);
            let at = POSE * (number + 1);
            let beacon_at = common + ERRORS + BEACON * beacon;
            measure(
                &mut system,
                -per * innovation.off_m,
                &[
                    (at, per * predicted.by_x),
                    (at + 1, per * predicted.by_y),
                    (at + 2, per * predicted.by_heading),
                    (common + ERRORS - 2, per * predicted.by_antenna[0]),
                    (common + ERRORS - 1, per * predicted.by_antenna[1]),
                    (beacon_at, -per * predicted.by_x),
                    (beacon_at + 1, -per * predicted.by_y),
                    (beacon_at + 2, per),
                ],
            );
        }
        for (number, beacon) in state.beacons.iter().enumerate() {
            let per = 1.0 / FILTER.bias_sigma_m;
            let at = common + ERRORS + BEACON * number + 2;
            measure(&mut system, per * beacon.bias_m, &[(at, per)]);
        }
        let Solution { values, factor } = system.solve(budget).await?;
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
            FILTER.antenna_sigma_m,
            FILTER.antenna_sigma_m,
        ];
        for (number, (value, sigma)) in state.errors.iter().zip(sigmas).enumerate() {
            measure(system, value / sigma, &[(common + number, 1.0 / sigma)]);
        }
    }

    async fn answer(
        &self,
        state: &BatchState,
        (factor, fit): (Factor, f64),
        budget: &mut StepBudget,
    ) -> Option<BeaconFilter> {
        // Written so that NaN does not fit.
        let fits = fit <= BATCH.misfit_max;
        if !fits {
            return None;
        }
        let common = POSE * state.poses.len();
        let unknowns = common + ERRORS + BEACON * state.beacons.len();
        let mut covariance: Vec<Vec<f64>> = Vec::new();
        for row in common - POSE..unknowns {
            let mut unit = vec![0.0; unknowns];
            if let Some(one) = unit.get_mut(row) {
                *one = 1.0;
            }
            let column = factor.solve(unit, budget).await?;
            covariance.push(column.get(common - POSE..).unwrap_or_default().to_vec());
        }
        let mut follower = BeaconFilter::begin(InitialState {
            pose: *state.poses.last()?,
            errors: state.errors,
            beacons: &state.beacons,
            covariance,
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
        let (errors, beacons) = rest.split_at(rest.len().min(ERRORS));
        for (value, change) in self.errors.iter_mut().zip(errors) {
            *value += change;
        }
        for (beacon, change) in self.beacons.iter_mut().zip(beacons.chunks_exact(BEACON)) {
            beacon.add(change, 1.0);
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
    errors: [f64; ERRORS],
    /// Row of the pose at the start in the system; that of the pose at the end comes next.
    pose_at: usize,
    /// Row of the wheels' errors.
    errors_at: usize,
}

/// Adds the residuals of a pose, with its row in the system, beside what a map says of it.
fn measure_anchor(anchor: &Anchor, (pose, at): (Pose2, usize), system: &mut System) {
    let off = [
        (pose.x_m - anchor.pose.x_m) / anchor.sigma_m,
        (pose.y_m - anchor.pose.y_m) / anchor.sigma_m,
        normalize_rad(pose.heading_rad - anchor.pose.heading_rad) / anchor.sigma_rad,
    ];
    let sigmas = [anchor.sigma_m, anchor.sigma_m, anchor.sigma_rad];
    for (number, (off, sigma)) in off.into_iter().zip(sigmas).enumerate() {
        let by_root = libm::sqrt(weight(off));
        measure(system, by_root * off, &[(at + number, by_root / sigma)]);
    }
}

/// Adds the residuals of a hop.
fn measure_hop(hop: &Hop, ends: &HopEnds, system: &mut System) {
    let HopEnds { from, to, .. } = *ends;
    let expected = hop.corrected(ends.errors);
    let (sin, cos) = libm::sincos(from.heading_rad);
    let (dx, dy) = (to.x_m - from.x_m, to.y_m - from.y_m);
    let (along_m, left_m) = (cos * dx + sin * dy, cos * dy - sin * dx);
    let (by_bend, by_scale) = hop.turn_by_errors();
    let bent = |of: f64, towards: f64| 0.5 * of * towards;
    let at = ends.pose_at;
    let [bend, scale, stretch] = [0, 1, 2].map(|number| ends.errors_at + number);
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
