//! What runs do to a robot.

use home::RobotModel;
use rvac_sim::Household;
use serde::Serialize;

/// Part of the wheels' radius that a run takes.
const WHEEL_A_RUN: f64 = 0.0005;
/// Part by which the brush's motor draws more with each run.
const BRUSH_A_RUN: f64 = 0.03;
/// Bias of the gyro of a warm robot, radians per second: 0.01 degrees per second and kelvin, 18 K.
const WARM_RAD_PER_S: f64 = 0.18 * core::f64::consts::PI / 180.0;
/// Time constant of its warming, seconds.
const WARMING_S: f64 = 900.0;

/// Which parts wear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wear {
    /// The radius of the wheels falls from run to run.
    pub wheels: bool,
    /// The bias of the gyro follows the temperature of the robot during a run.
    pub gyro: bool,
    /// The brush gets hard to turn from run to run.
    pub brush: bool,
}

impl Wear {
    /// The robot as it is in a run, counted from 1.
    #[must_use]
    pub fn model(self, model: &RobotModel, run: u32) -> RobotModel {
        let mut worn = model.clone();
        if self.wheels {
            worn.drive.count_m *= 1.0 - WHEEL_A_RUN * f64::from(run - 1);
        }
        worn
    }

    /// At the beginning of a run.
    pub(crate) fn begin(self, household: &mut Household, run: u32) {
        if self.brush {
            let times = 1.0 + BRUSH_A_RUN * f64::from(run - 1);
            household.robot_mut().world_mut().wind_brush(times);
        }
    }

    /// After each second of a run.
    pub(crate) fn pass_second(self, household: &mut Household) {
        if self.gyro {
            let now_s = household.robot().now_ms() as f64 / 1000.0;
            let bias = |s: f64| WARM_RAD_PER_S * (1.0 - (-s / WARMING_S).exp());
            let shift = bias(now_s) - bias((now_s - 1.0).max(0.0));
            household.robot_mut().world_mut().shift_gyro_bias(shift);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Wear;
    use home::RobotModel;

    #[test]
    fn only_what_is_named_wears() {
        let model = RobotModel::by_name("sr8730").expect("comes with the project");
        assert_eq!(Wear::default().model(&model, 30), model);
        let wheels = Wear {
            wheels: true,
            ..Wear::default()
        };
        assert_eq!(wheels.model(&model, 1), model);
        let worn = wheels.model(&model, 11);
        assert!((worn.drive.count_m / model.drive.count_m - 0.995).abs() < 1e-9);
        assert_eq!(worn.body, model.body);
    }
}
