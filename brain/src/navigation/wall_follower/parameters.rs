//! Parameters of the wall follower.

/// How the robot drives along a wall.
pub(super) struct WallControl {
    /// Gap to keep, metres. A dark wall is really nearer, a bright one farther away: half a centimetre more or less.
    pub(super) gap_m: f64,
    /// Curvature per metre of excess gap, 1/m2. With `slope_gain_per_m` an error is corrected within some 0.35 m.
    pub(super) gap_gain_per_m2: f64,
    /// Larger errors of the gap count as this one, metres.
    pub(super) gap_error_max_m: f64,
    /// Curvature for each radian of slope, 1/m.
    pub(super) slope_gain_per_m: f64,
    /// Sharpest curve towards or away from a wall, 1/m.
    pub(super) curvature_max_per_m: f64,
    /// Share of the maximum turn rate that curves use.
    pub(super) turn_share: f64,
    /// Deceleration before an obstacle ahead, m/s2.
    pub(super) brake_m_per_s2: f64,
    /// Delay from command to wheels, seconds.
    pub(super) lag_s: f64,
    /// Nearer than this to an obstacle ahead the robot turns, metres.
    pub(super) stop_m: f64,
    /// This much clearance ahead ends a turn at an inner corner, metres.
    pub(super) clear_m: f64,
    /// A wall that is not seen for this distance has ended, metres.
    pub(super) ended_m: f64,
    /// After this turn an arc leads round nothing, radians.
    pub(super) arc_max_rad: f64,
    /// After this angle a turn on the spot finds no way out, radians.
    pub(super) turn_max_rad: f64,
    /// No home has a longer straight search, metres.
    pub(super) seek_max_m: f64,
}

pub(super) const CONTROL: WallControl = WallControl {
    gap_m: 0.035,
    gap_gain_per_m2: 16.0,
    gap_error_max_m: 0.1,
    slope_gain_per_m: 8.0,
    curvature_max_per_m: 4.0,
    turn_share: 0.85,
    brake_m_per_s2: 0.3,
    lag_s: 0.15,
    stop_m: 0.03,
    clear_m: 0.16,
    ended_m: 0.02,
    arc_max_rad: 7.0,
    turn_max_rad: 7.0,
    seek_max_m: 14.0,
};

/// What contacts with a wall change.
pub(super) struct WallContacts {
    /// Distance to back off after a contact, metres.
    pub(super) back_m: f64,
    /// Radius of the arc by touch beyond that of the body, metres.
    pub(super) arc_beyond_m: f64,
    /// Turn to the left after a contact on the right, radians.
    pub(super) right_turn_rad: f64,
    /// The same after a contact ahead, radians.
    pub(super) ahead_turn_rad: f64,
    /// After a first contact on the left the robot turns right to pass there, radians.
    pub(super) left_first_turn_rad: f64,
    /// After a second contact on the left the passage is too narrow, and the robot turns left, radians.
    pub(super) left_turn_rad: f64,
    /// Each contact within `crowded_m` adds this much to the turn, radians.
    pub(super) crowded_turn_rad: f64,
    /// Contacts that add to the turn.
    pub(super) crowded_turns_max: f64,
    /// Distance within which contacts count as crowded, metres.
    pub(super) crowded_m: f64,
    /// After this many crowded contacts the robot is boxed in.
    pub(super) crowded_max: u32,
    /// Added to the gap after a contact with a wall that appeared farther away, metres: it is very dark.
    pub(super) dark_step_m: f64,
    /// Upper limit of the sum of these steps, metres.
    pub(super) dark_max_m: f64,
    /// Distance after which such a step is forgotten, metres.
    pub(super) dark_forget_m: f64,
}

pub(super) const CONTACTS: WallContacts = WallContacts {
    back_m: 0.02,
    arc_beyond_m: 0.1,
    right_turn_rad: 0.3,
    ahead_turn_rad: 0.8,
    left_first_turn_rad: -0.2,
    left_turn_rad: 1.4,
    crowded_turn_rad: 0.35,
    crowded_turns_max: 4.0,
    crowded_m: 0.25,
    crowded_max: 10,
    dark_step_m: 0.01,
    dark_max_m: 0.04,
    dark_forget_m: 3.0,
};

/// How the robot follows the edge of a cliff. Cliffs shall be met rarely: where they meet, three of them in 5 s would
/// latch the firmware (S8).
pub(super) struct WallCliffs {
    /// Turn away from a cliff, radians.
    pub(super) turn_rad: f64,
    /// Added for each recent cliff, radians.
    pub(super) recent_turn_rad: f64,
    /// Most cliffs that count as recent.
    pub(super) recent_max: u32,
    /// Distance within which a cliff is recent, metres.
    pub(super) recent_m: f64,
    /// Straight drive after a cliff, metres.
    pub(super) pass_m: f64,
    /// Radius of the arc back to a cliff beyond that of the body, metres.
    pub(super) arc_beyond_m: f64,
}

pub(super) const CLIFFS: WallCliffs = WallCliffs {
    turn_rad: 0.9,
    recent_turn_rad: 0.7,
    recent_max: 2,
    recent_m: 0.7,
    pass_m: 0.3,
    arc_beyond_m: 0.35,
};

/// How the proximity sensors show a wall.
pub(super) struct WallSensing {
    /// Lower levels are noise.
    pub(super) level_min: f64,
    /// A sensor faces sideways when its direction is nearer to the right than this, radians.
    pub(super) side_rad: f64,
    /// A sensor between this and the side sees the wall before the robot passes it, radians from the right.
    pub(super) diagonal_rad: f64,
    /// Largest angle of a wall between the two hits, radians; otherwise they are two objects.
    pub(super) slope_max_rad: f64,
}

pub(super) const SENSING: WallSensing = WallSensing {
    level_min: 0.045,
    side_rad: 0.4,
    diagonal_rad: 0.8,
    slope_max_rad: 0.6,
};

/// How fast the estimated line follows the sensors.
pub(super) struct WallEstimation {
    /// Gain of the distance correction per metre driven, 1/m.
    pub(super) gap_gain_per_m: f64,
    /// Gain of the angle correction from a distance error, radians per metre of error and metre driven.
    pub(super) slope_from_gap_per_m2: f64,
    /// Gain of the angle correction per metre driven, 1/m.
    pub(super) slope_gain_per_m: f64,
    /// A larger difference of the distance is another object, metres.
    pub(super) other_object_m: f64,
}

pub(super) const ESTIMATION: WallEstimation = WallEstimation {
    gap_gain_per_m: 25.0,
    slope_from_gap_per_m2: 200.0,
    slope_gain_per_m: 12.0,
    other_object_m: 0.05,
};
