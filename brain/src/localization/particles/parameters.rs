//! Parameters of the particle filter. They are chosen by hand in simulated homes. Of the values alone a record exists for
//! `tracking_min` (600 particles against 220, in `docs/book/src/measurements/archive.md`); `systematic-known.md` and `relocalization.md`
//! beside it show what they achieve together.

use super::touch::ContactModel;

/// How many particles there are, and when they are resampled: KLD sampling (D. Fox 2003).
pub(super) struct SamplingParameters {
    /// Fewest particles while the pose is known.
    pub(super) tracking_min: usize,
    /// Most particles while the pose is known.
    pub(super) tracking_max: usize,
    /// Particles around each candidate pose of a lost robot.
    pub(super) per_candidate: usize,
    /// Particles are resampled when the effective share falls below this.
    pub(super) resample_share: f64,
    /// Edge of the bins in position, metres.
    pub(super) bin_m: f64,
    /// Edge of the bins in heading, radians.
    pub(super) bin_rad: f64,
    /// Bound of the Kullback-Leibler divergence.
    pub(super) kld_error: f64,
    /// Quantile of the normal distribution for that bound: 99 %.
    pub(super) kld_quantile: f64,
    /// Particles this close to each other are one cluster, metres.
    pub(super) cluster_m: f64,
    /// Particles with headings this close to each other are one cluster, radians.
    pub(super) cluster_rad: f64,
}

pub(super) const SAMPLING: SamplingParameters = SamplingParameters {
    tracking_min: 220,
    tracking_max: 400,
    per_candidate: 100,
    resample_share: 0.5,
    bin_m: 0.1,
    bin_rad: 0.17,
    kld_error: 0.05,
    kld_quantile: 2.33,
    cluster_m: 0.5,
    cluster_rad: 0.5,
};

/// Noise of the motion that particles draw. Particles keep their headings: a heading that walls gave in one corner of a room
/// guides a lane across the room.
pub(super) struct MotionNoise {
    /// Slip, metres per square root of a metre.
    pub(super) slip_m_per_sqrt_m: f64,
    /// Noise of the position that each motion adds, metres, for cells and for samples of other moments.
    pub(super) jitter_m: f64,
    /// Noise of the heading that each motion adds, radians, for the same reason.
    pub(super) jitter_rad: f64,
    /// The same while the filter searches, radians: headings from walls may be wrong, and particles must not keep them.
    pub(super) searching_jitter_rad: f64,
    /// Share of particles that turn at each motion, because all particles may have a wrong heading.
    pub(super) uncounted_turn_share: f64,
    /// Standard deviation of these turns, radians.
    pub(super) uncounted_turn_rad: f64,
    /// Spread of the distance factor among robots.
    pub(super) distance_factor_sigma: f64,
    /// Random walk of the distance factor on rugs, per square root of a metre.
    pub(super) distance_factor_walk: f64,
    /// Least accepted distance factor.
    pub(super) distance_factor_min: f64,
    /// Greatest accepted distance factor.
    pub(super) distance_factor_max: f64,
}

pub(super) const MOTION: MotionNoise = MotionNoise {
    slip_m_per_sqrt_m: 0.012,
    jitter_m: 0.002,
    jitter_rad: 0.0005,
    searching_jitter_rad: 0.002,
    uncounted_turn_share: 0.002,
    uncounted_turn_rad: 0.03,
    distance_factor_sigma: 0.01,
    distance_factor_walk: 0.002,
    distance_factor_min: 0.9,
    distance_factor_max: 1.1,
};

/// How particles estimate the errors of the gyro.
pub(super) struct GyroParameters {
    /// Random walk of the scale, relative per square root of a radian turned. No gyro has the same scale at all rates, and
    /// particles that agree too soon continue to learn.
    pub(super) scale_walk: f64,
    /// Share of the deviations that resampling draws again, because all copies of one particle would have the same scale (J. Liu
    /// and M. West 2001: the kernel keeps mean and variance).
    pub(super) redrawn_share: f64,
    /// Least standard deviation of the scale after resampling, relative.
    pub(super) scale_sigma_min: f64,
    /// Least standard deviation of the bias after resampling, radians per second.
    pub(super) bias_sigma_min_rad_per_s: f64,
    /// Greatest standard deviation of the bias with which particles start, radians per second, for a robot without any
    /// zero-velocity update. With a larger one some particles would turn until a wrong home fits.
    pub(super) bias_sigma_drawn_max_rad_per_s: f64,
    /// Least variance of a zero-velocity update, square radians per square second. A smaller one would leave few particles and so
    /// few positions.
    pub(super) measured_variance_min_rad2_per_s2: f64,
}

