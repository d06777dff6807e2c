//! Description of the machine: names, geometry and parts. Set before cord_init.

use std::ffi::{CStr, c_char};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use cord::board::KeptWords;
use cord::{HandMode, Parameters};
use rvac_protocol::message::{Capabilities, Limits};
use rvac_units::{AngularSpeed, Current, Length, Speed, Throttle};

/// The machine as described so far.
#[derive(Debug)]
pub(crate) struct MachineDescription {
    pub(crate) boot_count: u32,
    pub(crate) recent_resets: u8,
    pub(crate) cliffs: u8,
    /// What outlives cord_init, as a reset of the chip.
    pub(crate) kept: Option<KeptWords>,
    parameters: Parameters,
    fitted: Capabilities,
}

/// A small round robot, until the firmware describes its own.
const SMALL_ROUND_ROBOT: Limits = Limits {
    speed_max: Speed(350_000),
    turn_max: AngularSpeed(1_500_000),
    track: Length(230_000),
    count_nm: 500_000,
    radius: Length(175_000),
    swath: Length(300_000),
};

static MACHINE: LazyLock<Mutex<MachineDescription>> = LazyLock::new(|| {
    Mutex::new(MachineDescription {
        boot_count: 0,
        recent_resets: 0,
        cliffs: 0,
        kept: None,
        parameters: Parameters::for_machine("unnamed", "0", SMALL_ROUND_ROBOT),
        fitted: Capabilities {
            encoders: true,
            ..Capabilities::default()
        },
    })
});

/// A part that can be declared.
type Declaration = fn(&mut MachineDescription, u8);

const PARTS: [(&str, u8, Declaration); 12] = [
    ("bumpers", 2, |machine, count| machine.fitted.bumpers = count),
    ("cliffs", 3, |machine, count| {
        machine.fitted.cliffs = count;
        machine.cliffs = count;
    }),
    ("wheel-drops", 2, |machine, count| {
        machine.fitted.wheel_drops = count
    }),
    ("gyro", 1, |machine, count| machine.fitted.gyro = count > 0),
    ("buttons", 8, |machine, count| machine.fitted.buttons = count),
    ("leds", 16, |machine, count| machine.fitted.leds = count),
    ("beeper", 1, |machine, count| machine.fitted.beeper = count > 0),
    ("brush-main", 1, |machine, count| {
        machine.fitted.brush_main = count > 0
    }),
    ("brush-sides", 1, |machine, count| {
        machine.fitted.brush_sides = count > 0
    }),
    ("vacuum", 1, |machine, count| machine.fitted.vacuum = count > 0),
    ("currents", 1, |machine, count| {
        machine.fitted.currents = count > 0
    }),
    ("battery", 1, |machine, count| machine.fitted.battery = count > 0),
];

/// The machine. Never hold this while a callback runs.
pub(crate) fn machine() -> MutexGuard<'static, MachineDescription> {
    MACHINE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl MachineDescription {
    /// All of it, for the main loop.
    pub(crate) const fn parameters(&self) -> Parameters {
        let mut parameters = self.parameters;
        parameters.fitted = Some(self.fitted);
        parameters
    }
}

/// Names the device and the firmware's version, each at most 24 bytes of UTF-8, ended by NUL. Returns 1, or 0 if a name
/// is NULL or no UTF-8. The names are copied.
///
/// # Safety
/// Both pointers are NULL or point to strings ended by NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cord_set_names(device: *const c_char, firmware: *const c_char) -> i32 {
    // SAFETY: the caller guarantees both pointers, and `name` handles NULL.
    let names = unsafe { (name(device), name(firmware)) };
    let (Some(device), Some(firmware)) = names else {
        return 0;
    };
    let mut machine = machine();
    // Names live as long as the process, like constants of a firmware; they are set once.
    machine.parameters.device = String::leak(device);
    machine.parameters.firmware = String::leak(firmware);
    1
}

