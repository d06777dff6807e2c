//! S28: any button press during motion stops the robot, without the host, until it is armed again.

use rvac_units::Tick;

use crate::rules::button::STABLE_MS;
use crate::timing::Debounced;

/// Eight buttons, each debounced on its own: one that chatters must not hide a press of another.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ButtonRule {
    buttons: [Debounced<STABLE_MS, STABLE_MS>; 8],
    any: Debounced<STABLE_MS, STABLE_MS>,
    down: u8,
    raw: u8,
}

/// Buttons that changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ButtonChange {
    /// Went down, bit by number.
    pub(crate) pressed: u8,
    /// Went up, bit by number.
    pub(crate) released: u8,
    /// Any button went down: what S28 needs.
    pub(crate) any_pressed: bool,
}

impl ButtonRule {
    /// Takes the raw buttons, and whether any is down (a board may know that without knowing which); returns what
    /// changed.
    pub(crate) fn update(&mut self, raw: u8, any: bool, now: Tick) -> ButtonChange {
        let before = self.any.is_active();
        let any_pressed = self.any.update(any || raw != 0, now) && !before;
        let change = self.update_known(raw, now);
        ButtonChange {
            any_pressed: any_pressed || change.pressed != 0,
            ..change
        }
    }

    fn update_known(&mut self, raw: u8, now: Tick) -> ButtonChange {
        let settled = raw == self.down && self.raw == self.down;
        self.raw = raw;
        if settled {
            return ButtonChange::default();
        }
        let before = self.down;
        self.down = 0;
        for (number, button) in self.buttons.iter_mut().enumerate() {
            let bit = 1 << number;
            if button.update(raw & bit != 0, now) {
                self.down |= bit;
            }
        }
        ButtonChange {
            pressed: self.down & !before,
            released: before & !self.down,
            any_pressed: false,
        }
    }

    /// Whether any button is down.
    pub(crate) const fn any_down(&self) -> bool {
        self.any.is_active() || self.down != 0
    }

    /// Buttons that are down, bit by number.
    pub(crate) const fn down(&self) -> u8 {
        self.down
    }
}

#[cfg(test)]
mod tests {
    use super::{ButtonChange, ButtonRule, STABLE_MS};
    use rvac_units::Tick;

    #[test]
    fn a_chattering_button_does_not_hide_another() {
        let mut rule = ButtonRule::default();
        let pressed: u8 = (0..=STABLE_MS)
            .map(|ms| rule.update(0b100 | (ms & 1) as u8, true, Tick(ms)).pressed)
            .fold(0, |all, pressed| all | pressed);
        assert_eq!(pressed, 0b100);
        assert_eq!(rule.down(), 0b100);
    }

    #[test]
    fn short_contacts_are_no_press() {
        let mut rule = ButtonRule::default();
        for ms in 0..STABLE_MS {
            assert_eq!(rule.update(1, true, Tick(ms)), ButtonChange::default());
        }
        assert_eq!(rule.update(0, false, Tick(STABLE_MS)), ButtonChange::default());
        assert_eq!(
            rule.update(0, false, Tick(STABLE_MS + 1)),
            ButtonChange::default()
        );
        assert_eq!(rule.update(1, true, Tick(STABLE_MS + 2)), ButtonChange::default());
    }

    #[test]
    fn a_press_counts_without_knowing_which_button() {
        let mut rule = ButtonRule::default();
        let changes = (0..=STABLE_MS).map(|ms| rule.update(0, true, Tick(ms)));
        let pressed: usize = changes.filter(|change| change.any_pressed).count();
        assert_eq!(pressed, 1);
        assert!(rule.any_down());
        assert_eq!(rule.down(), 0);
    }
}
