//! Parameters of line SLAM. They are chosen by hand in simulated homes, those of `DUPLICATE` in 31 of them
//! (`docs/book/src/measurements/archive.md`, "Changes that were measured"). `systematic-first-run.md` beside it shows what they achieve
//! together; no record compares values of another single one.

/// How the path is divided into submaps.
pub(super) struct SubmapParameters {
    /// A submap ends when nothing was seen for this distance, metres.
    pub(super) unseen_max_m: f64,
    /// Longest submap, metres.
    pub(super) length_max_m: f64,
    /// Most points of a submap.
    pub(super) points_max: usize,
    /// Distance between two samples, metres.
    pub(super) step_m: f64,
    /// Turn between two samples, radians.
    pub(super) step_rad: f64,
    /// Levels below this are noise, 0..1.
    pub(super) level_min: f64,
    /// A larger turn on the spot calibrates the gyro, radians: no corner needs as much. What is seen during such a turn has no
    /// reliable direction, and it separates two submaps.
    pub(super) spin_min_rad: f64,
    /// Distance that ends a turn on the spot, metres.
    pub(super) spin_distance_max_m: f64,
}

pub(super) const SUBMAP: SubmapParameters = SubmapParameters {
    unseen_max_m: 0.12,
    length_max_m: 0.7,
    points_max: 500,
    step_m: 0.01,
    step_rad: 0.045,
    level_min: 0.06,
    spin_min_rad: 3.5,
    spin_distance_max_m: 0.02,
};

/// How line segments are extracted from the points of a submap: candidate lines by a Hough transform, then a fit.
pub(super) struct SegmentParameters {
    /// Directions of the Hough transform: 5 degrees apart.
    pub(super) hough_directions: usize,
    /// Distance between two offsets of the Hough transform, metres.
    pub(super) hough_step_m: f64,
    /// Most offsets on either side of the submap's middle.
    pub(super) hough_offsets: usize,
    /// Points this close to a line may belong to it, metres.
    pub(super) near_m: f64,
    /// After the fit they must be this close, metres.
    pub(super) fit_m: f64,
    /// Beams that hit a wall at a smaller cosine say little about its position.
    pub(super) cosine_min: f64,
    /// Fewest points of a segment.
    pub(super) points_min: usize,
    /// Shortest segment, metres.
    pub(super) length_min_m: f64,
    /// Longest gap within a segment, metres.
    pub(super) gap_max_m: f64,
    /// Largest scatter of a segment, metres.
    pub(super) scatter_max_m: f64,
    /// Most segments of one submap.
    pub(super) segments_max: usize,
    /// Least standard deviation of the position, metres, however many points there are: walls reflect differently along their
    /// length.
    pub(super) sigma_min_m: f64,
    /// Least standard deviation of the direction, radians, for the same reason.
    pub(super) sigma_min_rad: f64,
    /// Least error of one end of a segment relative to the other end, metres.
    pub(super) end_error_min_m: f64,
    /// Standard deviation of the position in units of the scatter, which shows noise and varying reflectance.
    pub(super) sigma_scatters: f64,
    /// Error of one end relative to the other end, in the same units.
    pub(super) end_error_scatters: f64,
}

pub(super) const SEGMENT: SegmentParameters = SegmentParameters {
    hough_directions: 72,
    hough_step_m: 0.02,
    hough_offsets: 60,
    near_m: 0.035,
    fit_m: 0.025,
    cosine_min: 0.35,
    points_min: 8,
    length_min_m: 0.12,
    gap_max_m: 0.2,
    scatter_max_m: 0.013,
    segments_max: 4,
    sigma_min_m: 0.012,
    sigma_min_rad: 0.015,
    end_error_min_m: 0.02,
    sigma_scatters: 1.6,
    end_error_scatters: 3.0,
};

/// When a segment belongs to a landmark.
pub(super) struct AssociationParameters {
    /// Greatest distance between the two, in standard deviations.
    pub(super) gate_sigmas: f64,
    /// Greatest distance between the two, metres.
    pub(super) gate_max_m: f64,
    /// Greatest angle between their directions, radians: 14 degrees.
    pub(super) gate_rad: f64,
    /// Standard deviation of a landmark's own position, metres.
    pub(super) landmark_sigma_m: f64,
    /// A segment may lie this far beyond the known end of a landmark, metres.
    pub(super) extension_max_m: f64,
    /// The association is ambiguous when another landmark fits worse by less than this, metres.
    pub(super) ambiguity_m: f64,
}

