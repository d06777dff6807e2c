//! Letting a device in by presses of a button: each device that asks shows another pattern, and the person beside the robot presses that of
//! the device in their hand. What counts is who presses, so one wrong pattern ends the window.

use crate::DeviceName;
use crate::rhythm::{Heard, Rhythm};

/// Devices that can ask in one window.
pub const MATCHING_MAX: usize = 4;

/// Presses in a group. People press once to start the robot.
const PRESSES_MIN: u8 = 2;
const PRESSES_MAX: u8 = 6;

/// How often to press before and after the pause.
pub type Pattern = [u8; 2];

/// State of a device that asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// Nothing was pressed yet, or not all.
    Waits,
    /// Its pattern was pressed.
    Chosen,
    /// Another one was.
    Missed,
}

#[derive(Debug)]
struct Asking {
    session: [u8; 16],
    name: DeviceName,
    from: String,
    pattern: Pattern,
    standing: Standing,
}

/// The devices that ask in one window.
#[derive(Debug, Default)]
pub(crate) struct Matching {
    /// Nobody has these yet.
    free: Vec<Pattern>,
    asking: Vec<Asking>,
    rhythm: Rhythm,
}

impl Matching {
    /// Of a window that has just opened.
    pub(crate) fn new(random: [u8; 8]) -> Self {
        Self {
            free: patterns(random),
            ..Self::default()
        }
    }

    /// A device asks. One that asks again takes its own place; `None` when all are taken.
    pub(crate) fn join(&mut self, session: [u8; 16], name: DeviceName, from: &str) -> Option<Pattern> {
        let own = self.asking.iter().position(|other| other.from == from);
        let pattern = match own {
            Some(place) => self.asking.swap_remove(place).pattern,
            None if self.asking.len() < MATCHING_MAX => self.free.pop()?,
            None => return None,
        };
        self.asking.push(Asking {
            session,
            name,
            from: from.to_owned(),
            pattern,
            standing: Standing::Waits,
        });
        Some(pattern)
    }

    /// Whether presses are waited for.
    pub(crate) fn is_waited(&self) -> bool {
        self.asking.iter().any(|one| one.standing == Standing::Waits)
    }

    /// The button was pressed.
    pub(crate) fn press(&mut self, now_us: u64) {
        if self.is_waited() {
            self.rhythm.press(now_us);
        }
    }

    /// Whether a complete pattern was pressed, and whose it is.
    pub(crate) fn judge(&mut self, now_us: u64) -> Option<bool> {
        let pressed = match self.rhythm.heard(now_us, PRESSES_MAX) {
            Heard::Unfinished => return None,
            Heard::Pattern(pattern) => Some(pattern),
            Heard::Nonsense => None,
        };
        for one in &mut self.asking {
            one.standing = match pressed {
                Some(pattern) if pattern == one.pattern => Standing::Chosen,
                _ => Standing::Missed,
            };
        }
        self.rhythm = Rhythm::default();
        Some(self.asking.iter().any(|one| one.standing == Standing::Chosen))
    }

    /// State of this device.
    pub(crate) fn standing(&self, session: &[u8; 16]) -> Option<Standing> {
        let one = self.asking.iter().find(|one| one.session == *session)?;
        Some(one.standing)
    }

    /// The device comes in; its name.
    pub(crate) fn take(&mut self, session: &[u8; 16]) -> Option<DeviceName> {
        let place = self.asking.iter().position(|one| one.session == *session)?;
        Some(self.asking.swap_remove(place).name)
    }
}

/// Five patterns of which any two differ by three presses, so that a miscount by one or two is never another device's pattern:
/// a perfect Lee code on the square of all, shifted and shuffled.
fn patterns(random: [u8; 8]) -> Vec<Pattern> {
    const COUNTS: u8 = PRESSES_MAX - PRESSES_MIN + 1;
    let [shift, shuffle @ ..] = random;
    let first = |second: u8| (shift % COUNTS + 3 * second) % COUNTS;
    let mut all: Vec<Pattern> = (0..COUNTS)
        .map(|second| [first(second), second].map(|count| count + PRESSES_MIN))
        .collect();
    for (last, random) in (1..all.len()).rev().zip(shuffle) {
        all.swap(last, usize::from(random) % (last + 1));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{MATCHING_MAX, Matching, Pattern, Standing, patterns};
    use crate::DeviceName;

    const SECOND: u64 = 1_000_000;

    fn name() -> DeviceName {
        DeviceName::new("phone").unwrap()
    }

    fn press(matching: &mut Matching, pattern: Pattern) -> Option<bool> {
        let mut now_us = SECOND;
        for count in pattern {
            for _ in 0..count {
                matching.press(now_us);
                assert_eq!(matching.judge(now_us), None);
                now_us += SECOND / 2;
            }
            now_us += 2 * SECOND;
        }
        matching.judge(now_us + 2 * SECOND)
    }

    #[test]
    fn patterns_differ_by_three_presses_whatever_is_drawn() {
        for shift in 0..=255 {
            let all = patterns([shift, 3, 1, 4, 1, 5, 9, 2]);
            assert_eq!(all.len(), 5);
            for (place, one) in all.iter().enumerate() {
                assert!(one.iter().all(|count| (2..=6).contains(count)), "{one:?}");
                for other in &all[place + 1..] {
                    let apart = one[0].abs_diff(other[0]) + one[1].abs_diff(other[1]);
                    assert!(apart >= 3, "{one:?} {other:?}");
                }
            }
        }
    }

    #[test]
    fn only_the_device_whose_pattern_is_pressed_is_chosen() {
        let mut matching = Matching::new([1; 8]);
        let shown: Vec<Pattern> = (0..4)
            .map(|number| matching.join([number; 16], name(), &number.to_string()).unwrap())
            .collect();
        assert_eq!(matching.join([9; 16], name(), "fifth"), None, "{MATCHING_MAX}");
        assert_eq!(press(&mut matching, shown[2]), Some(true));
        let standings = [0, 1, 2, 3].map(|number| matching.standing(&[number; 16]).unwrap());
        let missed = Standing::Missed;
        assert_eq!(standings, [missed, missed, Standing::Chosen, missed]);
        assert_eq!(matching.take(&[2; 16]), Some(name()));
        assert_eq!(matching.standing(&[2; 16]), None, "once");
    }

    #[test]
    fn a_miscount_chooses_nobody() {
        let mut matching = Matching::new([1; 8]);
        let [first, second] = matching.join([0; 16], name(), "a").unwrap();
        matching.join([1; 16], name(), "b").unwrap();
        let miscounted = [if first == 2 { 3 } else { first - 1 }, second];
        assert_eq!(press(&mut matching, miscounted), Some(false));
        assert_eq!(matching.standing(&[0; 16]), Some(Standing::Missed));
        assert!(!matching.is_waited());
    }

    #[test]
    fn whoever_asks_again_takes_no_second_place() {
        let mut matching = Matching::new([1; 8]);
        let first = matching.join([0; 16], name(), "a");
        assert_eq!(matching.join([1; 16], name(), "a"), first);
        assert_eq!(matching.standing(&[0; 16]), None);
        for number in 2..5 {
            assert!(matching.join([number; 16], name(), &number.to_string()).is_some());
        }
    }

    #[test]
    fn presses_that_nobody_waits_for_count_for_nothing() {
        let mut matching = Matching::new([1; 8]);
        matching.press(0);
        assert_eq!(matching.judge(100 * SECOND), None);
    }
}