pub(super) const GYRO: GyroParameters = GyroParameters {
    scale_walk: 2.0e-4,
    redrawn_share: 0.05,
    scale_sigma_min: 3.0e-4,
    bias_sigma_min_rad_per_s: 5.0e-5,
    bias_sigma_drawn_max_rad_per_s: 5.0e-4,
    measured_variance_min_rad2_per_s2: 2.5e-8,
};

/// How a beam of a proximity sensor meets the map.
pub(super) struct BeamParameters {
    /// Levels below this are noise of the conversion, 0..1.
    pub(super) level_min: f64,
    /// Likelihood of a reading in unknown space. It is neutral.
    pub(super) unknown: f64,
    /// Likelihood of no reading where the map has an obstacle: drop-outs, black surfaces, removed furniture.
    pub(super) unseen: f64,
    /// Likelihood of a reading that the map does not explain, relative to a perfect match: people, bags, moved chairs.
    pub(super) unmapped: f64,
    /// The same for a beam that passes through an obstacle of the map.
    pub(super) through: f64,
    /// Band around the end of the range in which a reading is uncertain, metres.
    pub(super) range_band_m: f64,
    /// A beam hits an obstacle that is this close, metres.
    pub(super) meet_m: f64,
    /// Smallest step along a beam, metres.
    pub(super) step_min_m: f64,
    /// Most steps along a beam.
    pub(super) steps_max: usize,
}

pub(super) const BEAM: BeamParameters = BeamParameters {
    level_min: 0.02,
    unknown: 0.5,
    unseen: 0.08,
    unmapped: 0.12,
    through: 0.04,
    range_band_m: 0.02,
    meet_m: 0.003,
    step_min_m: 0.012,
    steps_max: 12,
};

/// How particles estimate the reflectance of the surfaces that the sensors see.
pub(super) struct ReflectanceParameters {
    /// Standard deviation of the reflectance, relative: white walls and dark furniture.
    pub(super) reflectance_sigma: f64,
    /// Greatest deviation from the usual reflectance, relative.
    pub(super) reflectance_off_max: f64,
    /// Noise of a level, relative: between a usual sensor and a bad one.
    pub(super) level_sigma: f64,
    /// Error of a distance by the map's cells and by the time between sample and report, metres.
    pub(super) distance_sigma_m: f64,
    /// A sensor sees another surface after this distance along a wall, on average, metres.
    pub(super) length_m: f64,
    /// A reading that is explained by less than this share teaches nothing about the surface.
    pub(super) explained_min: f64,
}

pub(super) const SURFACE: ReflectanceParameters = ReflectanceParameters {
    reflectance_sigma: 0.2,
    reflectance_off_max: 0.6,
    level_sigma: 0.08,
    distance_sigma_m: 0.015,
    length_m: 1.0,
    explained_min: 0.3,
};

/// How likely contacts, cliffs and the body itself are at a pose.
pub(super) struct TouchParameters {
    /// The body may overlap an obstacle by this much without a penalty: half a cell and the bumper's travel, metres.
    pub(super) overlap_free_m: f64,
    /// Over this additional overlap the pose becomes implausible, metres.
    pub(super) overlap_band_m: f64,
    /// Likelihood of a body deep inside a wall: furniture moves, maps are wrong.
    pub(super) inside: f64,
    /// Contacts while the filter holds. The values are those of maps that robots draw, which are wrong by 3 to 4 cm and lack many
    /// legs.
    pub(super) holding: ContactModel,
    /// Contacts while the filter searches. A contact must tell poses apart.
    pub(super) searching: ContactModel,
    /// Factor for a contact with a wall on the other side of the robot.
    pub(super) aside: f64,
    /// Uncertainty of the direction to the nearest wall, radians: corners and cells.
    pub(super) aside_rad: f64,
    /// Step for the gradient of the clearance, metres.
    pub(super) slope_step_m: f64,
    /// Standard deviation of the position of a cliff edge, metres.
    pub(super) edge_sigma_m: f64,
    /// Likelihood of a cliff where the map has none, and the reverse.
    pub(super) edge_unmapped: f64,
}

pub(super) const TOUCH: TouchParameters = TouchParameters {
    overlap_free_m: 0.015,
    overlap_band_m: 0.03,
    inside: 0.005,
    holding: ContactModel {
        sigma_m: 0.025,
        unmapped: 0.3,
    },
    searching: ContactModel {
        sigma_m: 0.015,
        unmapped: 0.08,
    },
    aside: 0.2,
    aside_rad: 0.35,
    slope_step_m: 0.02,
    edge_sigma_m: 0.02,
    edge_unmapped: 0.1,
};
