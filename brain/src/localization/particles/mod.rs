//! Monte Carlo localization: a particle filter over the pose in a known map. Particles move by odometry, each with errors of its
//! own, and those that explain the sensors multiply.
//!
//! *BodyPose*: a pose with its cosine, sine and clearance. *BeamScore*: how many beams the map explains at a pose. *Tempered*: a
//! likelihood to a power below 1, because the errors of neighbouring beams and moments are not independent: a dark cupboard is dark
//! along its whole length.

mod filter_mode;
mod gyro;
mod infrared;
mod parameters;
mod surface;
mod surroundings;
mod touch;

use crate::model::config::SensorLayout;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::observation::{Cliffs, Contacts, Observation};
use crate::model::random::Random;

use super::beacons::LocatedRange;
use super::gyro_estimate::{BiasMeasurement, GyroEstimate};
use crate::model::pose_estimate::PoseEstimate;
pub(super) use filter_mode::FilterMode;
pub(super) use gyro::GyroCount;
use gyro::ParticleGyro;
pub(super) use infrared::{BeamAgreement, BeamScore, ComparedBeam};
use infrared::{BeamModel, BodyPose};
use parameters::{MOTION, SAMPLING};
use surface::Reflectances;
pub(super) use surroundings::Surroundings;
use touch::{BodyModel, Touch, body_likelihood};

/// One particle.
#[derive(Clone, Copy, Debug)]
struct Particle {
    pose: Pose2,
    /// True distance divided by counted distance: wheel size, slip on rugs.
    distance_factor: f64,
    gyro: ParticleGyro,
    surfaces: Reflectances,
    weight: f64,
}

/// Motion since the last weighing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MotionDelta {
    /// From the last pose to this one.
    pub(super) step: Pose2,
    /// Distance driven, also backwards, metres.
    pub(super) distance_m: f64,
    /// Variance of the turn, square radians.
    pub(super) turn_variance: f64,
    pub(super) gyro: GyroCount,
}

/// Measurements since the last weighing, besides the infrared readings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measurements<'noticed> {
    /// Contacts and cliffs that begin now.
    pub(super) contacts: Contacts,
    pub(super) edges: Cliffs,
    pub(super) ranges: &'noticed [LocatedRange],
    /// Result of zero-velocity updates.
    pub(super) measured_bias: Option<BiasMeasurement>,
}

/// Standard deviations around a pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseSpread {
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// The particle filter.
#[derive(Clone, Debug)]
pub(super) struct ParticleFilter {
    particles: Vec<Particle>,
    spare: Vec<Particle>,
    bins: Vec<u64>,
    random: Random,
    radius_m: f64,
    layout: SensorLayout,
    beams: BeamModel,
    /// Prior of the gyro for new particles.
    gyro: GyroEstimate,
    mode: FilterMode,
}

impl ParticleFilter {
    /// All particles are at the origin.
    pub(super) fn new(radius_m: f64, layout: SensorLayout, seed: u64) -> Self {
        let mut filter = Self {
            particles: Vec::new(),
            spare: Vec::new(),
            bins: Vec::new(),
            random: Random::new(seed),
            radius_m,
            layout,
            beams: BeamModel::new(&layout.proximity),
            gyro: GyroEstimate::default(),
            mode: FilterMode::Searching,
        };
        filter.gather(
            Pose2::IDENTITY,
            PoseSpread {
                sigma_m: 0.0,
                sigma_rad: 0.0,
            },
        );
        filter
    }

    /// Sets the prior of the gyro for new particles.
    pub(super) fn set_gyro_prior(&mut self, belief: GyroEstimate) {
        self.gyro = belief;
    }

    /// Sets the mode. When the filter begins to hold, the particles take the prior of the gyro again.
    pub(super) fn set_mode(&mut self, mode: FilterMode) {
        if mode == FilterMode::Holding && self.mode == FilterMode::Searching {
            for particle in &mut self.particles {
                particle.gyro = ParticleGyro::drawn(self.gyro, &mut self.random);
                particle.surfaces = Reflectances::default();
            }
        }
        self.mode = mode;
    }

    /// Estimate of the gyro, if the particles have learned one.
    pub(super) fn gyro(&self) -> Option<GyroEstimate> {
        let particles = self.particles.iter();
        let particles = particles.map(|particle| (particle.weight, particle.gyro));
        (self.mode == FilterMode::Holding).then(|| gyro::belief(particles))
    }

