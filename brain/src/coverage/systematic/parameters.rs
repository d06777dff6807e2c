//! Parameters of the systematic strategy.

/// How the robot leaves obstacles and its plans.
pub(super) struct SystematicParameters {
    /// Distance to back off after a contact, metres: far enough to turn.
    pub(super) contact_back_m: f64,
    /// Distance to back off from an obstacle seen ahead, metres.
    pub(super) seen_back_m: f64,
    /// Additional back-off for each plan in a row without effect, metres.
    pub(super) more_back_m: f64,
    /// Turn away from an unknown cliff, radians.
    pub(super) cliff_turn_rad: f64,
    /// A plan is discarded farther than this from its start, metres: back-offs get longer than expected.
    pub(super) off_start_m: f64,
    /// Longest drive along walls before the robot goes on with its pose estimate, metres: once around a large home, so
    /// the map may be of another one.
    pub(super) relocalization_max_m: f64,
}

pub(super) const SYSTEMATIC: SystematicParameters = SystematicParameters {
    contact_back_m: 0.03,
    seen_back_m: 0.02,
    more_back_m: 0.02,
    cliff_turn_rad: 1.2,
    off_start_m: 0.06,
    relocalization_max_m: 120.0,
};

/// What a plan is worth, and when the robot gives up.
pub(super) struct EvaluationParameters {
    /// A plan that swept less than this had no effect, square metres.
    pub(super) nothing_m2: f64,
    /// Plans in a row without effect until the robot bounces out of the place.
    pub(super) failed_plans_max: u32,
    /// Times that obstructions are forgotten for another attempt before `fresh_won_m2` were swept.
    pub(super) fresh_starts_max: u32,
    /// Times that the robot bounces out of a place before `fresh_won_m2` were swept.
    pub(super) escapes_max: u32,
    /// The same while a part of the home is cut off: giving up would leave all of that.
    pub(super) escapes_cut_off_max: u32,
    /// Newly swept floor that justifies a fresh start, square metres.
    pub(super) fresh_won_m2: f64,
    /// Below this share of the floor that was reachable at any time, something is cut off. A map drawn with a pose error
    /// of centimetres loses only a little floor along the walls.
    pub(super) whole_share: f64,
    /// Unswept floor that is worth waiting for people to leave, as a share of the floor that was reachable at any time.
    pub(super) rest_share: f64,
    /// A plan that finds less than this share of the counted floor belongs to a robot that is cut off from the rest, or
    /// outside of the walls on its map.
    pub(super) elsewhere_share: f64,
    /// Floor that is cut off since before the job counts as at most so much more than the reachable floor, as the inverse share.
    pub(super) connected_share_min: f64,
}

pub(super) const EVALUATION: EvaluationParameters = EvaluationParameters {
    nothing_m2: 0.02,
    failed_plans_max: 4,
    fresh_starts_max: 2,
    escapes_max: 6,
    escapes_cut_off_max: 18,
    fresh_won_m2: 0.5,
    whole_share: 0.85,
    rest_share: 0.05,
    elsewhere_share: 0.5,
    connected_share_min: 0.05,
};

/// When what is left is not worth its time.
pub(super) struct GainParameters {
    /// So much floor, square metres, must be won ...
    pub(super) worth_m2: f64,
    /// ... within so much time of work, microseconds. Open floor wins 1.5 to 2 square metres a minute.
    pub(super) within_us: u64,
    /// A longer time between two steps was no work, microseconds.
    pub(super) step_max_us: u64,
}

pub(super) const GAIN: GainParameters = GainParameters {
    worth_m2: 0.5,
    within_us: 360_000_000,
    step_max_us: 1_000_000,
};

/// What the robot knows of the outline of its home.
pub(super) struct OutlineParameters {
    /// If less than this share of the known free floor is reachable after the lap, the map wrongly encloses the robot.
    pub(super) shut_in_share: f64,
    /// Most laps along walls in a job.
    pub(super) laps_max: u32,
    /// Width of a small optimistic margin, metres.
    pub(super) margin_near_m: f64,
    /// Width of an optimistic margin of the size of a room, metres.
    pub(super) margin_far_m: f64,
    /// A robot without proximity sensors plans on a map that shows this much free floor, square metres.
    pub(super) known_m2: f64,
}

pub(super) const OUTLINE: OutlineParameters = OutlineParameters {
    shut_in_share: 0.4,
    laps_max: 4,
    margin_near_m: 0.6,
    margin_far_m: 2.5,
    known_m2: 4.0,
};

/// The drive through a gap that is slightly too narrow on the map.
pub(super) struct SqueezeParameters {
    /// Floor that must become reachable, square metres.
    pub(super) worth_m2: f64,
    /// Width of the optimistic margin, metres.
    pub(super) margin_m: f64,
    /// Reduction of the planned radius, metres: half a cell, since cells count as a whole.
    pub(super) slimmer_m: f64,
    /// Attempts until some floor is gained.
    pub(super) tries_max: u32,
    /// Floor nearer than this to the reachable floor is not new, cells: a slimmer body gets nearer to all walls.
    pub(super) near_cells: i32,
}

pub(super) const SQUEEZE: SqueezeParameters = SqueezeParameters {
    worth_m2: 0.4,
    margin_m: 1.2,
    slimmer_m: 0.0125,
    tries_max: 3,
    near_cells: 3,
};

/// Stopping before obstacles that are seen ahead, and keeping away from those that were touched.
pub(super) struct StandoffParameters {
    /// Distance at which it stops before an apparent wall, metres: the path along the wall sweeps the rest.
    pub(super) stop_m: f64,
    /// Additional distance after a touch of something that appeared farther away, metres.
    pub(super) dark_step_m: f64,
    /// Upper limit of the additional distance, metres.
    pub(super) dark_max_m: f64,
    /// What appeared farther away than this at the touch is a different object, metres.
    pub(super) same_object_m: f64,
    /// Distance after which a step of `dark_step_m` is forgotten, metres.
    pub(super) dark_forget_m: f64,
    /// Offset from the path to the other side after a touch on one side, metres.
    pub(super) contact_offset_m: f64,
    /// Distance for which that offset holds, metres.
    pub(super) contact_offset_for_m: f64,
}

pub(super) const STANDOFF: StandoffParameters = StandoffParameters {
    stop_m: 0.02,
    dark_step_m: 0.01,
    dark_max_m: 0.03,
    same_object_m: 0.05,
    dark_forget_m: 10.0,
    contact_offset_m: 0.015,
    contact_offset_for_m: 0.5,
};

/// The track whose points may still be corrected.
pub(super) struct RecentTrackParameters {
    /// Distance between two track points, metres.
    pub(super) step_m: f64,
    /// Points kept; the oldest are settled.
    pub(super) kept_max: usize,
    /// Corrections are distributed once they add up to this, metres.
    pub(super) distributed_from_m: f64,
    /// A smaller share of a correction is dropped.
    pub(super) share_min: f64,
    /// Distance over which a correction fades, metres, however uncertain the pose: errors of the wheel calibration are
    /// corrected all the time and do not reach far back.
    pub(super) fade_m: f64,
    /// Smaller errors are ignored, metres: lanes overlap by this much.
    pub(super) tolerance_m: f64,
    /// A larger jump is no pose error: the robot was carried, metres.
    pub(super) carried_m: f64,
}

pub(super) const RECENT_TRACK: RecentTrackParameters = RecentTrackParameters {
    step_m: 0.0125,
    kept_max: 1_600,
    distributed_from_m: 0.003,
    share_min: 0.05,
    fade_m: 15.0,
    tolerance_m: 0.02,
    carried_m: 0.5,
};
