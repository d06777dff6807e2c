//! S28: any button press while the robot moves stops it, without the host, until it is armed again.

use rvac_units::Tick;

use crate::timing::Held;

/// A press must be stable this long, well below the 50 ms of the rule.
const STABLE_MS: u32 = 10;

/// Eight debounced buttons.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ButtonRule {
    down: u8,
    raw: u8,
    stable: Held,
}

/// Buttons that changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ButtonChange {
    /// Went down, bit by number.
    pub(crate) pressed: u8,
    /// Went up, bit by number.
    pub(crate) released: u8,
}

impl ButtonRule {
    /// Takes the raw buttons; returns what changed.
    pub(crate) fn update(&mut self, raw: u8, now: Tick) -> ButtonChange {
        if raw != self.raw {
            self.raw = raw;
            self.stable.restart();
        }
        if !self.stable.for_at_least(raw != self.down, now, STABLE_MS) {
            return ButtonChange::default();
        }
        let change = ButtonChange {
            pressed: raw & !self.down,
            released: self.down & !raw,
        };
        self.down = raw;
        self.stable.restart();
        change
    }

    /// Buttons that are down, bit by number.
    pub(crate) const fn down(&self) -> u8 {
        self.down
    }
}
