//! Parameters of localization by beacons. They are chosen in the eleven simulated homes of `docs/book/src/measurements/relax.md`, which
//! also tries them together on a recording of a real robot. No record compares values of a single one.

use super::filter::ERRORS;

/// What is one hop, and the noise of odometry over it.
pub(super) struct HopParameters {
    /// A hop ends after this distance, metres.
    pub(super) length_m: f64,
    /// Hops that are shorter count as this long, metres.
    pub(super) length_min_m: f64,
    /// A hop ends after this turn, radians.
    pub(super) turn_rad: f64,
    /// Slip, metres per square root of a metre.
    pub(super) slip_m_per_sqrt_m: f64,
    /// What each hop adds to the slip, metres.
    pub(super) jitter_m: f64,
    /// Heading error of the wheels by slip, radians per square root of a metre.
    pub(super) slip_rad_per_sqrt_m: f64,
    /// Heading error of the wheels by turns, radians per square root of a radian. Coarse encoders lose a count at each reversal.
    pub(super) turn_rad_per_sqrt_rad: f64,
    /// Slip while something is touched, metres.
    pub(super) touch_m: f64,
    /// Heading error of the wheels while something is touched, radians.
    pub(super) touch_rad: f64,
    /// Heading error of a gyro, radians per hop.
    pub(super) gyro_rad: f64,
    /// Heading error of a gyro, radians per radian turned.
    pub(super) gyro_scale: f64,
}

pub(super) const HOP: HopParameters = HopParameters {
    length_m: 0.15,
    length_min_m: 0.015,
    turn_rad: 0.5,
    slip_m_per_sqrt_m: 0.012,
    jitter_m: 0.004,
    slip_rad_per_sqrt_m: 0.01,
    turn_rad_per_sqrt_rad: 0.02,
    touch_m: 0.01,
    touch_rad: 0.02,
    gyro_rad: 0.002,
    gyro_scale: 0.006,
};

/// Which ranges are used, and their errors.
pub(super) struct RangeParameters {
    /// Most beacons; more than enough for a home.
    pub(super) beacons_max: usize,
    /// Most ranges of a hop to one beacon, of a robot that stands for long.
    pub(super) of_hop_max: usize,
    /// Greatest accepted range, metres.
    pub(super) range_max_m: f64,
    /// Greatest accepted standard deviation of one range, metres.
    pub(super) sigma_max_m: f64,
    /// Least standard deviation of one range, metres.
    pub(super) sigma_min_m: f64,
    /// Range error that stays the same around a place, metres, because of walls in the path. The mean of many ranges of a hop is
    /// no better than this. Several hops lie in one such place, so each counts less than it would alone.
    pub(super) place_sigma_m: f64,
    /// Least and greatest value of it that is learned.
    pub(super) place_sigma_min_m: f64,
    pub(super) place_sigma_max_m: f64,
    /// Least standard deviation that the particle filter of a known home is told, metres. It takes the ranges of each hop for independent,
    /// and would believe an error that stays the same around a place more with each.
    pub(super) told_sigma_min_m: f64,
}

pub(super) const RANGE: RangeParameters = RangeParameters {
    beacons_max: 8,
    of_hop_max: 64,
    range_max_m: 100.0,
    sigma_max_m: 10.0,
    sigma_min_m: 0.02,
    place_sigma_m: 0.3,
    place_sigma_min_m: 0.05,
    place_sigma_max_m: 0.7,
    told_sigma_min_m: 0.45,
};

