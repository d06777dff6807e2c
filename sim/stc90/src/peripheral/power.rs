//! PCON: idle, power-down, and the bits that the UART looks at.

const POWER_ON: u8 = 0x10;
const DOWN: u8 = 0x02;
const IDLE: u8 = 0x01;
/// Bits that exist: SMOD, SMOD0, POF, GF1, GF0, PD and IDL.
const BITS: u8 = 0xDF;

/// PCON and what it does.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Power {
    pcon: u8,
}

impl Power {
    /// The flag that tells power-on from other resets is kept by those.
    pub(super) fn reset(&mut self, is_power_on: bool) {
        self.pcon = if is_power_on {
            POWER_ON
        } else {
            self.pcon & POWER_ON
        };
    }

    pub(super) fn pcon(&self) -> u8 {
        self.pcon
    }

    pub(super) fn set_pcon(&mut self, value: u8) {
        self.pcon = value & BITS;
    }

    /// The core does nothing.
    pub(super) fn is_asleep(&self) -> bool {
        self.pcon & (DOWN | IDLE) != 0
    }

    /// Nothing has a clock.
    pub(super) fn is_down(&self) -> bool {
        self.pcon & DOWN != 0
    }

    /// The core goes on; says whether it slept.
    pub(super) fn wake(&mut self) -> bool {
        let slept = self.is_asleep();
        self.pcon &= !(DOWN | IDLE);
        slept
    }
}
