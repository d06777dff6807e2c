//! Parameters of docking. Each struct belongs to the file of the same name.

use core::f64::consts::TAU;
use core::ops::Range;

/// When the phases of docking change.
pub(super) struct DockingParameters {
    /// Time for which beams are ignored after a failed approach, seconds: the next one may work better from elsewhere.
    pub(super) ignore_beams_s: f64,
    /// Time of searching at random after a known path was blocked or led to a place without beams, seconds.
    pub(super) search_s: f64,
    /// Farther than this from the dock of the map a dock that is touched is another one, metres. Who moves a dock by less need not show it.
    pub(super) other_dock_m: f64,
    /// Tries without contact of a robot that does not know where it is, after which it leaves that dock. Only later ones count.
    pub(super) unplaced_tries_max: u32,
    /// Time for which beams are ignored after that, seconds: a robot that follows walls finds out where it is.
    pub(super) ignore_other_dock_s: f64,
    /// Within this distance of a place where nothing was received no beam is expected, metres.
    pub(super) silent_radius_m: f64,
    /// The same where beams were received and the approach failed, metres: a place nearby may do.
    pub(super) missed_radius_m: f64,
    /// Returns to where beams were received, in one task.
    pub(super) back_to_beams_max: u32,
    /// Distance of roaming between two laps along the walls, metres: across a room and through a door.
    pub(super) roam_m: f64,
    /// Detour that a place on the centreline is worth, compared with one beside it, metres.
    pub(super) beside_detour_m: f64,
}

pub(super) const DOCKING: DockingParameters = DockingParameters {
    ignore_beams_s: 15.0,
    other_dock_m: 1.5,
    unplaced_tries_max: 2,
    ignore_other_dock_s: 90.0,
    search_s: 40.0,
    silent_radius_m: 0.5,
    missed_radius_m: 0.25,
    back_to_beams_max: 12,
    roam_m: 10.0,
    beside_detour_m: 0.5,
};

/// When docking ends because too much has failed.
pub(super) struct TriesParameters {
    /// Tries that failed in any way: without contact, before something in the way, without a beam.
    pub(super) all_max: u32,
    /// Visits of the dock of the map without any beam, when nothing else was tried.
    pub(super) silent_max: u32,
    /// Time since the robot stood first before the dock of the map, seconds, after which no other try begins.
    pub(super) at_dock_max_s: f64,
    /// Searches for a path to the dock of the map that found none.
    pub(super) blocked_max: u32,
    /// Time since the first of them, seconds, after which another one ends it.
    pub(super) blocked_max_s: f64,
    /// The near field begins 0.36 m before the contacts. What is touched less than this far into it, metres, is not the dock.
    pub(super) dock_depth_m: f64,
}

pub(super) const TRIES: TriesParameters = TriesParameters {
    all_max: 5,
    silent_max: 4,
    at_dock_max_s: 240.0,
    blocked_max: 4,
    blocked_max_s: 180.0,
    dock_depth_m: 0.2,
};

/// The approach by the beams.
pub(super) struct ApproachParameters {
    /// Speed beside the centreline, m/s.
    pub(super) beside_m_per_s: f64,
    /// Turn rate per radian of heading error, 1/s.
    pub(super) heading_gain_per_s: f64,
    /// Larger heading errors are corrected on the spot, radians.
    pub(super) turn_first_rad: f64,
    /// Slowest and fastest of these turns, rad/s.
    pub(super) turn_rad_per_s: Range<f64>,
    /// Back-off of a wiggle at the contacts, metres.
    pub(super) wiggle_back_m: f64,
    /// Turn of the first wiggle, radians (5 degrees). The second one turns twice as far to the other side.
    pub(super) wiggle_rad: f64,
    /// Wiggles of one try.
    pub(super) wiggles_max: u32,
    /// Distance to back off before the robot turns round for another try, metres. Only this much floor is known.
    pub(super) retry_back_m: f64,
    /// Distance to drive away for another try, metres.
    pub(super) retry_away_m: f64,
    /// The robot leaves a missed dock straight away from it, with a random deviation up to this, radians.
    pub(super) retry_spread_rad: f64,
    /// Random turn away from an obstacle on the centreline, radians.
    pub(super) obstacle_turn_rad: Range<f64>,
    /// Largest random turn to either side after a contact beside the centreline, radians.
    pub(super) contact_turn_max_rad: f64,
    /// Tries of one approach.
    pub(super) tries_max: u32,
    /// Scans that may fail or lead nowhere in one approach.
    pub(super) scans_max: u32,
    /// Angles between the direction of the dock and the path to the centreline, seen from beside the centreline,
    /// radians. The shortest path comes first, then paths past an obstacle.
    pub(super) beside_rad: [f64; 3],
    /// Longest path to the centreline, metres.
    pub(super) beside_max_m: f64,
    /// The same angle from so near that the centreline is too short, radians: away from the dock.
    pub(super) near_field_rad: f64,
    /// Length of that path, metres.
    pub(super) near_field_m: f64,
    /// The same angle from beside the dock, at its wall, radians: to a point in front of it.
    pub(super) at_wall_rad: f64,
    /// Length of that path, metres.
    pub(super) at_wall_m: f64,
    /// Surplus of the proximity level on one side that shows the wall of the dock, as a share of a touch.
    pub(super) wall_level: f64,
}

