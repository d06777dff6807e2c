//! Other robots of the same kind: what its maker's tolerances, wear and an owner's measurements leave open.
//!
//! Nobody has measured two robots of one kind. The ranges are those of data sheets and of wear: gear motors of this size differ
//! by a fifth, worn wheels by some per cent, packs by half of their capacity.

use super::RobotModel;
use crate::Pcg;

const STREAM: u64 = 0xDE71;

impl RobotModel {
    /// The robot of this seed: of the same kind and plan, with other wheels, motors, pack and loads. A host and a firmware that
    /// believe the original are miscalibrated for it.
    #[must_use]
    pub fn deviating(&self, seed: u64) -> Self {
        let random = &mut Pcg::new(seed, STREAM);
        let mut about = |value: f64, share: f64| value * (1.0 + share * random.symmetric());
        let mut robot = self.clone();
        robot.drive.count_m = about(robot.drive.count_m, 0.03);
        robot.drive.track_m = about(robot.drive.track_m, 0.03);
        let motor = &mut robot.wheel_motor;
        motor.free_speed_m_per_s = about(motor.free_speed_m_per_s, 0.15);
        motor.stall_force_n = about(motor.stall_force_n, 0.2);
        motor.idle_current_a = about(motor.idle_current_a, 0.3);
        motor.dead_band_brake = about(motor.dead_band_brake, 0.4);
        motor.dead_band_coast = about(motor.dead_band_coast, 0.15);
        motor.lag_s = about(motor.lag_s, 0.4);
        motor.traction_n = about(motor.traction_n, 0.2);
        // From a small motor to the limit of the bridge.
        motor.stall_current_a = about(1.9, 0.47);
        let cleaners = &mut robot.cleaners;
        cleaners.main_a = about(cleaners.main_a, 0.4);
        cleaners.sides_a = about(cleaners.sides_a, 0.4);
        cleaners.vacuum_a = about(cleaners.vacuum_a, 0.3);
        let battery = &mut robot.battery;
        battery.capacity_ah = about(0.85 * battery.capacity_ah, 0.35);
        battery.resistance_ohm = about(1.5 * battery.resistance_ohm, 0.6);
        battery.electronics_a = about(battery.electronics_a, 0.3);
        robot
    }
}

#[cfg(test)]
mod tests {
    use crate::RobotModel;

    #[test]
    fn every_seed_is_a_robot_of_its_own_with_the_same_plan() {
        let model = RobotModel::by_name("sr8730").expect("it comes with the project");
        let [one, other] = [1, 2].map(|seed| model.deviating(seed));
        assert_ne!(one, other);
        assert_eq!(one, model.deviating(1));
        for seed in 0..1_000 {
            let robot = model.deviating(seed);
            assert_eq!((&robot.body, &robot.cliffs), (&model.body, &model.cliffs));
            assert!((robot.drive.count_m / model.drive.count_m - 1.0).abs() <= 0.03);
            assert!((1.0..=2.8).contains(&robot.wheel_motor.stall_current_a));
            let top = robot.wheel_motor.free_speed_m_per_s;
            assert!(top > model.drive.speed_max_m_per_s, "{top}");
        }
    }
}