/// The initialization, which solves a whole path as one batch.
pub(super) struct BatchParameters {
    /// Distance before the first attempt, metres.
    pub(super) first_m: f64,
    /// Distance between two attempts, metres.
    pub(super) again_m: f64,
    /// The least distance between two attempts as a share of the way.
    pub(super) again_share: f64,
    /// Greatest correlation between the deviations of two hops that is learned.
    pub(super) alike_max: f64,
    /// Fewest ranges of a beacon that tell how large its errors are.
    pub(super) learn_ranges: usize,
    /// After so many hops it starts again, because the wheels' errors bend a longer path too much for a first guess.
    pub(super) hops_max: usize,
    /// A solved path is not solved again beyond so many hops.
    pub(super) smoothed_max: usize,
    /// Greatest standard deviation of the start, metres. After long odometry the start is unknown, so a new frame begins there.
    pub(super) start_sigma_max_m: f64,
    /// Greatest standard deviation of the start's heading, radians, for the same reason.
    pub(super) start_sigma_max_rad: f64,
    /// Least standard deviation of the start, metres.
    pub(super) start_sigma_min_m: f64,
    /// Least standard deviation of the start's heading, radians.
    pub(super) start_sigma_min_rad: f64,
    /// Fewest ranges of a beacon.
    pub(super) ranges_min: usize,
    /// Fewest beacons: with odometry between two ranges, two beacons determine the pose.
    pub(super) beacons_min: usize,
    /// Most iterations of Gauss-Newton.
    pub(super) iterations_max: u32,
    /// The step that ends them, metres or radians.
    pub(super) converged: f64,
    /// Greatest standard deviation of a beacon's position, metres. Less certain beacons are located later.
    pub(super) sure_m: f64,
    /// Greatest weighted root mean square deviation of a correct solution.
    pub(super) misfit_max: f64,
}

pub(super) const BATCH: BatchParameters = BatchParameters {
    first_m: 8.0,
    again_m: 2.0,
    again_share: 0.05,
    alike_max: 0.6,
    learn_ranges: 40,
    hops_max: 250,
    smoothed_max: 6_000,
    start_sigma_max_m: 0.1,
    start_sigma_max_rad: 0.05,
    start_sigma_min_m: 0.01,
    start_sigma_min_rad: 0.01,
    ranges_min: 12,
    beacons_min: 2,
    iterations_max: 25,
    converged: 1e-3,
    sure_m: 0.5,
    misfit_max: 1.3,
};

/// The first guess of a beacon's position, by trying positions around the closest point of the path.
pub(super) struct MultilaterationParameters {
    /// Directions that are tried.
    pub(super) directions: u32,
    /// Distances that are tried, relative to the shortest range, metres.
    pub(super) off_m: [f64; 5],
    /// Standard deviation of a range from an approximate path, metres.
    pub(super) sigma_m: f64,
    /// A position this far from the best one is an alternative, metres.
    pub(super) other_m: f64,
    /// It must also be this far away, as a share of the shortest range, because a short path far away gives a good distance and a
    /// bad direction.
    pub(super) other_share: f64,
    /// An alternative must fit worse by this factor.
    pub(super) worse_min: f64,
}

pub(super) const MULTILATERATION: MultilaterationParameters = MultilaterationParameters {
    directions: 72,
    off_m: [-0.6, -0.3, 0.0, 0.3, 0.6],
    sigma_m: 0.5,
    other_m: 1.5,
    other_share: 0.8,
    worse_min: 1.4,
};

/// The filter of pose, wheels' errors and beacons. The prior deviations of the wheels are twice what robots of this class have.
pub(super) struct FilterParameters {
    /// Prior standard deviation of the curvature of a straight path, radians per metre: 0.6 degrees.
    pub(super) bend_sigma_rad_per_m: f64,
    /// Prior standard deviation of the scale error of turns, relative.
    pub(super) turn_scale_sigma: f64,
    /// Prior standard deviation of the scale error of distances, relative.
    pub(super) distance_scale_sigma: f64,
    /// Prior standard deviation of the antenna's place on the robot, metres, forward and to the left.
    pub(super) antenna_sigma_m: f64,
    /// Prior standard deviation of a beacon's bias, metres: its delay, and that of the walls around it.
    pub(super) bias_sigma_m: f64,
    /// Random walk of these three, per square root of a metre: rugs, dirt on errors.
    pub(super) errors_walk: [f64; ERRORS],
    /// A beacon that is heard first later is located from so many ranges.
    pub(super) late_ranges: usize,
    /// Standard deviation of such a position, metres.
    pub(super) late_sigma_m: f64,
    /// Standard deviation of a position that another estimator gave, metres.
    pub(super) placed_sigma_m: f64,
    /// Standard deviation of a heading that another estimator gave, radians.
    pub(super) placed_sigma_rad: f64,
}

