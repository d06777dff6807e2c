//! Sleep, in which no clock runs, beside Idle, in which only the processor stops (section 8.3 of the peripherals).
//!
//! What goes on in Sleep: change notice, the pins INT0 to INT4, the watchdog, a slave of SPI or I2C, comparators, the calendar. A
//! request wakes when its source is enabled and its level is above the present one. Then the clock starts, which with a crystal and
//! the PLL takes some 2 ms (`unverified`: the figures are general knowledge of the family). Pins keep their levels. The core timer
//! stands still.
//!
//! For Idle see [`crate::cpu::sleep_while_zero`].

use crate::cpu;
use crate::dma;
use crate::register::map::{OSCCON, RCON};
use crate::reset::with_system_unlocked;
use core::sync::atomic::AtomicU32;

/// SLPEN.
const SLEEP_ENABLE: u32 = 1 << 4;
const SLEPT: u32 = 1 << 3;
const IDLED: u32 = 1 << 2;
/// VREGS.
const REGULATOR_STAYS_ON: u32 = 1 << 8;

/// How deep the chip has slept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rest {
    /// The processor stood still, everything else went on.
    Idle,
    /// All clocks stood still.
    Sleep,
}

/// Sleeps until an interrupt when the word is zero. UARTs and SPIs should have sent what they have, and no page of flash be under
/// way.
///
/// No wake-up is lost, as with [`crate::cpu::sleep_while_zero`], whose rules hold here, too. Between the two changes of the mode a
/// handler that idles would sleep.
pub fn sleep_while_zero(word: &AtomicU32) {
    // Another access between the two keys would spoil them.
    dma::suspended(|| with_system_unlocked(|| OSCCON.set(SLEEP_ENABLE)));
    cpu::sleep_while_zero(word);
    dma::suspended(|| with_system_unlocked(|| OSCCON.clear(SLEEP_ENABLE)));
}

/// How deep the chip has slept since the last call; `None` when it has not.
#[must_use]
pub fn take_rest() -> Option<Rest> {
    let state = RCON.read() & (SLEPT | IDLED);
    RCON.clear(state);
    match state {
        0 => None,
        IDLED => Some(Rest::Idle),
        _ => Some(Rest::Sleep),
    }
}

/// Whether the regulator of the core stays on in Sleep: it wakes sooner and takes more current. `unverified`.
pub fn keep_regulator_on(on: bool) {
    if on {
        RCON.set(REGULATOR_STAYS_ON);
    } else {
        RCON.clear(REGULATOR_STAYS_ON);
    }
}

#[cfg(test)]
mod tests {
    use super::{Rest, keep_regulator_on, take_rest};
    use crate::register::map::RCON;

    #[test]
    fn the_deepest_rest_is_told_once() {
        for (bits, rest) in [
            (1 << 2, Some(Rest::Idle)),
            (1 << 3, Some(Rest::Sleep)),
            (1 << 3 | 1 << 2, Some(Rest::Sleep)),
        ] {
            RCON.write(bits | 1 << 4);
            assert_eq!(take_rest(), rest);
            assert_eq!(RCON.read(), 1 << 4, "other causes stay");
            assert_eq!(take_rest(), None);
        }
        keep_regulator_on(true);
        assert_eq!(RCON.read(), 1 << 8 | 1 << 4);
        keep_regulator_on(false);
        assert_eq!(RCON.read(), 1 << 4);
    }
}