/// Sets the highest speed in m/s and turn rate in rad/s. Returns 1, or 0 for a value that is not above 0 or not finite.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_limits(speed: f64, turn: f64) -> i32 {
    if !all_positive(&[speed, turn]) {
        return 0;
    }
    let mut machine = machine();
    let mut limits = machine.parameters.limits;
    limits.speed_max = Speed::from_m_per_s(speed);
    limits.turn_max = AngularSpeed::from_rad_per_s(turn);
    let described = machine.parameters;
    machine.parameters = Parameters {
        wheel: described.wheel,
        guard: described.guard,
        hand_mode: described.hand_mode,
        ..Parameters::for_machine(described.device, described.firmware, limits)
    };
    1
}

/// Sets the distance between the wheels (m), the distance of the rim per encoder count (m), the duty below which a
/// wheel does not turn (0..1) and the speed at full duty (m/s). Returns 1, or 0 for a value out of range.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_wheels(
    track: f64,
    distance_per_count: f64,
    dead_band: f64,
    speed_at_full: f64,
) -> i32 {
    if !all_positive(&[track, distance_per_count, speed_at_full])
        || !(0.0..1.0).contains(&dead_band)
        || distance_per_count > 1.0
    {
        return 0;
    }
    let mut machine = machine();
    machine.parameters.limits.track = Length::from_m(track);
    machine.parameters.limits.count_nm = (distance_per_count * 1e9) as u32;
    machine.parameters.wheel.dead_band = Throttle::saturating_from_millionths((dead_band * 1e6) as i32);
    machine.parameters.wheel.speed_at_full = Speed::from_m_per_s(speed_at_full);
    1
}

/// Sets the currents in A above which a wheel, and the main brush, is switched off after 100 ms (S11): some three quarters of
/// what the motor draws when it is held. At first they are 1.5 A and 2 A. Returns 1, or 0 for a value that is not above 0 or not
/// finite.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_stall_limits(wheel: f64, brush_main: f64) -> i32 {
    if !all_positive(&[wheel, brush_main]) {
        return 0;
    }
    let guard = &mut machine().parameters.guard;
    guard.wheel_current_max = Current::from_a(wheel);
    guard.brush_current_max = Current::from_a(brush_main);
    1
}

/// Declares how many of a part the machine has: "bumpers" (0..2), "cliffs" (0..3, from the left), "wheel-drops" (0..2),
/// "gyro", "buttons" (0..8), "leds" (0..16), "beeper", "brush-main", "brush-sides", "vacuum", "currents", "battery"
/// (0..1). What is not declared is absent. Wheels with encoders are always present. Returns 1, or 0 for another name or
/// number.
///
/// # Safety
/// `part` is NULL or points to a string ended by NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cord_declare(part: *const c_char, count: i32) -> i32 {
    // SAFETY: the caller guarantees the pointer.
    let Some(part) = (unsafe { name(part) }) else {
        return 0;
    };
    let known = PARTS.iter().find(|(name, ..)| *name == part);
    match (known, u8::try_from(count)) {
        (Some((_, most, declare)), Ok(count)) if count <= *most => {
            declare(&mut machine(), count);
            1
        }
        _ => 0,
    }
}

/// Allows (1, as it is at first) or forbids (0) that a person arms the robot by packets without a session. Returns 1, or
/// 0 for another number.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_hand_mode(allowed: i32) -> i32 {
    machine().parameters.hand_mode = match allowed {
        0 => HandMode::Forbidden,
        1 => HandMode::Allowed,
        _ => return 0,
    };
    1
}

/// Sets how often the chip has started, and the number of consecutive recent resets. Three of them inhibit motion.
#[unsafe(no_mangle)]
pub extern "C" fn cord_set_resets(boot_count: u32, recent_resets: u8) {
    let mut machine = machine();
    machine.boot_count = boot_count;
    machine.recent_resets = recent_resets;
}

/// # Safety
/// `text` is NULL or points to a string ended by NUL.
unsafe fn name(text: *const c_char) -> Option<String> {
    if text.is_null() {
        return None;
    }
    // SAFETY: not NULL, and ended by NUL as the caller guarantees.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().ok().map(str::to_owned)
}

fn all_positive(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite() && *value > 0.0)
}
