//! Parameters of behavior: times of the link and of arming, limits of charging, and rests for the gyro.

use core::ops::Range;

/// How the robot announces, arms and stops (S24).
pub(super) struct ArmingParameters {
    /// Length of the beeps and the two seconds after them (S24), microseconds.
    pub(super) announcement_us: u64,
    /// Pause between two attempts to arm, microseconds.
    pub(super) again_us: u64,
    /// The firmware must confirm arming within this time, microseconds.
    pub(super) confirmed_within_us: u64,
    /// The firmware may stay disarmed for this long, microseconds, before the job is interrupted.
    pub(super) unarmed_max_us: u64,
    /// An outage of the link up to this length, microseconds, needs no new announcement, because nobody has had time to
    /// come near.
    pub(super) short_outage_us: u64,
    /// After a motion mode ends, standing still is commanded this long, microseconds; then the leases are left to run
    /// out.
    pub(super) halt_us: u64,
}

pub(super) const ARMING: ArmingParameters = ArmingParameters {
    announcement_us: 5 * 150_000 + 2_000_000,
    again_us: 500_000,
    confirmed_within_us: 3_000_000,
    unarmed_max_us: 3_000_000,
    short_outage_us: 5_000_000,
    halt_us: 500_000,
};

/// The return for charge, and what counts as docked.
pub(super) struct ChargingParameters {
    /// Below this charge the path home is searched, as a share of a full charge.
    pub(super) return_check_below: f32,
    /// Time until it is searched again, microseconds, because each search is a plan.
    pub(super) return_check_us: u64,
    /// Contacts that open this soon after they have closed, microseconds, touched at their edge, though the robot rolled.
    pub(super) slips_off_us: u64,
    /// The same while the robot stood still: springs of the contacts settle, and a dirty one burns free or not.
    pub(super) settles_off_us: u64,
    /// How often the robot docks again after that.
    pub(super) slips_max: u32,
    /// Current must flow within this time, microseconds, if it can be expected at all. The firmware checks dock and pack
    /// for some seconds before it enables the charger, and reports the current once a second.
    pub(super) flow_within_us: u64,
    /// The robot undocks and docks again this often, because the contacts may close better the next time.
    pub(super) no_current_tries_max: u32,
    /// A run that leaves more than this share of the known floor retries from the dock. (One of 75 first runs of
    /// generated homes left 0.27 of it; from the dock it reached 0.97.)
    pub(super) retry_left_share: f64,
    /// With this charge it retries at once and does not wait for more, as a share of a full charge.
    pub(super) retry_charge: f32,
    /// In a known home it waits on the dock for so long before that, microseconds: the way there and back takes a minute or two, and few
    /// people stand in a door for more than five.
    pub(super) retry_wait_us: u64,
}

pub(super) const CHARGING: ChargingParameters = ChargingParameters {
    return_check_below: 0.5,
    return_check_us: 20_000_000,
    slips_off_us: 2_000_000,
    settles_off_us: 30_000_000,
    slips_max: 3,
    flow_within_us: 20_000_000,
    no_current_tries_max: 2,
    retry_left_share: 0.1,
    retry_charge: 0.5,
    retry_wait_us: 180_000_000,
};

/// When the contacts of the dock count as lost, and as closed again.
pub(super) struct DockContactParameters {
    /// Contacts must be open for this long, microseconds, before a loss is told: dirt makes them flicker once a second.
    pub(super) judged_after_us: u64,
    /// After a loss the contacts must hold for this long, microseconds. It doubles with each further loss.
    pub(super) holds_us: u64,
    /// Doublings at most.
    pub(super) doublings_max: u32,
    /// Travel that shows that somebody has moved the robot, metres: the contacts of a dock close over some 2 cm.
    pub(super) moved_m: f64,
    /// Turn that shows the same, radians.
    pub(super) turned_rad: f64,
    /// Motion that ended this long before the contacts opened, microseconds, has nothing to do with it.
    pub(super) at_rest_us: u64,
    /// A wheel that hangs for so long on closed contacts, microseconds, hangs by its switch alone.
    pub(super) sticks_us: u64,
    /// Slower turns are bias of the gyro, rad/s.
    pub(super) turning_rad_per_s: f64,
}

pub(super) const CONTACTS: DockContactParameters = DockContactParameters {
    judged_after_us: 2_000_000,
    holds_us: 5_000_000,
    doublings_max: 4,
    moved_m: 0.015,
    turned_rad: 0.1,
    at_rest_us: 1_000_000,
    sticks_us: 3_000_000,
    turning_rad_per_s: 0.1,
};

/// How well the bias of the gyro must be measured before the first motion of a job.
pub(super) struct GyroSettlingParameters {
    /// Standard deviation of the bias after a rest of two seconds, rad/s. It turns a map by two degrees a minute at
    /// most.
    pub(super) tracked_sigma_rad_per_s: f64,
    /// The same after twelve seconds, for a robot that is about to draw a map. Until the first wall it has no other
    /// source of heading, and the whole map is rotated by the error up to then.
    pub(super) mapping_sigma_rad_per_s: f64,
    /// Longest wait for that, seconds.
    pub(super) wait_max_s: f64,
    /// Distance by which a robot that was put down against something backs off before it waits, metres at most.
    pub(super) backed_max_m: f64,
}

pub(super) const GYRO_SETTLING: GyroSettlingParameters = GyroSettlingParameters {
    tracked_sigma_rad_per_s: 6.0e-4,
    mapping_sigma_rad_per_s: 2.0e-4,
    wait_max_s: 16.0,
    backed_max_m: 0.1,
};

/// How the robot leaves the dock.
pub(super) struct DepartureParameters {
    /// Reverse travel from the dock before turning away, metres. No more, because contacts may close without a dock, and
    /// the ground behind is unknown then.
    pub(super) back_m: f64,
    /// Reverse travel from what is touched when a job ends, metres.
    pub(super) end_back_m: f64,
    /// Random turn away from the dock, radians.
    pub(super) turn_rad: Range<f64>,
}

pub(super) const DEPARTURE: DepartureParameters = DepartureParameters {
    back_m: 0.15,
    end_back_m: 0.04,
    turn_rad: 2.2..3.1,
};