pub(super) const ASSOCIATION: AssociationParameters = AssociationParameters {
    gate_sigmas: 3.0,
    gate_max_m: 0.3,
    gate_rad: 0.25,
    landmark_sigma_m: 0.03,
    extension_max_m: 0.6,
    ambiguity_m: 0.12,
};

/// When the cleanup merges landmarks and rejects observations.
pub(super) struct CleanupParameters {
    /// Landmarks closer to each other than this are merged, metres.
    pub(super) merge_max_m: f64,
    /// They are not merged when the gap between their ends is longer than this, metres.
    pub(super) merge_gap_max_m: f64,
    /// They are not merged when their normals differ by more than this, radians: 7 degrees.
    pub(super) merge_max_rad: f64,
    /// An observation farther than this from its landmark is an outlier, metres.
    pub(super) outlier_m: f64,
}

pub(super) const CLEANUP: CleanupParameters = CleanupParameters {
    merge_max_m: 0.05,
    merge_gap_max_m: 0.5,
    merge_max_rad: 0.125,
    outlier_m: 0.12,
};

/// When two landmarks seem to be the same wall, and when a merge of the two is accepted.
pub(super) struct DuplicateParameters {
    /// Landmarks are compared in stretches of this length, metres.
    pub(super) stretch_m: f64,
    /// Most stretches of one segment. A submap is shorter than that.
    pub(super) stretches_max: i32,
    /// Landmarks that are closer in front of each other than this are merged by the cleanup, metres.
    pub(super) before_min_m: f64,
    /// Landmarks that are farther apart than this are different walls, metres. No sensor sees farther.
    pub(super) before_max_m: f64,
    /// The robot's body reaches at least this far beyond its centre, metres.
    pub(super) body_m: f64,
    /// The contradiction must be this long, metres. A chair that was moved is shorter.
    pub(super) length_min_m: f64,
    /// At least this share of the merged observations must lie on the merged landmark.
    pub(super) inlier_share_min: f64,
    /// The other outliers must be fewer than this share of the merged observations.
    pub(super) outlier_share_max: f64,
    /// The odometry chi-square may rise by this much since the last optimization: 40 cm over a path of 30 m. A false merge of
    /// something that was moved strains shorter paths more.
    pub(super) chi_square_rise_max: f64,
}

pub(super) const DUPLICATE: DuplicateParameters = DuplicateParameters {
    stretch_m: 0.1,
    stretches_max: 30,
    before_min_m: 0.05,
    before_max_m: 0.6,
    body_m: 0.1,
    length_min_m: 0.55,
    inlier_share_min: 0.7,
    outlier_share_max: 0.3,
    chi_square_rise_max: 15.0,
};

/// The Gauss-Newton optimization of the graph.
pub(super) struct OptimizationParameters {
    /// Most iterations.
    pub(super) iterations_max: usize,
    /// The step size that ends them, metres or radians.
    pub(super) converged: f64,
    /// Longest accepted step of an iteration, metres or radians.
    pub(super) step_max: f64,
    /// Cauchy's constant, squared: observations within so many squared deviations have their full weight.
    pub(super) kernel: f64,
    /// Iterations in which far observations count.
    pub(super) wide_iterations: usize,
    /// Cauchy's constant in these iterations, squared: half a metre.
    pub(super) wide_kernel: f64,
}

pub(super) const OPTIMIZATION: OptimizationParameters = OptimizationParameters {
    iterations_max: 5,
    converged: 5e-4,
    step_max: 0.5,
    kernel: 5.0,
    wide_iterations: 3,
    wide_kernel: 500.0,
};

/// How a docking constrains the graph.
pub(super) struct DockingConstraintParameters {
    /// How well two dockings agree: x and y in metres, heading in radians. The contacts are some centimetres wide and close on a
    /// robot that is a few degrees askew: 2 cm and 2 degrees for each of the two.
    pub(super) sigmas: [f64; 3],
    /// Squared deviations at which a docking has a quarter of its weight (Geman and McClure's kernel): 25 deviations, which is
    /// 0.7 m. A graph that is off by half a metre at the dock is closed. A dock that somebody has moved by metres hardly pulls. A
    /// dock that was moved by decimetres pulls against the walls around it, which then tell the pose.
    pub(super) kernel: f64,
    /// A dock that is more than this many standard deviations from its expected pose does not correct the belief. The
    /// optimization decides.
    pub(super) gate_sigmas: f64,
    /// The robot must have driven this far since the last docking, metres. Contacts that open and close again add no information.
    pub(super) away_min_m: f64,
}

