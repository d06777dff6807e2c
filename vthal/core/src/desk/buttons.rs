//! What a person means with the buttons on the robot: a short press, or a hold that only a person beside the robot can do.
//!
//! Events say that a button went down or up and are never lost; reports say ever again which are down. A hold counts only as long as
//! both agree without a gap, so that neither a broken line nor a button that was down already at the start can hold anything. Each hold is
//! reported once: a button that is stuck reports nothing more until it was released.

use std::collections::BTreeMap;

use rvac_api::Gesture;

use crate::ClientId;

/// The button that starts and stops, on robots with several.
pub(crate) const START: u8 = 0;
/// The button that sends home, where there is one.
pub(crate) const DOCK: u8 = 2;

/// A press that lasts longer is none: the person may have meant to hold.
const PRESS_US: u64 = 1_500_000;
/// How long START is held to let a device in.
const PAIRING_US: u64 = 5_000_000;
/// How long START and DOCK are held to forget all devices.
const RECOVERY_US: u64 = 15_000_000;
/// Reports farther apart have not seen what was held between them.
const GAP_US: u64 = 500_000;
/// Longest time for which a client may keep presses for itself.
const CLAIM_MS_MAX: u32 = 180_000;

/// Everything from the first button that goes down to the last one that comes up.
#[derive(Clone, Copy, Debug)]
struct HeldButtons {
    down: u8,
    /// All that were down in it.
    ever: u8,
    began_us: u64,
    /// Since when `down` is as it is, and reports say the same.
    since_us: u64,
    /// The newest event or report.
    seen_us: u64,
    is_reported: bool,
}

/// The buttons of one robot.
#[derive(Debug, Default)]
pub(crate) struct Buttons {
    grip: Option<HeldButtons>,
    /// Clients that keep presses for themselves, and until when.
    claims: BTreeMap<ClientId, u64>,
}

impl Buttons {
    /// A button went down or up.
    pub(crate) fn take_edge(&mut self, now_us: u64, button: u8, pressed: bool) -> Option<Gesture> {
        let bit = 1_u8.checked_shl(button.into())?;
        if pressed {
            self.press(now_us, bit);
            return None;
        }
        let grip = self.grip.as_mut().filter(|grip| grip.down & bit != 0)?;
        grip.down &= !bit;
        (grip.since_us, grip.seen_us) = (now_us, now_us);
        let grip = *grip;
        if grip.down != 0 {
            return None;
        }
        self.grip = None;
        let is_press = grip.ever.is_power_of_two() && now_us - grip.began_us <= PRESS_US;
        is_press.then_some(Gesture::Press)
    }

    fn press(&mut self, now_us: u64, bit: u8) {
        let grip = self.grip.get_or_insert(HeldButtons {
            down: 0,
            ever: 0,
            began_us: now_us,
            since_us: now_us,
            seen_us: now_us,
            is_reported: false,
        });
        grip.down |= bit;
        grip.ever |= bit;
        (grip.since_us, grip.seen_us, grip.is_reported) = (now_us, now_us, false);
    }

    /// A report says which are down.
    pub(crate) fn take_report(&mut self, now_us: u64, down: u8) -> Option<Gesture> {
        let grip = self.grip.as_mut()?;
        if down != grip.down || now_us - grip.seen_us > GAP_US {
            grip.since_us = now_us;
        }
        grip.seen_us = now_us;
        let gesture = held(grip.ever, now_us - grip.since_us).filter(|_| grip.down == grip.ever)?;
        let is_new = !grip.is_reported;
        grip.is_reported = true;
        is_new.then_some(gesture)
    }

    /// Events may have been lost: buttons that are down must be released first.
    pub(crate) fn forget(&mut self) {
        self.grip = None;
    }

    /// Keeps presses for a client for so long, or no longer with 0.
    pub(crate) fn claim(&mut self, now_us: u64, client: ClientId, ms: u32) {
        let until_us = now_us + u64::from(ms.min(CLAIM_MS_MAX)) * 1000;
        self.claims.insert(client, until_us);
        self.claims.retain(|_, until_us| now_us < *until_us);
    }

    /// The client is gone.
    pub(crate) fn forget_client(&mut self, client: ClientId) {
        self.claims.remove(&client);
    }

    /// Whether presses are meant for pairing rather than for the robot.
    pub(crate) fn are_claimed(&self, now_us: u64) -> bool {
        self.claims.values().any(|until_us| now_us < *until_us)
    }
}

