//! Switches everything off, for code that owns no part: the panic handler, the exception hook, the handler of a failing
//! clock.
//!
//! Disabled output compares leave their pins to the latches, which are low. PHASE and MODE stay: with ENABLE low and
//! MODE high the wheels brake.

use core::sync::atomic::{AtomicBool, Ordering};

use pic32mx3_hal::gpio::Port;
use pic32mx3_hal::pwm;

use crate::generated::pins::{self, Signal};

/// Left wheel, main brush, charger, right wheel, sound.
const COMPARES: [u8; 5] = [1, 2, 3, 4, 5];

const SWITCHES: [Signal; 4] = [
    pins::BRUSH_SIDES,
    pins::VACUUM,
    pins::PROXIMITY_EMIT,
    pins::SOUND_ENABLE,
];

/// The clock monitor has detected a failed crystal.
static CLOCK_FAILED: AtomicBool = AtomicBool::new(false);
/// Everything was switched off.
static HELD: AtomicBool = AtomicBool::new(false);

/// Switches off all motors, the charger, the sound and the infrared emitter until the next reset, in a microsecond. The
/// charger's gate, whose interrupt would open it again within 50 µs, and the switches of side brushes and suction, which a
/// pass of the main loop may be about to set, look at [`is_held`]; output compares of motors do not start again by
/// themselves.
pub fn everything() {
    HELD.store(true, Ordering::Relaxed);
    for compare in COMPARES {
        pwm::stop(compare);
    }
    for signal in SWITCHES {
        port(signal).clear(mask(signal));
    }
}

/// The port of a signal.
#[inline(always)]
#[must_use]
pub const fn port(signal: Signal) -> Port {
    port_of(signal.port)
}

/// The library's name of a port.
#[inline(always)]
#[must_use]
pub const fn port_of(port: pins::Port) -> Port {
    match port {
        pins::Port::A => Port::A,
        pins::Port::B => Port::B,
        pins::Port::C => Port::C,
        pins::Port::D => Port::D,
        pins::Port::E => Port::E,
        pins::Port::F => Port::F,
        pins::Port::G => Port::G,
    }
}

/// The bit of a signal in its port.
#[inline(always)]
#[must_use]
pub const fn mask(signal: Signal) -> u16 {
    signal.mask() as u16
}

/// Notes that the clock failed.
pub(super) fn note_clock_failure() {
    CLOCK_FAILED.store(true, Ordering::Relaxed);
}

/// Whether everything was switched off since the reset: nothing may be switched on again.
#[inline(always)]
#[must_use]
pub fn is_held() -> bool {
    HELD.load(Ordering::Relaxed)
}

/// Whether the clock failed since the reset.
#[must_use]
pub fn clock_has_failed() -> bool {
    CLOCK_FAILED.load(Ordering::Relaxed)
}

#[cfg(test)]
mod tests {
    use super::{mask, port};
    use crate::generated::pins;
    use pic32mx3_hal::gpio::Port;

    #[test]
    fn signals_name_their_port_and_bit() {
        assert_eq!((port(pins::VACUUM), mask(pins::VACUUM)), (Port::D, 1 << 5));
        assert_eq!(
            (port(pins::BRUSH_SIDES), mask(pins::BRUSH_SIDES)),
            (Port::A, 1 << 4)
        );
    }
}
