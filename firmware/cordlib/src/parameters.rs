//! What differs between machines of the same make-up: names, geometry, limits, gains.

use rvac_protocol::message::{Capabilities, Limits};
use rvac_units::{AngularSpeed, Current, Speed, Throttle};

/// Facts about one kind of robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Device name for the handshake, for example `sr8730`; at most 24 bytes.
    pub device: &'static str,
    /// Version of the board's firmware; at most 24 bytes.
    pub firmware: &'static str,
    /// What is fitted and calibrated, where a board's types serve several machines; `None` = everything that the types
    /// name. A part that is not calibrated yet is not fitted: it is reported as absent, and its readings are ignored.
    /// Without encoders `drive` and `move` are refused, while `motor` drives a wheel in open loop. A press of any button
    /// stops the robot even if no button is fitted.
    pub fitted: Option<Capabilities>,
    /// Geometry and limits, as they go to the host.
    pub limits: Limits,
    /// Control of the wheels.
    pub wheel: WheelParameters,
    /// Ramps and speeds of `drive` and `move`.
    pub motion: MotionParameters,
    /// Electrical limits and sensor thresholds.
    pub guard: GuardParameters,
    /// The battery.
    pub pack: PackParameters,
    /// Whether packets without a session may arm the robot.
    pub hand_mode: HandMode,
}

/// What a person may do who types packets without a session, and so without a CRC.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HandMode {
    /// Arm the robot and move it slowly, for some seconds after each packet.
    #[default]
    Allowed,
    /// Look and stop, but not arm.
    Forbidden,
}

/// Speed control of one wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelParameters {
    /// Duty below which the motor does not turn.
    pub dead_band: Throttle,
    /// Speed of the rim at full duty.
    pub speed_at_full: Speed,
    /// Proportional gain: millionths of duty for each mm/s of speed error.
    pub proportional: i32,
    /// Integral gain: millionths of duty for each mm that the wheel is behind.
    pub integral: i32,
}

impl WheelParameters {
    /// The duty at which a wheel without load turns at this speed, in millionths.
    pub(crate) fn duty_at(&self, speed_um_per_s: i32) -> i32 {
        let dead_band = i64::from(self.dead_band.millionths());
        let span = 1_000_000_i64.saturating_sub(dead_band);
        let full = i64::from(self.speed_at_full.0.max(1));
        let beyond = i64::from(speed_um_per_s.saturating_abs()).saturating_mul(span) / full;
        let duty = dead_band.saturating_add(beyond).min(1_000_000);
        i32::try_from(duty)
            .unwrap_or(0)
            .saturating_mul(speed_um_per_s.signum())
    }

    /// The speed of a wheel without load at this duty, in µm/s.
    pub(crate) fn speed_at(&self, duty: Throttle) -> i32 {
        let dead_band = i64::from(self.dead_band.millionths());
        let span = 1_000_000_i64.saturating_sub(dead_band).max(1);
        let beyond = i64::from(duty.millionths().saturating_abs())
            .saturating_sub(dead_band)
            .max(0);
        let speed = beyond.saturating_mul(i64::from(self.speed_at_full.0)) / span;
        i32::try_from(speed)
            .unwrap_or(0)
            .saturating_mul(duty.millionths().signum())
    }
}

/// Ramps of the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotionParameters {
    /// Acceleration along the path, in µm/s².
    pub acceleration_um_per_s2: i32,
    /// Angular acceleration, in µrad/s².
    pub turn_acceleration_urad_per_s2: i32,
    /// Speed of `move`.
    pub move_speed: Speed,
    /// Turn rate of `move`.
    pub move_turn: AngularSpeed,
}

/// Limits of the reflexes that depend on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GuardParameters {
    /// A wheel motor above this for 100 ms is switched off (S11).
    pub wheel_current_max: Current,
    /// The main brush above this for 100 ms is switched off (S11).
    pub brush_current_max: Current,
    /// Least difference of a cliff receiver between lit and dark emitter that means floor, 1..=1023 (S8, S9).
    pub floor_level_min: u16,
}

/// The battery pack: NiMH cells in series, and their loads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackParameters {
    /// Cells in series, 1..=20.
    pub cells: u8,
    /// Nominal capacity, in mAh.
    pub capacity_mah: u16,
    /// Highest mean current into the pack, in mA.
    pub current_max_ma: u16,
    /// Resistance of the pack, in milliohm.
    pub resistance_mohm: u16,
    /// Standby current of the electronics, in mA, which maintenance charging makes up for on the dock; 0 = no maintenance
    /// charging.
    pub drain_ma: u16,
    /// The capacity and the scale of the voltage were measured on this pack. Else they are assumed: the rules of S16 still
    /// act on the voltage, but no charge is told to the host.
    pub measured: bool,
    /// Load currents of the parts.
    pub loads: LoadParameters,
}

/// Nominal currents, for the estimate of the charge that is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadParameters {
    /// Electronics, in mA.
    pub electronics_ma: u16,
    /// One wheel that turns, in mA.
    pub wheel_ma: u16,
    /// Main brush, in mA.
    pub brush_main_ma: u16,
    /// Side brushes, in mA.
    pub brush_sides_ma: u16,
    /// Suction, in mA.
    pub vacuum_ma: u16,
}

impl PackParameters {
    /// Twelve cells of 2 Ah in a robot of the usual size.
    pub const NIMH_12: Self = Self {
        cells: 12,
        capacity_mah: 2_000,
        current_max_ma: 1_000,
        resistance_mohm: 300,
        drain_ma: 15,
        measured: true,
        loads: LoadParameters {
            electronics_ma: 150,
            wheel_ma: 200,
            brush_main_ma: 500,
            brush_sides_ma: 150,
            vacuum_ma: 900,
        },
    };
}

impl Parameters {
    /// Usual values for a machine with these names and this geometry. Gains suit a wheel that reaches 1.3 times the
    /// highest speed at full duty.
    #[must_use]
    pub const fn for_machine(device: &'static str, firmware: &'static str, limits: Limits) -> Self {
        let top = limits.speed_max.0;
        Self {
            device,
            firmware,
            fitted: None,
            limits,
            wheel: WheelParameters {
                dead_band: Throttle::saturating_from_millionths(200_000),
                speed_at_full: Speed(top.saturating_add(top / 10 * 3)),
                proportional: 1_500,
                integral: 15_000,
            },
            motion: MotionParameters {
                acceleration_um_per_s2: 500_000,
                turn_acceleration_urad_per_s2: 4_000_000,
                move_speed: Speed(top / 5 * 3),
                move_turn: AngularSpeed(limits.turn_max.0 / 5 * 3),
            },
            guard: GuardParameters {
                wheel_current_max: Current(1_500),
                brush_current_max: Current(2_000),
                floor_level_min: 100,
            },
            pack: PackParameters::NIMH_12,
            hand_mode: HandMode::Allowed,
        }
    }
}
