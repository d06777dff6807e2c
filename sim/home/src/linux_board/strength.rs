//! How strongly a beacon at 2.4 GHz (Bluetooth, Wi-Fi) is received in a home.
//!
//! Log-distance path loss, losses of obstacles in the line of sight, and a shadowing that is a function of the place
//! and does not average out over time. Besides, the robot's own body shades its antenna by where it points, and each
//! packet fades by itself. Figures: exponent and shadowing of Recommendation ITU-R P.1238 for homes, walls of COST 231
//! (light walls 3.4 dB, heavy ones 6.9 dB), power in one metre of usual tags.

use super::beacons::Beacon;
use crate::{Home, Pcg, Pose};

/// Received power in one metre, dBm, and its deviation from beacon to beacon.
const AT_1_M_DBM: f64 = -59.0;
const BEACON_SIGMA_DB: f64 = 4.0;
/// Path loss exponent without obstacles.
const EXPONENT: f64 = 1.9;
/// Nearer than this it does not get stronger, metres.
const NEAREST_M: f64 = 0.3;
/// Loss of each obstacle, decibels, and the largest total loss: a strongly shaded signal arrives by diffraction.
const OBSTACLE_DB: f64 = 4.5;
const OBSTACLES_MAX_DB: f64 = 20.0;
/// Deviation of the shadowing where it is drawn, decibels, and how far these places are apart, metres. Between them it
/// is interpolated, which leaves 4 dB on average.
const SHADOW_DB: f64 = 6.0;
const SHADOW_M: f64 = 1.2;
/// By how much the robot's own body shades its antenna when that points away, decibels, up and down.
const BODY_DB: f64 = 2.0;
/// Deviation of a packet, decibels.
const FADING_DB: f64 = 3.5;
/// Sampling step along the line of sight, metres, and consecutive solid samples that count as an obstacle.
const LOOK_M: f64 = 0.04;
const SOLID_STEPS: u32 = 2;
/// Weaker ones are not received, dBm.
const WEAKEST_DBM: f64 = -95.0;

/// The air of a home. The same seed gives the same air.
#[derive(Clone, Copy, Debug)]
pub(super) struct Air {
    seed: u64,
}

impl Air {
    pub(super) const fn new(seed: u64) -> Self {
        Self { seed }
    }

    /// Received power of a packet in whole dBm, as radios report it, if it is received.
    pub(super) fn receive(mean_dbm: f64, random: &mut Pcg) -> Option<f64> {
        let dbm = mean_dbm + FADING_DB * random.normal();
        (dbm >= WEAKEST_DBM).then(|| libm::round(dbm))
    }

    /// Power of a beacon before the fading of a packet.
    pub(super) fn mean_dbm(self, home: &Home, pose: Pose, Beacon { number, place }: Beacon) -> f64 {
        let (dx, dy) = (place.0 - pose.x_m, place.1 - pose.y_m);
        let away_m = libm::hypot(dx, dy).max(NEAREST_M);
        let walls = obstacles_between(home, (pose.x_m, pose.y_m), place);
        let obstacle_loss_db = (OBSTACLE_DB * f64::from(walls)).min(OBSTACLES_MAX_DB);
        let aside_rad = libm::atan2(dy, dx) - pose.heading_rad;
        AT_1_M_DBM + BEACON_SIGMA_DB * self.drawn(number, [i64::MAX, i64::MAX])
            - 10.0 * EXPONENT * libm::log10(away_m)
            - obstacle_loss_db
            + SHADOW_DB * self.shadow(number, pose)
            + BODY_DB * libm::cos(aside_rad)
    }

    /// Shadowing of a beacon at a place, of deviation 1 where it is drawn.
    fn shadow(self, number: u16, pose: Pose) -> f64 {
        let (x, y) = (pose.x_m / SHADOW_M, pose.y_m / SHADOW_M);
        let (left, below) = (libm::floor(x), libm::floor(y));
        let at = |right: i64, above: i64| self.drawn(number, [left as i64 + right, below as i64 + above]);
        let (right, above) = (x - left, y - below);
        let lower = (1.0 - right) * at(0, 0) + right * at(1, 0);
        let upper = (1.0 - right) * at(0, 1) + right * at(1, 1);
        (1.0 - above) * lower + above * upper
    }

    /// A normal number that belongs to a beacon and a place.
    fn drawn(self, number: u16, patch: [i64; 2]) -> f64 {
        let mut hash = self.seed ^ u64::from(number).wrapping_mul(0xd6e8_feb8_6659_fd93);
        hash ^= (patch[0] as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^= (patch[1] as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        Pcg::new(hash, u64::from(number)).normal()
    }
}

/// Obstacles in the line of sight that are larger than a leg of a chair.
fn obstacles_between(home: &Home, from: (f64, f64), to: (f64, f64)) -> u32 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let steps = libm::ceil(libm::hypot(dx, dy) / LOOK_M).max(1.0) as u32;
    let (mut things, mut solid) = (0, 0);
    for step in 1..steps {
        let share = f64::from(step) / f64::from(steps);
        let is_solid = home
            .grid()
            .at(from.0 + share * dx, from.1 + share * dy)
            .is_solid();
        solid = if is_solid { solid + 1 } else { 0 };
        things += u32::from(solid == SOLID_STEPS);
    }
    things
}

#[cfg(test)]
mod tests {
    use super::{Air, Beacon};
    use crate::{Home, Pcg, Pose, RobotModel};

    const PLAN: &str = "format = \"librervac-home\"\nversion = 1\n\
        [[room]]\npolygon = [[0, 0], [4, 0], [4, 4], [0, 4]]\n";

    fn mean_dbm(air: Air, home: &Home, at: Pose, place: (f64, f64)) -> f64 {
        let mut random = Pcg::new(1, 1);
        let heard: Vec<f64> = (0..400)
            .filter_map(|_| Air::receive(air.mean_dbm(home, at, Beacon { number: 0, place }), &mut random))
            .collect();
        heard.iter().sum::<f64>() / heard.len() as f64
    }

    #[test]
    fn strengths_fall_with_the_distance_and_are_wrong_in_the_same_way_at_the_same_place() {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("room", PLAN, &model).unwrap();
        let (mut fall_db, mut spread_db) = (Vec::new(), Vec::new());
        for seed in 0..60 {
            let air = Air::new(seed);
            let dbm = |away_m: f64| mean_dbm(air, &home, Pose::new(0.3 + away_m, 2.0, 0.0), (0.3, 2.0));
            let (near, far) = (dbm(0.4), dbm(3.2));
            assert!((dbm(3.2) - far).abs() < 1e-9, "the place decides");
            fall_db.push(near - far);
            spread_db.push((near - far - 10.0 * 1.9 * 8.0_f64.log10()).abs());
        }
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        // 19 dB a decade over a factor of eight, and what shadowing adds at both ends.
        assert!((mean(&fall_db) - 17.2).abs() < 3.0, "{}", mean(&fall_db));
        assert!(mean(&spread_db) > 2.0, "{}", mean(&spread_db));
    }
}
