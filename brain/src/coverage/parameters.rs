//! Parameters of coverage, except those of single strategies and of planning, which stand in their folders.

use core::ops::Range;

use crate::mapping::CELL_M;

/// Margins of planned paths.
pub(super) struct PlanMargins {
    /// Gap between the body and known obstacles, metres. The cell size adds a little.
    pub(super) clearance_m: f64,
    /// Lanes overlap by at least twice this, metres, whatever deviation the pose estimate reports.
    pub(super) sigma_min_m: f64,
    /// More overlap does not pay: errors of neighbouring lanes are correlated, and leftovers are cheaper. With the full
    /// deviation three known homes were swept to 0.98 instead of 0.97, in 2.7 to 3.1 times the time
    /// (`measurements/systematic-known.md`). Metres.
    pub(super) sigma_max_m: f64,
}

pub(super) const MARGINS: PlanMargins = PlanMargins {
    clearance_m: 0.01,
    sigma_min_m: 0.01,
    sigma_max_m: 0.015,
};

/// The estimate of a job.
pub(super) struct EstimateParameters {
    /// Real jobs take this many times as long as their plans, because of acceleration, contacts and leftovers of an
    /// uncertain pose.
    pub(super) plan_to_job_time: f64,
    /// The low bound of the share assumes a pose this many times as uncertain as estimated.
    pub(super) low_bound_factor: f64,
    /// Standard deviation of the position where the map holds none, metres.
    pub(super) sigma_unknown_m: f64,
}

pub(super) const ESTIMATE: EstimateParameters = EstimateParameters {
    plan_to_job_time: 1.25,
    low_bound_factor: 2.0,
    sigma_unknown_m: 0.3,
};

/// The lap along the walls.
pub(super) struct PerimeterParameters {
    /// Distance between points of the track, metres.
    pub(super) track_step_m: f64,
    /// A point nearer than this was passed before, metres; less certain poses get more.
    pub(super) same_place_m: f64,
    /// What each metre by which the pose became less certain adds to it, metres.
    pub(super) same_place_per_sigma: f64,
    /// Upper limit of that distance, metres.
    pub(super) same_place_max_m: f64,
    /// As `same_place_m`, for the heading, radians.
    pub(super) same_heading_rad: f64,
    /// Shortest lap round an island, metres: the turning circle of the body alone.
    pub(super) island_min_m: f64,
    /// Shortest lap along walls, metres.
    pub(super) lap_min_m: f64,
    /// This distance on its own track closes a lap, metres.
    pub(super) closed_after_m: f64,
    /// This distance on the track of an earlier stretch ends a lap, metres: it leads to nothing new.
    pub(super) known_after_m: f64,
    /// A point this near to an earlier one shows nothing new, whatever the heading, metres: its floor is swept.
    pub(super) swept_radius_m: f64,
    /// This distance without anything new ends a lap, metres.
    pub(super) stale_max_m: f64,
    /// Distance that shows something new counts this many times against it.
    pub(super) fresh_worth: f64,
    /// Longest lap, metres: twice that of a large home.
    pub(super) lap_max_m: f64,
    /// A lap ends after this many islands without a wall.
    pub(super) islands_max: u32,
    /// Farther from the track than this a place is none that the lap has shown, metres.
    pub(super) beyond_m: f64,
    /// Turn away from an island, radians.
    pub(super) away_rad: f64,
    /// Failures of the wall follower until the lap ends.
    pub(super) troubles_max: u32,
}

pub(super) const PERIMETER: PerimeterParameters = PerimeterParameters {
    track_step_m: 0.1,
    same_place_m: 0.14,
    same_place_per_sigma: 0.3,
    same_place_max_m: 0.5,
    same_heading_rad: 0.6,
    island_min_m: 1.0,
    lap_min_m: 4.0,
    closed_after_m: 0.4,
    known_after_m: 5.0,
    swept_radius_m: 0.22,
    stale_max_m: 8.0,
    fresh_worth: 3.0,
    lap_max_m: 400.0,
    islands_max: 12,
    beyond_m: 1.0,
    away_rad: 1.5,
    troubles_max: 6,
};

/// The turns that measure the scale of the gyro.
pub(super) struct WholeTurnParameters {
    /// Turns are worth it while the relative deviation of the scale is above this. A gyro is off by some 0.5 %; with a
    /// tenth of a percent a first run is wrong by 7 cm instead of 11 (design page on navigation).
    pub(super) worth_sigma: f64,
    /// Most turns at a time: the direction of a wall segment is known to one degree, so three turns give the scale to
    /// 0.1 %.
    pub(super) turns_max: f64,
    /// Largest error of the count with which the wall after still matches the wall before, radians: 6 degrees at one
    /// deviation.
    pub(super) miscounted_max_rad: f64,
    /// Distance along a wall that gives its direction, metres: the length of one segment in line SLAM.
    pub(super) wall_m: f64,
    /// A wall is straight while the robot that follows it turns no more than this, radians.
    pub(super) straight_rad: f64,
}