pub(super) const DOCKING: DockingConstraintParameters = DockingConstraintParameters {
    sigmas: [0.028, 0.028, 0.05],
    kernel: 625.0,
    gate_sigmas: 4.0,
    away_min_m: 0.5,
};

/// When a home counts as one with right angles. A peak is a direction, modulo a quarter turn, of much wall.
pub(super) struct ManhattanParameters {
    /// Bins on each side of a peak that belong to it: 7 degrees with the middle one.
    pub(super) peak_bins: usize,
    /// Fewest observations for a decision.
    pub(super) observations_min: usize,
    /// A home has right angles when this share of its wall length lies in the four directions. Chance gives 0.16.
    pub(super) gained_share: f64,
    /// A home with right angles loses them below this share.
    pub(super) lost_share: f64,
    /// Walls this close to one of the four directions are aligned with it, radians: 7 degrees.
    pub(super) near_rad: f64,
}

pub(super) const MANHATTAN: ManhattanParameters = ManhattanParameters {
    peak_bins: 3,
    observations_min: 6,
    gained_share: 0.6,
    lost_share: 0.45,
    near_rad: 0.12,
};

/// How the gyro's scale and bias enter the graph.
pub(super) struct TurnParameters {
    /// Length of an epoch with one bias, microseconds.
    pub(super) epoch_us: u64,
    /// A zero-velocity update that reduces the deviation below this share of the epoch's begins another epoch. The first update
    /// comes soon after the robot is switched on.
    pub(super) surer_share: f64,
    /// Least standard deviation of the scale, relative, so that weights stay finite.
    pub(super) scale_sigma_min: f64,
    /// Least standard deviation of the bias, radians per second, for the same reason.
    pub(super) bias_sigma_min_rad_per_s: f64,
}

pub(super) const TURN: TurnParameters = TurnParameters {
    epoch_us: 60_000_000,
    surer_share: 0.5,
    scale_sigma_min: 1e-4,
    bias_sigma_min_rad_per_s: 1e-5,
};

/// Noise of odometry, for a poor robot: a filter that is too sure keeps a wrong landmark.
pub(super) struct StepNoise {
    /// Slip of the position, square metres per metre.
    pub(super) slip_m2_per_m: f64,
    /// What each step adds to the slip, square metres.
    pub(super) step_m2: f64,
    /// Noise of a gyro's heading, square radians per second: 0.04 degrees per square root of a second.
    pub(super) gyro_rad2_per_s: f64,
    /// Slip in heading without a gyro, square radians per metre.
    pub(super) slip_rad2_per_m: f64,
}

pub(super) const NOISE: StepNoise = StepNoise {
    slip_m2_per_m: 4.0e-4,
    step_m2: 4.0e-6,
    gyro_rad2_per_s: 4.8e-7,
    slip_rad2_per_m: 7.6e-5,
};

/// When the graph is extended and optimized, and when the map is redrawn.
pub(super) struct UpdateParameters {
    /// Most nodes. Later poses are corrected by the landmarks known by then.
    pub(super) nodes_max: usize,
    /// The graph is optimized when this share of its observations is new.
    pub(super) fit_share: f64,
    /// Fewest new observations for an optimization.
    pub(super) fit_observations_min: usize,
    /// A step with a larger turn, in radians, has whole turns on the spot. It calibrates the gyro, so the graph is optimized at
    /// once.
    pub(super) calibration_turn_min_rad: f64,
    /// The map is redrawn when a pose has moved by this much, metres.
    pub(super) redraw_m: f64,
    /// Shortest time between two drawings, microseconds.
    pub(super) redraw_interval_us: u64,
    /// The time between two drawings is also at least the time since the start divided by this: redrawing takes longer the more
    /// there is.
    pub(super) redraw_elapsed_divisor: u64,
}

pub(super) const UPDATE: UpdateParameters = UpdateParameters {
    nodes_max: 2_000,
    fit_share: 0.03,
    fit_observations_min: 2,
    calibration_turn_min_rad: 7.0,
    redraw_m: 0.025,
    redraw_interval_us: 60_000_000,
    redraw_elapsed_divisor: 5,
};
