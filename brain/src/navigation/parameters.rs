//! Parameters of navigation: what the chassis can do, and the gains and limits of the controllers and manoeuvres.

use core::ops::Range;

/// What the drive and the sensors of the robot can do.
pub(crate) struct ChassisParameters {
    /// Slowest speed that overcomes the dead band of the motors, m/s.
    pub(crate) speed_min_m_per_s: f64,
    /// Slowest turn that overcomes the dead band of the motors, rad/s.
    pub(crate) turn_min_rad_per_s: f64,
    /// Turn rate per radian of remaining turn on the spot, 1/s: the robot brakes over the last part.
    pub(crate) turn_gain_per_s: f64,
    /// Reverse speed after a contact, m/s.
    pub(crate) back_m_per_s: f64,
    /// Reverse speed at a cliff, m/s. The firmware allows 0.1 m/s (S8).
    pub(crate) back_at_cliff_m_per_s: f64,
    /// Proximity level above which contact is near: about 7 cm for the sensors of the SR8730.
    pub(crate) near_level: f32,
    /// Speed with an obstacle close ahead, for a soft contact, m/s.
    pub(crate) near_m_per_s: f64,
    /// An obstacle that overlaps the robot's corridor by less than this is passed without a touch, metres.
    pub(crate) graze_m: f64,
}

pub(crate) const CHASSIS: ChassisParameters = ChassisParameters {
    speed_min_m_per_s: 0.05,
    turn_min_rad_per_s: 0.4,
    turn_gain_per_s: 4.0,
    back_m_per_s: 0.15,
    back_at_cliff_m_per_s: 0.08,
    near_level: 0.45,
    near_m_per_s: 0.12,
    graze_m: 0.008,
};

/// Backing off, turning on the spot and swinging.
pub(super) struct ManoeuvreParameters {
    /// A free robot keeps this much of its reverse budget, metres: it must be able to back off from a contact during the
    /// turn.
    pub(super) reserve_m: f64,
    /// Below this remaining angle a turn is finished, radians.
    pub(super) turn_done_rad: f64,
    /// Extra time of a manoeuvre beyond what its length needs, seconds.
    pub(super) grace_s: f64,
    /// Backing without movement for this long is over, seconds: an obstacle is behind.
    pub(super) blocked_s: f64,
    /// Share of the commanded speed below which the robot does not move.
    pub(super) blocked_share: f64,
    /// Speed of a swing, m/s.
    pub(super) swing_m_per_s: f64,
    /// Turn rate of a swing, rad/s.
    pub(super) swing_rad_per_s: f64,
}

pub(super) const MANOEUVRE: ManoeuvreParameters = ManoeuvreParameters {
    reserve_m: 0.04,
    turn_done_rad: 0.03,
    grace_s: 1.0,
    blocked_s: 0.4,
    blocked_share: 0.2,
    swing_m_per_s: -0.1,
    swing_rad_per_s: 1.2,
};

/// Evading a contact or a cliff.
pub(crate) struct EvasionParameters {
    /// Distance to back off at a cliff, metres. The sensors lead the wheels by little, so the robot must clear the edge
    /// before it turns.
    pub(crate) cliff_back_m: f64,
    /// Longest back-off at a cliff, metres. The firmware ends reversing after 0.15 m (S8).
    pub(crate) cliff_back_max_m: f64,
    /// Longest back-off after a contact beyond the requested distance, metres.
    pub(crate) contact_extra_max_m: f64,
    /// Distance to back straight from an edge on one side, metres. Who still sees the edge then drives along it, and turns away from it.
    pub(crate) straight_m: f64,
    /// Distance that is added each time the bumper is still pressed or the floor still missing, metres.
    pub(crate) extra_m: f64,
    /// Contacts during the turn until the robot counts as held.
    pub(crate) turn_contacts_max: u32,
}

pub(crate) const EVASION: EvasionParameters = EvasionParameters {
    cliff_back_m: 0.08,
    cliff_back_max_m: 0.14,
    contact_extra_max_m: 0.12,
    straight_m: 0.04,
    extra_m: 0.02,
    turn_contacts_max: 3,
};