pub(super) const WHOLE_TURNS: WholeTurnParameters = WholeTurnParameters {
    worth_sigma: 3.0e-3,
    turns_max: 3.0,
    miscounted_max_rad: 0.105,
    wall_m: 0.75,
    straight_rad: 0.12,
};

/// What the robot remembers of the last minutes, and how it chooses a turn by that.
pub(super) struct RecentCoverageParameters {
    /// Older coverage and contacts are ignored, seconds.
    pub(super) memory_s: u32,
    /// Contacts that are remembered.
    pub(super) contacts_max: usize,
    /// A ray ends this close to a contact, metres: a contact is mostly one point of a flat side.
    pub(super) contact_radius_m: f64,
    /// Turns that are compared.
    pub(super) turns: u32,
    /// Length of the ray ahead, metres.
    pub(super) ray_max_m: f64,
    /// Step of the ray ahead, metres.
    pub(super) ray_step_m: f64,
}

pub(super) const RECENT: RecentCoverageParameters = RecentCoverageParameters {
    memory_s: 600,
    contacts_max: 256,
    contact_radius_m: 0.2,
    turns: 12,
    ray_max_m: 2.5,
    ray_step_m: 2.0 * CELL_M,
};

/// A spiral on open floor.
pub(super) struct SpiralParameters {
    /// A longer straight without an encounter is on open floor, metres.
    pub(super) open_straight_m: f64,
    /// Radius of curvature at the start and at the end, metres.
    pub(super) radius_m: Range<f64>,
    /// Spacing of the turns, as a share of the swath.
    pub(super) spacing: f64,
    /// Share of the maximum turn rate that a spiral uses.
    pub(super) turn_share: f64,
}

pub(super) const SPIRAL: SpiralParameters = SpiralParameters {
    open_straight_m: 1.8,
    radius_m: 0.08..1.0,
    spacing: 0.9,
    turn_share: 0.8,
};

/// The spiral of a spot job.
pub(super) struct SpotParameters {
    /// Radius of curvature at the start, metres.
    pub(super) radius_start_m: f64,
    /// Spacing of neighbouring turns, as a share of the swath.
    pub(super) spacing: f64,
    /// Share of the maximum turn rate that the tight inner turns use.
    pub(super) turn_share: f64,
    /// Encounters until the place counts as obstructed.
    pub(super) encounters_max: u32,
    /// Random turn away from an obstacle, radians.
    pub(super) away_rad: Range<f64>,
    /// Distance to back off after a contact, metres.
    pub(super) contact_back_m: f64,
}

pub(super) const SPOT: SpotParameters = SpotParameters {
    radius_start_m: 0.06,
    spacing: 0.8,
    turn_share: 0.8,
    encounters_max: 8,
    away_rad: 1.2..2.2,
    contact_back_m: 0.04,
};

/// The strategy that alternates between bouncing and walls.
pub(super) struct WallBounceParameters {
    /// Distance of bouncing before the next drive along a wall, metres.
    pub(super) bounce_m: Range<f64>,
    /// Length of a drive along a wall, metres.
    pub(super) wall_m: Range<f64>,
    /// Turn away from the wall afterwards, radians.
    pub(super) away_rad: Range<f64>,
    /// Distance between two spirals, metres.
    pub(super) spiral_every_m: f64,
}

pub(super) const WALL_BOUNCE: WallBounceParameters = WallBounceParameters {
    bounce_m: 12.0..30.0,
    wall_m: 5.0..12.0,
    away_rad: 0.5..2.4,
    spiral_every_m: 30.0,
};

/// Bouncing away from a place where nothing else works.
pub(super) struct EscapeBounceParameters {
    /// At this distance the robot has left the place, metres.
    pub(super) away_m: f64,
    /// Longest time of bouncing, seconds.
    pub(super) time_max_s: f64,
}

pub(super) const ESCAPE_BOUNCE: EscapeBounceParameters = EscapeBounceParameters {
    away_m: 0.6,
    time_max_s: 20.0,
};

/// How much of an order must be within reach.
pub(super) struct ReachParameters {
    /// Less floor than this within reach is no job, square metres: not twice the body.
    pub(super) least_m2: f64,
    /// A smaller share of the ordered floor within reach is no job either.
    pub(super) least_share: f64,
    /// A job that swept a smaller share of what was asked is not finished.
    pub(super) finished_share: f64,
    /// What stands this near to the opening of a door stands in it, metres: half a body.
    pub(super) door_m: f64,
    /// A touch within this share of a door's width from its middle is none of its frame.
    pub(super) touched_share: f64,
}

pub(super) const REACH: ReachParameters = ReachParameters {
    least_m2: 0.2,
    least_share: 0.02,
    finished_share: 0.5,
    door_m: 0.17,
    touched_share: 0.25,
};
