//! Time, from either clock callback.

use crate::callbacks::callbacks;

/// Seconds since reset, from the callback of set_callback_get_time, else from the one for milliseconds, else 0. A
/// callback that returns NaN or an infinity counts as 0.
#[unsafe(no_mangle)]
pub extern "C" fn hw_get_time() -> f64 {
    let all = callbacks();
    let seconds = match (all.time_s, all.time_ms) {
        (Some(time_s), _) => time_s(),
        (None, Some(time_ms)) => f64::from(time_ms()) / 1e3,
        (None, None) => 0.0,
    };
    if seconds.is_finite() { seconds } else { 0.0 }
}

/// Milliseconds since reset, modulo 2^32, from the callback of set_callback_get_time_ms, else from the one for seconds,
/// else 0.
#[unsafe(no_mangle)]
pub extern "C" fn hw_get_time_ms() -> u32 {
    match callbacks().time_ms {
        Some(time_ms) => time_ms(),
        // The cast to the wide integer saturates; the narrowing wraps, as the clock does.
        None => (hw_get_time() * 1e3) as i64 as u32,
    }
}
