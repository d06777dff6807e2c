//! Parameters of localization between kept beacons. They are chosen in the runs of `docs/book/src/measurements/relax.md`.

/// How well a hypothesis explains the ranges.
pub(super) struct HypothesisParameters {
    /// Robust square of a range of which nothing is predicted: what right predictions have on average.
    pub(super) usual: f64,
    /// Weight of one range in the mean of the latest.
    pub(super) lately_share: f64,
    /// What is left of the cost after a hop.
    pub(super) decay: f64,
    /// Cost of a slip of the wheels, without which the ranges are not explained.
    pub(super) slip_cost: f64,
}

pub(super) const HYPOTHESIS: HypothesisParameters = HypothesisParameters {
    usual: 0.5,
    lately_share: 0.06,
    decay: 0.995,
    slip_cost: 8.0,
};

/// When the place counts as wrong.
pub(super) struct DoubtParameters {
    /// Greatest mean robust square of the latest ranges that counts as explained.
    pub(super) lately_max: f64,
    /// Fewest ranges before a doubt.
    pub(super) heard_min: u32,
    /// Fewest ranges before the heading counts as known.
    pub(super) confirmed_min: u32,
}

pub(super) const DOUBT: DoubtParameters = DoubtParameters {
    lately_max: 2.2,
    heard_min: 12,
    confirmed_min: 8,
};

/// The search for the place.
pub(super) struct SearchParameters {
    /// So many of the latest hops tell where a search begins.
    pub(super) recent_hops: usize,
    /// Cost of being elsewhere at all.
    pub(super) prior_cost: f64,
    /// Cost of being where it was, for a robot that somebody has carried.
    pub(super) carried_cost: f64,
    /// The place is known when all others cost so much more,
    pub(super) lead: f64,
    /// and with these standard deviations at most, metres and radians,
    pub(super) sure_m: f64,
    pub(super) sure_rad: f64,
    /// after this distance at least, metres.
    pub(super) driven_min_m: f64,
    /// Where none is found within this distance, the beacons contradict one another, metres.
    pub(super) driven_max_m: f64,
    /// Hypotheses that cost so much more than the best are dropped.
    pub(super) hopeless: f64,
    /// Hypotheses nearer to each other than this say the same, metres and radians.
    pub(super) same_m: f64,
    pub(super) same_rad: f64,
    /// Hypotheses nearer to each other than this have become one, metres and radians.
    pub(super) merged_m: f64,
    pub(super) merged_rad: f64,
}

pub(super) const SEARCH: SearchParameters = SearchParameters {
    recent_hops: 8,
    prior_cost: 6.0,
    carried_cost: 30.0,
    lead: 12.0,
    sure_m: 0.4,
    sure_rad: 0.15,
    driven_min_m: 0.5,
    driven_max_m: 20.0,
    hopeless: 40.0,
    same_m: 0.6,
    same_rad: 0.5,
    merged_m: 0.15,
    merged_rad: 0.1,
};

/// First guesses of a place.
pub(super) struct SeedParameters {
    /// Directions from the nearest beacon that are tried.
    pub(super) directions: u32,
    /// Distances that are tried, relative to its range, metres.
    pub(super) off_m: [f64; 5],
    /// Least standard deviation of a range, metres.
    pub(super) sigma_min_m: f64,
    /// Positions whose cost is greater than that of the best by more than this are left out.
    pub(super) worse_max: f64,
    /// Most positions,
    pub(super) positions_max: usize,
    /// and the least distance between two of them, metres.
    pub(super) apart_m: f64,
    /// Headings that are tried at each.
    pub(super) headings: u32,
    /// Standard deviation of a first guess, metres.
    pub(super) sigma_m: f64,
}

pub(super) const SEEDS: SeedParameters = SeedParameters {
    directions: 48,
    off_m: [-0.6, -0.3, 0.0, 0.3, 0.6],
    sigma_min_m: 0.1,
    worse_max: 9.0,
    positions_max: 4,
    apart_m: 1.0,
    headings: 16,
    sigma_m: 0.5,
};

/// When a beacon counts as moved.
pub(super) struct MovedParameters {
    /// It is located so far from where it was, metres,
    pub(super) away_m: f64,
    /// and by so many standard deviations.
    pub(super) away_sigmas: f64,
    /// Least standard deviation of where it was, metres.
    pub(super) sigma_min_m: f64,
    /// Without it the ranges cost so much less than with it,
    pub(super) gain: f64,
    /// and so much less than without any other one.
    pub(super) lead: f64,
    /// Or they cost so much less than with it,
    pub(super) gain_min: f64,
    /// and the other beacons are located at most by this share of its standard deviations elsewhere.
    pub(super) others_share: f64,
    /// The pose is taken from a hypothesis that costs so much less than the present one.
    pub(super) switch_lead: f64,
}

pub(super) const MOVED: MovedParameters = MovedParameters {
    away_m: 0.7,
    away_sigmas: 2.5,
    sigma_min_m: 0.1,
    gain: 25.0,
    lead: 10.0,
    gain_min: 10.0,
    others_share: 0.45,
    switch_lead: 12.0,
};