    /// Draws all particles around one pose.
    pub(super) fn gather(&mut self, around: Pose2, spread: PoseSpread) {
        self.particles.clear();
        for _ in 0..SAMPLING.tracking_max {
            let particle = self.draw(around, spread);
            self.particles.push(particle);
        }
    }

    /// Draws particles around several poses.
    pub(super) fn scatter(&mut self, around: &[Pose2], spread: PoseSpread) {
        self.particles.clear();
        for pose in around {
            for _ in 0..SAMPLING.per_candidate {
                let particle = self.draw(*pose, spread);
                self.particles.push(particle);
            }
        }
    }

    /// Draws every third particle again around a pose.
    pub(super) fn widen(&mut self, around: Pose2, spread: PoseSpread) {
        for index in (0..self.particles.len()).step_by(3) {
            let drawn = self.draw(around, spread);
            if let Some(particle) = self.particles.get_mut(index) {
                *particle = Particle {
                    distance_factor: particle.distance_factor,
                    gyro: particle.gyro,
                    ..drawn
                };
            }
        }
    }

    fn draw(&mut self, around: Pose2, spread: PoseSpread) -> Particle {
        Particle {
            pose: Pose2 {
                x_m: around.x_m + spread.sigma_m * self.random.normal(),
                y_m: around.y_m + spread.sigma_m * self.random.normal(),
                heading_rad: normalize_rad(around.heading_rad + spread.sigma_rad * self.random.normal()),
            },
            distance_factor: 1.0 + MOTION.distance_factor_sigma * self.random.normal(),
            gyro: ParticleGyro::drawn(self.gyro, &mut self.random),
            surfaces: Reflectances::default(),
            weight: 1.0,
        }
    }

    /// Predicts: moves every particle.
    pub(super) fn follow(&mut self, motion: MotionDelta) {
        let root_m = libm::sqrt(motion.distance_m);
        let along_m = MOTION.slip_m_per_sqrt_m * root_m + MOTION.jitter_m;
        let (jitter_rad, kept) = match self.mode {
            FilterMode::Searching => (MOTION.searching_jitter_rad, 0.0),
            FilterMode::Holding => (MOTION.jitter_rad, Reflectances::kept_after(motion.distance_m)),
        };
        let turn_rad = libm::sqrt(motion.turn_variance) + jitter_rad;
        let walk = MOTION.distance_factor_walk * root_m;
        for particle in &mut self.particles {
            particle.surfaces.move_on(kept);
            let uncounted_rad = match self.mode {
                FilterMode::Searching => 0.0,
                FilterMode::Holding => {
                    particle.gyro.turned_more_rad(motion.gyro, &mut self.random)
                        + uncounted_turn_rad(&mut self.random)
                }
            };
            particle.distance_factor = (particle.distance_factor + walk * self.random.normal())
                .clamp(MOTION.distance_factor_min, MOTION.distance_factor_max);
            let step = Pose2 {
                x_m: motion.step.x_m * particle.distance_factor + along_m * self.random.normal(),
                y_m: motion.step.y_m * particle.distance_factor + MOTION.jitter_m * self.random.normal(),
                heading_rad: motion.step.heading_rad + uncounted_rad + turn_rad * self.random.normal(),
            };
            particle.pose = particle.pose * step;
        }
    }

    /// Weighs every particle by the measurements, and resamples when few particles fit.
    pub(super) fn weigh(
        &mut self,
        map: &impl Surroundings,
        observation: &Observation,
        measured: &Measurements<'_>,
    ) {
        self.beams
            .read(&observation.proximity, &self.layout.proximity.response);
        let touch = Touch {
            mode: self.mode,
            contacts: measured.contacts,
            edges: measured.edges,
        };
        let body = BodyModel {
            radius_m: self.radius_m,
            layout: &self.layout,
        };
        let mut sum = 0.0;
        for particle in &mut self.particles {
            let place = place(map, particle.pose);
            let infrared = self.beams.likelihood(map, &place, &mut particle.surfaces);
            let mut likelihood = tempered(infrared, self.mode);
            likelihood *= body_likelihood(place.clearance_m - self.radius_m);
            if touch.is_informative() {
                likelihood *= touch.likelihood(map, &place, body);
            }
            if let Some(measured_bias) = measured
                .measured_bias
                .filter(|_| self.mode == FilterMode::Holding)
            {
                likelihood *= particle.gyro.likelihood(measured_bias);
            }
            particle.weight *= likelihood * ranges_likelihood(measured.ranges, place.centre);
            sum += particle.weight;
        }
        self.normalize(sum);
        if self.effective_share() < SAMPLING.resample_share {
            self.resample();
        }
    }