/// Turning away from one held side.
pub(super) struct TurnFreeParameters {
    /// Share of the turn at which the wheel beside an edge would stand: it must not go forward, whatever the controller does.
    pub(super) wheel_share: f64,
    /// Largest turn, radians.
    pub(super) turn_max_rad: f64,
    /// Longest time, seconds. The firmware takes a bumper for stuck that does not come free for ten (S7).
    pub(super) time_max_s: f64,
}

pub(super) const TURN_FREE: TurnFreeParameters = TurnFreeParameters {
    wheel_share: 0.9,
    turn_max_rad: 1.0,
    time_max_s: 4.0,
};

/// The controller that follows a path.
pub(super) struct PathFollowerParameters {
    /// Steering per heading error, rad/s for each radian. Together with `offset_gain` it removes an offset within some
    /// 0.4 m at cruise speed, without oscillation.
    pub(super) heading_gain_per_s: f64,
    /// Steering for an offset, rad/s for each metre of offset and m/s of speed.
    pub(super) offset_gain: f64,
    /// Smaller corrections are omitted, so that straights are really straight, rad/s. Calibrating the gyro needs that.
    pub(super) steer_min_rad_per_s: f64,
    /// Deceleration and acceleration, m/s2: below the 0.5 m/s2 of the firmware, so that it can follow.
    pub(super) brake_m_per_s2: f64,
    /// Delay from command to wheels, seconds: arcs start this much earlier.
    pub(super) lag_s: f64,
    /// A turn on the spot ends when less than this is left, radians. Steering does the rest.
    pub(super) turn_done_rad: f64,
    /// A longer turn on the spot keeps its direction, radians, though the other direction may be shorter by now.
    pub(super) half_turn_from_rad: f64,
    /// Share of the maximum turn rate that arcs use: the rest is for steering. With 0.8 known homes take 0.01 to 0.1 T0
    /// longer to 90 %, with 0.95 the robot touches furniture more often.
    pub(super) arc_share: f64,
    /// With less clearance ahead than this, and less than `next_segment_left_m` left of a segment, the robot goes on
    /// with the next one, metres. At the end of a path its sensors are more accurate than its pose.
    pub(super) next_segment_clear_m: f64,
    /// As `next_segment_clear_m`, metres.
    pub(super) next_segment_left_m: f64,
    /// Offsets from a straight at which the robot is keeping away from an obstacle, metres.
    pub(super) keeps_away_m: Range<f64>,
    /// Farther from the path than this the robot has left it, metres.
    pub(super) lost_m: f64,
    /// With a larger heading error the robot turns on the spot before it drives on, radians.
    pub(super) turn_first_rad: f64,
    /// Smallest share of the speed that a robot with a heading error drives at.
    pub(super) facing_min: f64,
}

pub(super) const PATH_FOLLOWER: PathFollowerParameters = PathFollowerParameters {
    heading_gain_per_s: 3.5,
    offset_gain: 40.0,
    steer_min_rad_per_s: 0.03,
    brake_m_per_s2: 0.4,
    lag_s: 0.25,
    turn_done_rad: 0.06,
    half_turn_from_rad: 2.0,
    arc_share: 0.9,
    next_segment_clear_m: 0.02,
    next_segment_left_m: 0.08,
    keeps_away_m: 0.005..0.03,
    lost_m: 0.25,
    turn_first_rad: 1.2,
    facing_min: 0.2,
};

/// The corrections from sensors and map for a robot that follows a path.
pub(super) struct CautionParameters {
    /// Lower proximity levels are too far away to matter.
    pub(super) level_min: f64,
    /// Approach speed, m/s for each metre of clearance beyond `stop_distance_m`.
    pub(super) approach_gain_per_s: f64,
    /// As `approach_gain_per_s`, metres.
    pub(super) stop_distance_m: f64,
    /// A smaller gap at a side is widened, metres.
    pub(super) gap_min_m: f64,
    /// Sideways correction per metre of missing gap.
    pub(super) aside_gain: f64,
    /// An obstacle closer to the centre line of the corridor than this share of the radius is ahead and not at a side.
    pub(super) side_share: f64,
    /// Obstacles farther back than this are ignored, metres.
    pub(super) behind_m: f64,
    /// Offset to the other side for a sensor without distance, metres.
    pub(super) near_aside_m: f64,
}

