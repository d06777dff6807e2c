//! Callbacks of the firmware. A callback that is not set, or set to NULL, is not called.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// All callbacks.
#[derive(Clone, Copy, Default)]
pub(crate) struct Callbacks {
    pub(crate) time_s: Option<extern "C" fn() -> f64>,
    pub(crate) time_ms: Option<extern "C" fn() -> u32>,
    pub(crate) setup: Option<extern "C" fn()>,
    pub(crate) step: Option<extern "C" fn()>,
    pub(crate) motor_throttle: Option<extern "C" fn(i32, f64)>,
    pub(crate) beep: Option<extern "C" fn(f64, f64)>,
    pub(crate) led: Option<extern "C" fn(i32, f64)>,
    pub(crate) cliff_emitters: Option<extern "C" fn(i32)>,
    pub(crate) feed_watchdog: Option<extern "C" fn()>,
    pub(crate) keep: Option<extern "C" fn(i32, u32)>,
    pub(crate) kept: Option<extern "C" fn(i32) -> u32>,
}

static CALLBACKS: Mutex<Callbacks> = Mutex::new(Callbacks {
    time_s: None,
    time_ms: None,
    setup: None,
    step: None,
    motor_throttle: None,
    beep: None,
    led: None,
    cliff_emitters: None,
    feed_watchdog: None,
    keep: None,
    kept: None,
});

fn lock() -> MutexGuard<'static, Callbacks> {
    CALLBACKS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A copy, so that no lock is held while a callback runs.
pub(crate) fn callbacks() -> Callbacks {
    *lock()
}

/// Time in seconds since reset. Cordlib takes milliseconds from it if there is no callback for them.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_get_time(callback: Option<extern "C" fn() -> f64>) {
    lock().time_s = callback;
}

/// Time in milliseconds since reset, modulo 2^32.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_get_time_ms(callback: Option<extern "C" fn() -> u32>) {
    lock().time_ms = callback;
}

/// Called once by cord_init and cord_event_init, before anything else.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_setup(callback: Option<extern "C" fn()>) {
    lock().setup = callback;
}

/// Called before every pass of the main loop: the place to read pins and to push events.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_step(callback: Option<extern "C" fn()>) {
    lock().step = callback;
}

/// Sets a motor (CORD_MOTOR_...) to a duty of -1..1. Wheels at 0 are to brake.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_set_motor_throttle(
    callback: Option<extern "C" fn(motor: i32, throttle: f64)>,
) {
    lock().motor_throttle = callback;
}

/// Starts a tone of this pitch (Hz) and volume (0..1); pitch 0 is silence.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_beep(callback: Option<extern "C" fn(pitch: f64, volume: f64)>) {
    lock().beep = callback;
}

/// Sets a light to a brightness of 0..1.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_led(callback: Option<extern "C" fn(led: i32, brightness: f64)>) {
    lock().led = callback;
}

/// Switches the emitters of the cliff sensors on (1) or off (0), for the self-test.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_cliff_emitters(callback: Option<extern "C" fn(on: i32)>) {
    lock().cliff_emitters = callback;
}

/// Feeds the hardware watchdog. Called only when clock, loop and communication are alive.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_feed_watchdog(callback: Option<extern "C" fn()>) {
    lock().feed_watchdog = callback;
}

/// Words of memory that a reset must leave alone, for latched inhibits and clocks: two copies of a record, each with its
/// check, written one after the other.
pub const CORD_KEPT_WORDS: i32 = 36;

/// Writes one word, 0 to CORD_KEPT_WORDS - 1, to memory that a reset leaves alone. Called for all words in order, at most
/// once a millisecond. Without this callback and the next one the record lives as long as the process.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_keep(callback: Option<extern "C" fn(place: i32, word: u32)>) {
    lock().keep = callback;
}

/// Reads back one word of that memory; called by cord_init. It may hold anything after power-on.
#[unsafe(no_mangle)]
pub extern "C" fn set_callback_kept(callback: Option<extern "C" fn(place: i32) -> u32>) {
    lock().kept = callback;
}
