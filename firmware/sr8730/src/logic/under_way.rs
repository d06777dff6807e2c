//! The bytes that a slave on SPI has given to the chip and that no master has clocked out yet.
//!
//! The chip keeps two: one in its shift register, one behind it. A byte that comes in says that one has left. When the chip
//! forgets both, because a transfer ended within a byte, they are given to it again.

use rvac_protocol::fill::FILL;

/// Bytes that the chip keeps.
const KEPT: usize = 2;

/// What the chip has, oldest first.
#[derive(Clone, Debug, Default)]
pub struct UnderWay {
    bytes: [u8; KEPT],
    count: usize,
    /// How many of them the chip still has.
    given: usize,
}

impl UnderWay {
    /// Nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bytes: [FILL; KEPT],
            count: 0,
            given: 0,
        }
    }

    /// The byte that the chip gets next: one that it has forgotten, or a new one from `more`, or fill.
    #[inline(always)]
    pub fn give(&mut self, more: impl FnOnce() -> Option<u8>) -> u8 {
        if self.given >= self.count {
            if self.count >= KEPT {
                // It had room although nobody said that one left.
                self.leave();
            }
            if let Some(place) = self.bytes.get_mut(self.count) {
                *place = more().unwrap_or(FILL);
                self.count += 1;
            }
        }
        let byte = self.bytes.get(self.given).copied().unwrap_or(FILL);
        self.given += 1;
        byte
    }

    /// The oldest has left.
    #[inline(always)]
    pub fn leave(&mut self) {
        let [_, second] = self.bytes;
        self.bytes = [second, FILL];
        self.count = self.count.saturating_sub(1);
        self.given = self.given.saturating_sub(1);
    }

    /// The chip has forgotten them all.
    #[inline(always)]
    pub const fn forget(&mut self) {
        self.given = 0;
    }

    /// Whether any of them means something.
    #[inline(always)]
    #[must_use]
    pub fn says_something(&self) -> bool {
        self.bytes != [FILL; KEPT]
    }
}

#[cfg(test)]
mod tests {
    use super::{FILL, UnderWay};
    use std::collections::VecDeque;
    use std::vec::Vec;

    /// A chip of two places that a master clocks and that forgets now and then: every byte leaves once, in order.
    #[test]
    fn every_byte_leaves_once_however_often_the_chip_forgets() {
        for forgets_after in 1..9 {
            let mut waiting: VecDeque<u8> = (1..=50).collect();
            let (mut under_way, mut chip, mut left) = (UnderWay::new(), VecDeque::new(), Vec::new());
            for turn in 0..200 {
                while chip.len() < 2 {
                    chip.push_back(under_way.give(|| waiting.pop_front()));
                }
                if turn % forgets_after == 0 {
                    chip.clear();
                    under_way.forget();
                    continue;
                }
                left.extend(chip.pop_front().filter(|byte| *byte != FILL));
                under_way.leave();
            }
            assert!(forgets_after == 1 || left.iter().copied().eq(1..=50), "{left:?}");
        }
    }

    #[test]
    fn it_says_something_until_the_last_byte_has_left() {
        let mut under_way = UnderWay::new();
        assert!(!under_way.says_something());
        assert_eq!(under_way.give(|| Some(7)), 7);
        assert_eq!(under_way.give(|| None), FILL);
        under_way.forget();
        assert!(under_way.says_something());
        assert_eq!(under_way.give(|| panic!("7 comes first")), 7);
        under_way.leave();
        assert!(!under_way.says_something());
    }

    #[test]
    fn a_chip_with_room_that_nobody_made_gets_the_next_byte() {
        let mut under_way = UnderWay::new();
        for byte in 1..=5 {
            assert_eq!(under_way.give(|| Some(byte)), byte);
        }
        under_way.forget();
        assert_eq!([under_way.give(|| None), under_way.give(|| None)], [4, 5]);
    }
}