pub(super) const CAUTION: CautionParameters = CautionParameters {
    level_min: 0.2,
    approach_gain_per_s: 2.5,
    stop_distance_m: 0.01,
    gap_min_m: 0.02,
    aside_gain: 2.0,
    side_share: 0.5,
    behind_m: -0.03,
    near_aside_m: 0.02,
};

/// The drive along a contour by touch.
pub(super) struct ContourTraceParameters {
    /// Speed along the contour, m/s, for soft contacts.
    pub(super) speed_m_per_s: f64,
    /// Radius of the arcs towards the contour, metres.
    pub(super) arc_radius_m: f64,
    /// After this turn without a contact the contour is lost, radians.
    pub(super) lost_rad: f64,
    /// Distance to back off after a touch, metres.
    pub(super) back_m: f64,
    /// Turns away from a contact on the side of the contour, radians: large, for long steps.
    pub(super) coarse_turn_rad: Range<f64>,
    /// The same, small, into gaps that are hardly wider than the body.
    pub(super) fine_turn_rad: Range<f64>,
    /// Turns away from a contact ahead, radians.
    pub(super) ahead_turn_rad: Range<f64>,
    /// Turns away from a cliff, radians.
    pub(super) cliff_turn_rad: Range<f64>,
}

pub(super) const CONTOUR_TRACE: ContourTraceParameters = ContourTraceParameters {
    speed_m_per_s: 0.2,
    arc_radius_m: 0.3,
    lost_rad: 5.5,
    back_m: 0.025,
    coarse_turn_rad: 0.3..0.9,
    fine_turn_rad: 0.2..0.5,
    ahead_turn_rad: 0.6..1.2,
    cliff_turn_rad: 0.8..1.3,
};

/// The contacts that block planned paths.
pub(super) struct ObstructionParameters {
    /// An obstruction is remembered for this long, microseconds.
    pub(super) kept_us: u64,
    /// Contacts kept; the oldest go first.
    pub(super) kept_max: usize,
    /// Two contacts nearer than this are with the same object, metres.
    pub(super) same_object_m: f64,
    /// A contact this near to an obstacle of the map is with that, metres.
    pub(super) known_object_m: f64,
    /// Direction of a contact on one side from straight ahead without better information, radians.
    pub(super) side_bearing_rad: f64,
    /// Uncertainty on either side of `side_bearing_rad`, radians.
    pub(super) side_spread_rad: f64,
    /// Uncertainty on either side of straight ahead when both halves of the bumper are pressed, radians.
    pub(super) ahead_spread_rad: f64,
    /// Proximity level of a sensor that faces the touched object.
    pub(super) touch_level: f32,
}

pub(super) const OBSTRUCTION: ObstructionParameters = ObstructionParameters {
    kept_us: 240_000_000,
    kept_max: 64,
    same_object_m: 0.12,
    known_object_m: 0.06,
    side_bearing_rad: 0.7,
    side_spread_rad: 0.35,
    ahead_spread_rad: 0.2,
    touch_level: 0.5,
};

/// Arcs at the corners of a path.
pub(super) struct SmoothingParameters {
    /// Longest part of a straight that an arc replaces at a corner, metres.
    pub(super) cut_max_m: f64,
    /// The same at the corners of rings, metres: the next ring does not sweep what an arc cuts off.
    pub(super) ring_cut_max_m: f64,
    /// An arc that replaces less than this is no better than a turn on the spot, metres.
    pub(super) cut_min_m: f64,
    /// A tighter arc takes as long as a turn on the spot, and a robot that enters it slightly early is off the path at
    /// once, metres.
    pub(super) radius_min_m: f64,
    /// Turns that an arc can make, radians. Sharper corners are turned on the spot, slighter ones need no arc.
    pub(super) arc_turn_rad: Range<f64>,
    /// Smaller turns are left to steering, radians.
    pub(super) slight_turn_rad: f64,
}

pub(super) const SMOOTHING: SmoothingParameters = SmoothingParameters {
    cut_max_m: 0.15,
    ring_cut_max_m: 0.08,
    cut_min_m: 0.02,
    radius_min_m: 0.05,
    arc_turn_rad: 0.1..2.5,
    slight_turn_rad: 0.01,
};