pub(super) const FILTER: FilterParameters = FilterParameters {
    bend_sigma_rad_per_m: 0.0105,
    turn_scale_sigma: 0.03,
    distance_scale_sigma: 0.02,
    antenna_sigma_m: 0.1,
    bias_sigma_m: 0.15,
    errors_walk: [2.0e-4, 5.0e-4, 5.0e-4, 0.0, 0.0],
    late_ranges: 60,
    late_sigma_m: 0.6,
    placed_sigma_m: 0.03,
    placed_sigma_rad: 0.03,
};

/// Whether the heading is known well enough to draw a map.
pub(super) struct HeadingParameters {
    /// With at most this standard deviation it is, radians.
    pub(super) known_sigma_rad: f64,
    /// With more than this it is not any more, radians.
    pub(super) lost_sigma_rad: f64,
}

pub(super) const HEADING: HeadingParameters = HeadingParameters {
    known_sigma_rad: 0.1,
    lost_sigma_rad: 0.25,
};

/// When the wheels have slipped.
pub(super) struct SlipWatchParameters {
    /// A range this many standard deviations off is not explained.
    pub(super) far_sigmas: f64,
    /// Weight of one range in the share of those that are not explained.
    pub(super) share: f64,
    /// Greatest share of a robot that did not slip.
    pub(super) unexplained_max: f64,
    /// What a slip adds to the standard deviation of the position, metres.
    pub(super) sigma_m: f64,
    /// What it adds to that of the heading, radians.
    pub(super) sigma_rad: f64,
}

pub(super) const SLIP: SlipWatchParameters = SlipWatchParameters {
    far_sigmas: 2.0,
    share: 0.08,
    unexplained_max: 0.5,
    sigma_m: 0.4,
    sigma_rad: 0.3,
};

/// Beacons and places that are known from elsewhere.
pub(super) struct KnownParameters {
    /// Least standard deviations of the pose at the start between known beacons: the map may lie a little askew on the dock.
    pub(super) start_sigma_min_m: f64,
    pub(super) start_sigma_min_rad: f64,
    /// Least standard deviation of the error that stays the same around a place, metres: a short run learns too little of it.
    pub(super) place_sigma_min_m: f64,
    /// Standard deviation of the bias of a known beacon, metres.
    pub(super) bias_sigma_m: f64,
    /// Weight of one range in the share of a beacon's that are not explained.
    pub(super) share: f64,
    /// Beyond this share the beacon was moved,
    pub(super) moved_share: f64,
    /// while those of the others are below this,
    pub(super) others_share: f64,
    /// and there are so many beacons.
    pub(super) others_min: usize,
    /// Distance between two comparisons with the pose in a known map, metres: its errors are alike over a while.
    pub(super) anchor_every_m: f64,
    /// Least standard deviations of such a pose.
    pub(super) anchor_sigma_min_m: f64,
    pub(super) anchor_sigma_min_rad: f64,
    /// After so many comparisons the beacons lie in the frame of the map.
    pub(super) anchors_min: u32,
}

pub(super) const KNOWN: KnownParameters = KnownParameters {
    start_sigma_min_m: 0.05,
    start_sigma_min_rad: 0.06,
    place_sigma_min_m: 0.2,
    bias_sigma_m: 0.1,
    share: 0.02,
    moved_share: 0.85,
    others_share: 0.3,
    others_min: 3,
    anchor_every_m: 1.0,
    anchor_sigma_min_m: 0.2,
    anchor_sigma_min_rad: 0.08,
    anchors_min: 15,
};

/// When the map is drawn again at better poses.
pub(super) struct RedrawParameters {
    /// Root mean square of the change of past poses, metres.
    pub(super) change_m: f64,
    /// Least time between two, microseconds,
    pub(super) every_us: u64,
    /// and its least share of the time so far, as a divisor.
    pub(super) elapsed_divisor: u64,
    /// One hop in so many gives a pose.
    pub(super) hops: usize,
}

pub(super) const REDRAW: RedrawParameters = RedrawParameters {
    change_m: 0.08,
    every_us: 60_000_000,
    elapsed_divisor: 8,
    hops: 2,
};