    fn normalize(&mut self, sum: f64) {
        let scale = if sum > 1e-200 {
            self.particles.len() as f64 / sum
        } else {
            0.0
        };
        for particle in &mut self.particles {
            // All particles are impossible, so none is better than another.
            particle.weight = if scale > 0.0 { particle.weight * scale } else { 1.0 };
        }
    }

    /// Effective share of the particles. Weights have the mean 1.
    fn effective_share(&self) -> f64 {
        let squares: f64 = self
            .particles
            .iter()
            .map(|particle| particle.weight * particle.weight)
            .sum();
        self.particles.len() as f64 / squares.max(1e-9)
    }

    /// Systematic resampling with as many particles as their spread needs.
    fn resample(&mut self) {
        let needed = self.needed();
        let gyro = self.gyro();
        let count = self.particles.len();
        let step = count as f64 / needed as f64;
        let mut pointer = self.random.between(0.0, step);
        let mut passed = 0.0;
        self.spare.clear();
        for particle in &self.particles {
            passed += particle.weight;
            while pointer < passed && self.spare.len() < needed {
                self.spare.push(Particle {
                    weight: 1.0,
                    gyro: match gyro {
                        Some(gyro) => particle.gyro.redrawn(gyro, &mut self.random),
                        None => particle.gyro,
                    },
                    ..*particle
                });
                pointer += step;
            }
        }
        if !self.spare.is_empty() {
            core::mem::swap(&mut self.particles, &mut self.spare);
        }
    }

    /// Number of particles for the occupied bins (KLD sampling).
    fn needed(&mut self) -> usize {
        self.bins.clear();
        for particle in self.particles.iter().filter(|particle| particle.weight > 0.1) {
            self.bins.push(bin(particle.pose, 1.0));
        }
        self.bins.sort_unstable();
        self.bins.dedup();
        let more = self.bins.len().saturating_sub(1).max(1) as f64;
        let shrink = 2.0 / (9.0 * more);
        let root = 1.0 - shrink + libm::sqrt(shrink) * SAMPLING.kld_quantile;
        let needed = more / (2.0 * SAMPLING.kld_error) * root * root * root;
        let most = self.particles.len().max(SAMPLING.tracking_max);
        (needed as usize).clamp(SAMPLING.tracking_min, most)
    }

    /// Mean of the particles and their spread.
    pub(super) fn estimate(&self) -> PoseEstimate {
        mean(&self.particles)
    }

    /// Mean and spread of the largest cluster, and its share of the total weight.
    pub(super) fn cluster(&mut self) -> (PoseEstimate, f64) {
        let Some(centre) = self.densest() else {
            return (self.estimate(), 0.0);
        };
        let near = |pose: Pose2| {
            pose.position().distance_m(centre.position()) <= SAMPLING.cluster_m
                && normalize_rad(pose.heading_rad - centre.heading_rad).abs() <= SAMPLING.cluster_rad
        };
        self.spare.clear();
        self.spare
            .extend(self.particles.iter().filter(|particle| near(particle.pose)));
        let weight = |particles: &[Particle]| particles.iter().map(|particle| particle.weight).sum::<f64>();
        let share = weight(&self.spare) / weight(&self.particles).max(1e-9);
        (mean(&self.spare), share)
    }

    /// A particle in the fullest bin.
    fn densest(&self) -> Option<Pose2> {
        let mut binned: Vec<(u64, usize)> = self
            .particles
            .iter()
            .enumerate()
            .map(|(index, particle)| (bin(particle.pose, 2.0), index))
            .collect();
        binned.sort_unstable();
        let fullest = binned
            .chunk_by(|one, other| one.0 == other.0)
            .max_by(|one, other| {
                let weight = |chunk: &[(u64, usize)]| -> f64 {
                    chunk
                        .iter()
                        .filter_map(|(_, index)| self.particles.get(*index))
                        .map(|particle| particle.weight)
                        .sum()
                };
                weight(one).total_cmp(&weight(other))
            })?;
        let (_, index) = fullest.first()?;
        self.particles.get(*index).map(|particle| particle.pose)
    }