/// What it means that exactly these were held for so long.
fn held(buttons: u8, for_us: u64) -> Option<Gesture> {
    const ONE: u8 = 1 << START;
    const BOTH: u8 = 1 << START | 1 << DOCK;
    match buttons {
        ONE if for_us >= PAIRING_US => Some(Gesture::PairingHold),
        BOTH if for_us >= RECOVERY_US => Some(Gesture::RecoveryHold),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Gesture;

    use super::{Buttons, DOCK, START};
    use crate::ClientId;

    const MS: u64 = 1000;
    const SECOND: u64 = 1000 * MS;

    /// A robot that reports fifty times a second.
    #[derive(Default)]
    struct Robot {
        buttons: Buttons,
        down: u8,
        now_us: u64,
        gestures: Vec<(u64, Gesture)>,
    }

    impl Robot {
        fn turn(&mut self, button: u8, pressed: bool) {
            self.down ^= 1 << button;
            let gesture = self.buttons.take_edge(self.now_us, button, pressed);
            self.gestures
                .extend(gesture.map(|gesture| (self.now_us, gesture)));
        }

        fn run(&mut self, for_us: u64) {
            let end_us = self.now_us + for_us;
            while self.now_us < end_us {
                self.now_us += 20 * MS;
                let gesture = self.buttons.take_report(self.now_us, self.down);
                self.gestures
                    .extend(gesture.map(|gesture| (self.now_us, gesture)));
            }
        }

        fn hold(&mut self, button: u8, for_us: u64) {
            self.turn(button, true);
            self.run(for_us);
            self.turn(button, false);
        }

        fn gestures(&self) -> Vec<Gesture> {
            self.gestures.iter().map(|(_, gesture)| *gesture).collect()
        }
    }

    #[test]
    fn a_short_press_is_told_when_it_ends_and_a_longer_one_is_nothing() {
        let mut robot = Robot::default();
        robot.hold(START, 200 * MS);
        robot.run(SECOND);
        robot.hold(START, 3 * SECOND);
        assert_eq!(robot.gestures, [(200 * MS, Gesture::Press)]);
    }

    #[test]
    fn start_held_for_five_seconds_is_reported_once_however_long_it_is_stuck() {
        let mut robot = Robot::default();
        robot.hold(START, 3600 * SECOND);
        assert_eq!(robot.gestures, [(5 * SECOND, Gesture::PairingHold)]);
    }

    #[test]
    fn both_held_for_fifteen_seconds_forget_and_let_nobody_in() {
        let mut robot = Robot::default();
        robot.turn(START, true);
        robot.run(2 * SECOND);
        robot.hold(DOCK, 16 * SECOND);
        robot.run(20 * SECOND);
        robot.turn(START, false);
        assert_eq!(robot.gestures(), [Gesture::RecoveryHold]);
    }

    #[test]
    fn what_was_down_before_anybody_looked_holds_nothing() {
        let mut robot = Robot {
            down: 1 << START,
            ..Robot::default()
        };
        robot.run(60 * SECOND);
        robot.turn(START, false);
        assert_eq!(robot.gestures(), []);
    }

    #[test]
    fn a_hold_that_was_not_seen_throughout_is_none() {
        let mut robot = Robot::default();
        robot.turn(START, true);
        robot.run(4 * SECOND);
        robot.now_us += 4 * SECOND;
        robot.run(3 * SECOND);
        robot.buttons.forget();
        robot.run(10 * SECOND);
        robot.turn(START, false);
        // The event of the release is late, and the reports say already that nothing is down.
        robot.turn(START, true);
        robot.down = 0;
        robot.run(10 * SECOND);
        assert_eq!(robot.gestures(), []);
    }

    #[test]
    fn another_button_makes_it_neither_a_press_nor_a_hold() {
        let mut robot = Robot::default();
        robot.turn(START, true);
        robot.hold(1, 200 * MS);
        robot.run(20 * SECOND);
        robot.turn(START, false);
        assert_eq!(robot.gestures(), []);
    }

    #[test]
    fn a_claim_ends_by_itself_with_its_client_and_by_a_word() {
        let mut buttons = Buttons::default();
        let (one, other) = (ClientId(1), ClientId(2));
        buttons.claim(0, one, 1000);
        buttons.claim(0, other, u32::MAX);
        assert!(buttons.are_claimed(500 * MS));
        buttons.claim(SECOND, other, 0);
        assert!(!buttons.are_claimed(SECOND));
        buttons.claim(2 * SECOND, one, u32::MAX);
        assert!(
            !buttons.are_claimed(2 * SECOND + 180 * SECOND),
            "at most three minutes"
        );
        buttons.forget_client(one);
        assert!(!buttons.are_claimed(2 * SECOND));
    }
}
