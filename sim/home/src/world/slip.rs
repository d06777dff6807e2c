//! From the wheels' distances to the motion of the body on a floor.

use super::wheel::WheelErrors;
use crate::model::RobotModel;
use crate::plan::Surface;
use crate::{Noise, Pcg};

/// Errors of both wheels.
pub(crate) struct BothWheels {
    pub(crate) left: WheelErrors,
    pub(crate) right: WheelErrors,
}

/// Steps over which one draw is spread: a wheel slips for a while, it does not tremble.
pub(crate) const DRAW_STEPS: u64 = 128;

/// Random slip: a random walk over the distance. Every [`DRAW_STEPS`] milliseconds an error is drawn for the distance driven in
/// them and spread over the next ones.
#[derive(Clone, Debug)]
pub(crate) struct Slip {
    track_m: f64,
    slip_m_per_sqrt_m: f64,
    slip_rad_per_sqrt_m: f64,
    rug_drift: f64,
    /// Distance since the last draw, metres.
    distance_m: f64,
    /// Present errors of each step.
    stretch_m: f64,
    bend_rad: f64,
}

impl Slip {
    /// Draws what stays the same for the whole run.
    pub(crate) fn new(model: &RobotModel, noise: &Noise, random: &mut Pcg) -> (Self, BothWheels) {
        let scale = 1.0 + noise.encoder_scale * random.normal();
        let uneven = 0.5 * model.drive.track_m * noise.asymmetry_rad_per_m * random.normal();
        let wheel = |factor: f64| WheelErrors {
            distance_factor: scale * factor,
            backlash_m: noise.backlash_m,
        };
        let slip = Self {
            track_m: model.drive.track_m * (1.0 + noise.turn_scale * random.normal()),
            slip_m_per_sqrt_m: noise.slip_m_per_sqrt_m,
            slip_rad_per_sqrt_m: noise.slip_rad_per_sqrt_m,
            rug_drift: noise.rug_drift,
            distance_m: 0.0,
            stretch_m: 0.0,
            bend_rad: 0.0,
        };
        let both = BothWheels {
            left: wheel(1.0 - uneven),
            right: wheel(1.0 + uneven),
        };
        (slip, both)
    }

    /// Distance in metres and turn in radians of the body from the distances of both rims.
    pub(crate) fn motion(&mut self, left_m: f64, right_m: f64, surface: &Surface) -> (f64, f64) {
        let rolled_m = 0.5 * (left_m.abs() + right_m.abs());
        self.distance_m += rolled_m;
        let grip = 1.0 - surface.slip;
        let distance_m = 0.5 * (left_m + right_m) * grip + self.stretch_m;
        let turn_rad = (right_m - left_m) / self.track_m * grip;
        (
            distance_m,
            turn_rad + rolled_m * surface.bias_rad_per_m * self.rug_drift + self.bend_rad,
        )
    }

    /// Draws the errors of the next steps.
    pub(crate) fn draw(&mut self, random: &mut Pcg) {
        if self.distance_m == 0.0 {
            (self.stretch_m, self.bend_rad) = (0.0, 0.0);
            return;
        }
        let share = libm::sqrt(self.distance_m) / DRAW_STEPS as f64;
        self.distance_m = 0.0;
        self.stretch_m = self.slip_m_per_sqrt_m * share * random.normal();
        self.bend_rad = self.slip_rad_per_sqrt_m * share * random.normal();
    }
}