    /// Score of the last weighing's beams at a pose.
    pub(super) fn score(&self, map: &impl Surroundings, pose: Pose2) -> BeamScore {
        self.beams.score(map, &place(map, pose))
    }

    /// The last weighing's beams, each compared with the map at a pose.
    pub(super) fn compared(&self, map: &impl Surroundings, pose: Pose2) -> Vec<ComparedBeam> {
        self.beams.compared(map, &place(map, pose)).collect()
    }
}

/// Likelihood of ranges to beacons at a position, with the heavy tails of Student's t; 1 at best.
fn ranges_likelihood(ranges: &[LocatedRange], centre: Point2) -> f64 {
    ranges.iter().fold(1.0, |likelihood, range| {
        let off = (range.range_m - range.at.distance_m(centre)) / range.sigma_m;
        let body = 1.0 + off * off / 3.0;
        likelihood / (body * body)
    })
}

/// To the power of 1/2, or of 3/8 where reflectances are not remembered. Roots are cheap.
fn tempered(likelihood: f64, mode: FilterMode) -> f64 {
    let root = libm::sqrt(likelihood);
    match mode {
        FilterMode::Searching => libm::sqrt(root * libm::sqrt(root)),
        FilterMode::Holding => root,
    }
}

/// Number of the bin of a pose, for bins `factor` times as wide as usual.
fn bin(pose: Pose2, factor: f64) -> u64 {
    let number = |value: f64, edge: f64| (libm::floor(value / (edge * factor)) as i64 as u64) & 0xf_ffff;
    number(pose.x_m, SAMPLING.bin_m) << 40
        | number(pose.y_m, SAMPLING.bin_m) << 20
        | number(pose.heading_rad, SAMPLING.bin_rad)
}

/// A turn that odometry did not count.
fn uncounted_turn_rad(random: &mut Random) -> f64 {
    if random.between(0.0, 1.0) < MOTION.uncounted_turn_share {
        MOTION.uncounted_turn_rad * random.normal()
    } else {
        0.0
    }
}

/// Weighted mean of the particles and their spread.
fn mean(particles: &[Particle]) -> PoseEstimate {
    let Some(first) = particles.first() else {
        return PoseEstimate::default();
    };
    let origin = first.pose;
    let sum: f64 = particles.iter().map(|particle| particle.weight).sum();
    let mean = |of: &dyn Fn(Pose2) -> f64| {
        particles
            .iter()
            .map(|particle| particle.weight * of(particle.pose))
            .sum::<f64>()
            / sum
    };
    let turn_rad = mean(&|pose| normalize_rad(pose.heading_rad - origin.heading_rad));
    let pose = Pose2 {
        x_m: mean(&|pose| pose.x_m),
        y_m: mean(&|pose| pose.y_m),
        heading_rad: normalize_rad(origin.heading_rad + turn_rad),
    };
    let xx = mean(&|other| (other.x_m - pose.x_m) * (other.x_m - pose.x_m));
    let yy = mean(&|other| (other.y_m - pose.y_m) * (other.y_m - pose.y_m));
    let xy = mean(&|other| (other.x_m - pose.x_m) * (other.y_m - pose.y_m));
    let rad2 = mean(&|other| {
        let off = normalize_rad(other.heading_rad - pose.heading_rad);
        off * off
    });
    let half = 0.5 * (xx - yy);
    let greatest = 0.5 * (xx + yy) + libm::sqrt(half * half + xy * xy);
    PoseEstimate {
        pose,
        sigma_m: libm::sqrt(greatest),
        sigma_rad: libm::sqrt(rad2),
        ..PoseEstimate::default()
    }
}

fn place(map: &impl Surroundings, pose: Pose2) -> BodyPose {
    let (sin, cos) = libm::sincos(pose.heading_rad);
    BodyPose {
        centre: pose.position(),
        cos,
        sin,
        clearance_m: map.clearance_m(pose.position()),
    }
}
