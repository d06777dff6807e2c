//! Lights that are on, off, or blink at 1 Hz.

use rvac_protocol::message::{Led, LedPattern};
use rvac_units::{Ratio, Tick};

use crate::board::Lights;
use crate::timing::Periodic;

/// Most lights a board can have.
const LIGHTS: usize = 16;
const HALF_BLINK_MS: u32 = 500;

/// What each light does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightPatterns {
    patterns: [(LedPattern, Ratio); LIGHTS],
    blink: Periodic,
    lit_phase: bool,
}

impl LightPatterns {
    /// All off.
    pub(crate) const fn new(now: Tick) -> Self {
        Self {
            patterns: [(LedPattern::Off, Ratio::ZERO); LIGHTS],
            blink: Periodic::starting_at(now),
            lit_phase: false,
        }
    }

    /// Sets one light; false if there is no such light.
    pub(crate) fn set<L: Lights>(&mut self, lights: &mut L, led: &Led) -> bool {
        if led.led >= L::COUNT {
            return false;
        }
        let Some(place) = self.patterns.get_mut(usize::from(led.led)) else {
            return false;
        };
        *place = (led.pattern, led.brightness);
        lights.set(led.led, brightness(*place, self.lit_phase));
        true
    }

    /// Lets lights blink.
    pub(crate) fn blink<L: Lights>(&mut self, lights: &mut L, now: Tick) {
        if L::COUNT == 0 || !self.blink.is_due(now, HALF_BLINK_MS) {
            return;
        }
        self.lit_phase = !self.lit_phase;
        for (number, pattern) in (0..L::COUNT).zip(&self.patterns) {
            if pattern.0 == LedPattern::Blink {
                lights.set(number, brightness(*pattern, self.lit_phase));
            }
        }
    }
}

const fn brightness(pattern: (LedPattern, Ratio), lit_phase: bool) -> Ratio {
    match pattern.0 {
        LedPattern::On => pattern.1,
        LedPattern::Blink if lit_phase => pattern.1,
        LedPattern::Off | LedPattern::Blink => Ratio::ZERO,
    }
}
