//! Commands of the firmware itself. The same limits and the same permit apply as for commands from the wire.

use std::ffi::{CStr, c_char};

use rvac_protocol::message::{
    Beep, Command, Drive, Inhibit, Led, LedPattern, Motor, MotorCommand, Refusal, Sequence,
};
use rvac_units::{AngularSpeed, Frequency, Ratio, Speed, Throttle, Tick};

use crate::machine::machine;
use crate::main_loop::with_cord;

/// Done.
pub const CORD_OK: i32 = 0;
/// A number is out of range, not finite, or a name is not known.
pub const CORD_RANGE: i32 = 1;
/// Something inhibits; cord_inhibits shows what.
pub const CORD_INHIBITED: i32 = 2;
/// The machine has no such part.
pub const CORD_ABSENT: i32 = 3;
/// A queue is full.
pub const CORD_BUSY: i32 = 4;
/// The cause of the latched inhibit, or the button that stopped the robot, is still there.
pub const CORD_CAUSE_REMAINS: i32 = 5;
/// Not initialised, or called from inside a callback of the main loop.
pub const CORD_NOT_NOW: i32 = 6;

/// Lease of a goal that the firmware sets.
const GOAL_LEASE_MS: u16 = 250;

fn request(command: &Command) -> i32 {
    match with_cord(|cord| cord.request(command)) {
        None => CORD_NOT_NOW,
        Some(Ok(())) => CORD_OK,
        Some(Err(Refusal::Inhibited)) => CORD_INHIBITED,
        Some(Err(Refusal::Absent)) => CORD_ABSENT,
        Some(Err(Refusal::Busy)) => CORD_BUSY,
        Some(Err(Refusal::CauseRemains)) => CORD_CAUSE_REMAINS,
        Some(Err(_)) => CORD_RANGE,
    }
}

/// Sets the speeds of the left and right rim in m/s for the next 250 ms. Repeat it to continue. Returns CORD_OK or why
/// not.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_speed_goal(left: f64, right: f64) -> i32 {
    if !left.is_finite() || !right.is_finite() {
        return CORD_RANGE;
    }
    let track_m = machine().parameters().limits.track.as_m();
    request(&Command::Drive(Drive {
        speed: Speed::from_m_per_s(f64::midpoint(left, right)),
        turn: AngularSpeed::from_rad_per_s((right - left) / track_m),
        lease_ms: GOAL_LEASE_MS,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    }))
}

/// Sets the duty of a cleaning motor or wheel (CORD_MOTOR_...), -1..1, for the next 250 ms; brushes and suction run 2
/// s. Returns CORD_OK or why not.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_motor_goal(motor: i32, throttle: f64) -> i32 {
    let motor = match motor {
        0 => Motor::WheelLeft,
        1 => Motor::WheelRight,
        2 => Motor::BrushMain,
        3 => Motor::BrushSides,
        4 => Motor::Vacuum,
        _ => return CORD_RANGE,
    };
    let Some(throttle) = millionths(throttle).and_then(|duty| Throttle::from_millionths(duty).ok()) else {
        return CORD_RANGE;
    };
    request(&Command::Motor(MotorCommand {
        motor,
        throttle,
        lease_ms: GOAL_LEASE_MS,
        sequence: Sequence(0),
        seen_tick: Tick(0),
    }))
}

/// Allows motion; on the dock only with undock = 1. Without a host's session it ends 10 s after the last goal. Returns
/// CORD_OK or why not.
#[unsafe(no_mangle)]
pub extern "C" fn cord_arm(undock: i32) -> i32 {
    request(&Command::Arm {
        sequence: Sequence(0),
        undock: undock != 0,
    })
}

/// Stops everything until cord_arm or an arming host. Returns CORD_OK or CORD_NOT_NOW.
#[unsafe(no_mangle)]
pub extern "C" fn cord_stop() -> i32 {
    request(&Command::Stop)
}

/// Clears a latched inhibit by its name on the wire, for example "bumper-stuck". Returns CORD_OK or why not.
///
/// # Safety
/// `inhibit` is NULL or points to a string ended by NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cord_clear(inhibit: *const c_char) -> i32 {
    if inhibit.is_null() {
        return CORD_RANGE;
    }
    // SAFETY: not NULL, and ended by NUL as the caller vouches.
    let name = unsafe { CStr::from_ptr(inhibit) };
    match Inhibit::from_name(name.to_bytes()) {
        Some(inhibit) => request(&Command::Clear {
            sequence: Sequence(0),
            inhibit,
        }),
        None => CORD_RANGE,
    }
}

/// Queues a tone of a pitch in Hz (0 = pause), a duration in seconds (0.001..10) and a volume (0..1). Returns CORD_OK
/// or why not.
#[unsafe(no_mangle)]
pub extern "C" fn cord_beep(pitch: f64, duration: f64, volume: f64) -> i32 {
    let audible = pitch == 0.0 || (20.0..=20_000.0).contains(&pitch);
    let volume = millionths(volume).and_then(|part| Ratio::from_millionths(part).ok());
    match volume {
        Some(volume) if audible && (0.001..=10.0).contains(&duration) => request(&Command::Beep(Beep {
            pitch: Frequency::from_hz(pitch),
            duration_ms: (duration * 1e3) as u16,
            volume,
        })),
        _ => CORD_RANGE,
    }
}

/// Sets a light: pattern 0 off, 1 on, 2 blinking once a second; brightness 0..1. Returns CORD_OK or why not.
#[unsafe(no_mangle)]
pub extern "C" fn cord_led(led: i32, pattern: i32, brightness: f64) -> i32 {
    let pattern = usize::try_from(pattern)
        .ok()
        .and_then(|number| LedPattern::ALL.get(number));
    let brightness = millionths(brightness).and_then(|part| Ratio::from_millionths(part).ok());
    let (Ok(led), Some(pattern), Some(brightness)) = (u8::try_from(led), pattern, brightness) else {
        return CORD_RANGE;
    };
    request(&Command::Led(Led {
        led,
        pattern: *pattern,
        brightness,
    }))
}

/// Everything that inhibits motion, as the bits of the wire: bit 0 not-armed, 3 bumper, 5 cliff, 8 wheel-drop ... All
/// bits are set while that is not known.
#[unsafe(no_mangle)]
pub extern "C" fn cord_inhibits() -> u32 {
    with_cord(|cord| cord.inhibits().bits()).unwrap_or(u32::MAX)
}

fn millionths(value: f64) -> Option<i32> {
    value.is_finite().then(|| (value * 1e6).round() as i32)
}