pub(super) const APPROACH: ApproachParameters = ApproachParameters {
    beside_m_per_s: 0.18,
    heading_gain_per_s: 2.5,
    turn_first_rad: 0.3,
    turn_rad_per_s: 0.4..1.2,
    wiggle_back_m: 0.03,
    wiggle_rad: 0.087,
    wiggles_max: 2,
    retry_back_m: 0.08,
    retry_away_m: 0.5,
    retry_spread_rad: 0.3,
    obstacle_turn_rad: 1.0..1.8,
    contact_turn_max_rad: 0.6,
    tries_max: 5,
    scans_max: 8,
    beside_rad: [0.9, 0.35, 0.6],
    beside_max_m: 1.5,
    near_field_rad: 2.2,
    near_field_m: 0.5,
    at_wall_rad: 1.4,
    at_wall_m: 0.75,
    wall_level: 0.1,
};

/// The drive along the centreline.
pub(super) struct CentrelineParameters {
    /// Speed far from the dock, while both lobes are received, m/s.
    pub(super) far_m_per_s: f64,
    /// Speed far from the dock, while only one lobe is received, m/s.
    pub(super) trim_m_per_s: f64,
    /// Speed in the near field, for a soft touch of the dock contacts, m/s.
    pub(super) near_m_per_s: f64,
    /// Turn back to the centreline while only one lobe is received, radians.
    pub(super) trim_rad: f64,
    /// The same in the near field, radians: smaller, because no distance is left to straighten.
    pub(super) trim_near_rad: f64,
    /// Correction of a base from beams alone when the robot loses the centreline, radians. It was measured from the edge of the
    /// centreline then, from where the dock lies up to 0.07 rad farther to the middle than the centreline leads.
    pub(super) base_step_rad: f64,
    /// Sideways distance that the robot continues after it has found the centreline again, to reach its middle, metres.
    pub(super) to_middle_m: f64,
    /// The same in the near field, metres.
    pub(super) to_middle_near_m: f64,
    /// After this distance in the near field it drives straight, metres: 0.1 m before the contacts.
    pub(super) straight_from_m: f64,
    /// The near field begins 0.36 m before the contacts. After this distance in it the robot has missed them, metres.
    pub(super) near_max_m: f64,
    /// Longest drive on the centreline, metres: beams reach 3 m.
    pub(super) drive_max_m: f64,
    /// After this time without a beam in front the centreline is lost, seconds.
    pub(super) silence_max_s: f64,
}

pub(super) const CENTRELINE: CentrelineParameters = CentrelineParameters {
    far_m_per_s: 0.2,
    trim_m_per_s: 0.12,
    near_m_per_s: 0.05,
    trim_rad: 0.22,
    trim_near_rad: 0.14,
    base_step_rad: 0.04,
    to_middle_m: 0.05,
    to_middle_near_m: 0.02,
    straight_from_m: 0.26,
    near_max_m: 0.6,
    drive_max_m: 4.0,
    silence_max_s: 1.0,
};

/// The turn that finds the direction of the dock.
pub(super) struct ScanParameters {
    /// Turn rate, rad/s. It is below the maximum, so that an edge is not blurred over many degrees.
    pub(super) turn_rad_per_s: f64,
    /// A scan that turned this far without finding both edges has failed, radians.
    pub(super) turn_max_rad: f64,
    /// Both receivers receive the dock over some 70 degrees. A much smaller or larger angle is not one dock, radians.
    pub(super) width_rad: core::ops::Range<f64>,
}

pub(super) const SCAN: ScanParameters = ScanParameters {
    turn_rad_per_s: 0.8,
    turn_max_rad: 1.6 * TAU,
    width_rad: 0.35..2.8,
};

/// The straight drives to unvisited floor.
pub(super) struct RoamParameters {
    /// Edge of a block, metres.
    pub(super) block_m: f64,
    /// Number of directions that are compared.
    pub(super) directions: u32,
    /// Step of a ray, metres.
    pub(super) ray_step_m: f64,
    /// A ray begins outside of the body, metres.
    pub(super) ray_from_m: f64,
    /// Longest ray, metres.
    pub(super) ray_max_m: f64,
    /// A ray ends this close to a contact, metres.
    pub(super) contact_radius_m: f64,
    /// Contacts kept; the oldest go first.
    pub(super) contacts_max: usize,
    /// Direction of a contact on one side from straight ahead, radians.
    pub(super) contact_bearing_rad: f64,
    /// After this distance without unseen blocks the robot looks for a better direction, metres.
    pub(super) compare_every_m: f64,
    /// A better direction crosses this many more unseen steps.
    pub(super) better_steps: f64,
    /// Worth of a step through a seen block. A step through an unseen one counts 1.
    pub(super) seen_step_worth: f64,
    /// Chance decides between directions whose values differ by less than this many steps.
    pub(super) tie_steps: f64,
    /// Smallest angle between an obstacle and the next direction, radians.
    pub(super) turn_from_obstacle_min_rad: f64,
    /// Distance to back off after a contact, metres.
    pub(super) contact_back_m: f64,
    /// Several drives in a row shorter than this, metres, mean a pocket: the robot bounces out of it.
    pub(super) short_m: f64,
    /// Number of short drives in a row that are no pocket yet.
    pub(super) short_max: u32,
    /// Time of bouncing, seconds.
    pub(super) bounce_s: f64,
}

pub(super) const ROAM: RoamParameters = RoamParameters {
    block_m: 0.5,
    directions: 32,
    ray_step_m: 0.1,
    ray_from_m: 0.3,
    ray_max_m: 5.0,
    contact_radius_m: 0.17,
    contacts_max: 400,
    contact_bearing_rad: 0.7,
    compare_every_m: 1.0,
    better_steps: 8.0,
    seen_step_worth: 0.1,
    tie_steps: 3.0,
    turn_from_obstacle_min_rad: 1.1,
    contact_back_m: 0.04,
    short_m: 0.3,
    short_max: 4,
    bounce_s: 15.0,
};
