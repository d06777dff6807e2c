//! One driven wheel: bridge, motor, gear with play, encoder.

use super::Bridge;
use crate::model::{RobotModel, WheelMotor};

/// Length of a step, seconds.
pub(crate) const STEP_S: f64 = 0.001;
/// A wheel that is not driven stops below this speed, m/s.
const STANDING_M_PER_S: f64 = 1e-5;
/// How much longer than under drive the speed takes to fall when the bridge coasts.
const COAST_FACTOR: f64 = 5.0;

/// What makes wheels of one robot differ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelErrors {
    /// True distance of the rim over nominal distance.
    pub(crate) distance_factor: f64,
    /// Play of the gear at the rim, metres.
    pub(crate) backlash_m: f64,
}

/// A wheel.
#[derive(Clone, Debug)]
pub(crate) struct Wheel {
    motor: WheelMotor,
    errors: WheelErrors,
    counts_per_m: f64,
    has_direction: bool,
    /// Speed of the rim as the motor turns it, m/s, nominal.
    pub(crate) rim_m_per_s: f64,
    /// Nominal distance of the motor side, metres.
    travel_m: f64,
    /// Nominal distance of the wheel behind the backlash, metres.
    rolled_m: f64,
    count_signed: i32,
    /// What the encoder shows.
    pub(crate) count: i32,
    /// Current of the motor, ampere.
    pub(crate) current_a: f64,
    /// Speed at which a hand holds the rim, m/s, regardless of the motor.
    held_m_per_s: Option<f64>,
}

impl Wheel {
    pub(crate) fn new(model: &RobotModel, errors: WheelErrors) -> Self {
        Self {
            motor: model.wheel_motor,
            errors,
            counts_per_m: 1.0 / model.drive.count_m,
            has_direction: model.drive.encoder_lines >= 2,
            rim_m_per_s: 0.0,
            travel_m: 0.0,
            rolled_m: 0.0,
            count_signed: 0,
            count: 0,
            current_a: 0.0,
            held_m_per_s: None,
        }
    }

    pub(crate) fn is_standing(&self) -> bool {
        self.rim_m_per_s == 0.0 && self.held_m_per_s.is_none_or(|speed| speed == 0.0)
    }

    /// A person turns the wheel at this speed, or releases it; then it stops.
    pub(crate) const fn hold(&mut self, speed_m_per_s: Option<f64>) {
        if self.held_m_per_s.is_some() {
            self.rim_m_per_s = 0.0;
        }
        self.held_m_per_s = speed_m_per_s;
    }

    /// Advances the motor one step under a load that opposes its motion; `supply` is the battery voltage over the
    /// nominal. Returns the true distance of the rim on the floor in metres.
    pub(crate) fn step(&mut self, bridge: Bridge, supply: f64, load_n: f64) -> f64 {
        let free = self.free_speed(bridge) * supply;
        let lost = load_n * self.motor.free_speed_m_per_s / self.motor.stall_force_n;
        let driven = free != 0.0;
        let target = if !driven {
            // Friction slows the wheel until it stops; it does not turn it back (see below).
            -(self.friction_m_per_s() + lost).copysign(self.rim_m_per_s)
        } else if free > lost {
            free - lost
        } else if free < -lost {
            free + lost
        } else {
            0.0
        };
        let lag_s = if driven || bridge.brake {
            self.motor.lag_s
        } else {
            self.motor.lag_s * COAST_FACTOR
        };
        let before_m_per_s = self.rim_m_per_s;
        self.rim_m_per_s += (target - self.rim_m_per_s) * (STEP_S / lag_s);
        if !driven && (self.rim_m_per_s.abs() < STANDING_M_PER_S || self.rim_m_per_s * before_m_per_s <= 0.0)
        {
            self.rim_m_per_s = 0.0;
        }
        if let Some(held_m_per_s) = self.held_m_per_s {
            self.rim_m_per_s = held_m_per_s;
        }
        self.current_a = if driven {
            let strain = (free - self.rim_m_per_s).abs() / self.motor.free_speed_m_per_s;
            self.motor.idle_current_a + self.motor.stall_current_a * strain
        } else {
            0.0
        };
        self.roll()
    }

    /// Friction of motor and gear, as the speed it costs: the cause of the dead band of a braking bridge.
    fn friction_m_per_s(&self) -> f64 {
        let dead = self.motor.dead_band_brake;
        dead / (1.0 - dead) * self.motor.free_speed_m_per_s
    }

    /// Rim speed that the bridge asks for at the nominal voltage without load.
    fn free_speed(&self, bridge: Bridge) -> f64 {
        let dead = if bridge.brake {
            self.motor.dead_band_brake
        } else {
            self.motor.dead_band_coast
        };
        let pwm = if bridge.pwm.is_nan() {
            0.0
        } else {
            bridge.pwm.clamp(-1.0, 1.0)
        };
        let beyond = pwm.abs() - dead;
        if beyond <= 0.0 {
            return 0.0;
        }
        (beyond / (1.0 - dead) * self.motor.free_speed_m_per_s).copysign(pwm)
    }

    fn roll(&mut self) -> f64 {
        self.travel_m += self.rim_m_per_s * STEP_S;
        self.take_counts();
        let rolled_m = self
            .rolled_m
            .max(self.travel_m - self.errors.backlash_m)
            .min(self.travel_m);
        let distance_m = rolled_m - self.rolled_m;
        self.rolled_m = rolled_m;
        distance_m * self.errors.distance_factor
    }

    /// The distance of the motor side in counts.
    pub(crate) fn exact_count(&self) -> f64 {
        self.travel_m * self.counts_per_m
    }

    fn take_counts(&mut self) {
        let exact = self.exact_count();
        let whole = exact as i64;
        let floor = if exact < whole as f64 { whole - 1 } else { whole } as i32;
        let change = floor.wrapping_sub(self.count_signed);
        if change != 0 {
            self.count_signed = floor;
            let seen = if self.has_direction {
                change
            } else {
                change.wrapping_abs()
            };
            self.count = self.count.wrapping_add(seen);
        }
    }
}
