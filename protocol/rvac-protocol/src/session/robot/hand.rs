//! Limits of hand mode, for a person at a terminal.

use rvac_units::{AngularSpeed, Length, Speed, Throttle};

use crate::message::{Command, Motor};

/// Highest forward speed in hand mode, 0.1 m/s.
pub const HAND_SPEED_MAX: Speed = Speed(100_000);
/// Highest turn rate in hand mode, 0.5 rad/s.
pub const HAND_TURN_MAX: AngularSpeed = AngularSpeed(500_000);
/// Longest lease in hand mode.
pub const HAND_LEASE_MS_MAX: u16 = 500;
/// Highest throttle of a wheel in hand mode: a quarter, about 0.1 m/s on the robots we know.
const HAND_THROTTLE_MAX: i32 = 250_000;
/// Longest `move` in hand mode: 0.1 m/s for 500 ms.
const HAND_MOVE_MAX: i32 = 50_000;

/// The command with its motion clamped; other commands stay unchanged.
pub(super) fn clamp(command: Command) -> Command {
    match command {
        Command::Drive(mut drive) => {
            drive.speed = Speed(within(drive.speed.0, HAND_SPEED_MAX.0));
            drive.turn = AngularSpeed(within(drive.turn.0, HAND_TURN_MAX.0));
            drive.lease_ms = drive.lease_ms.min(HAND_LEASE_MS_MAX);
            Command::Drive(drive)
        }
        Command::Motor(mut motor) => {
            if matches!(motor.motor, Motor::WheelLeft | Motor::WheelRight) {
                let throttle = within(motor.throttle.millionths(), HAND_THROTTLE_MAX);
                motor.throttle = Throttle::saturating_from_millionths(throttle);
            }
            motor.lease_ms = motor.lease_ms.min(HAND_LEASE_MS_MAX);
            Command::Motor(motor)
        }
        Command::Move(mut movement) => {
            movement.length = Length(within(movement.length.0, HAND_MOVE_MAX));
            Command::Move(movement)
        }
        other => other,
    }
}

fn within(value: i32, limit: i32) -> i32 {
    value.clamp(-limit, limit)
}
