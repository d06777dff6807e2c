//! Which beacons were in range lately. It outlives the brains of single runs, so that a run can begin with what a robot at rest hears.

use std::collections::BTreeMap;

/// A beacon that was silent for so long is out of range, microseconds. Modules as delivered measure every ten seconds at rest.
const LATELY_US: u64 = 30_000_000;
/// Most beacons that are followed; radios hear some, and a broken one may invent numbers.
const BEACONS_MAX: usize = 64;

/// When each beacon was measured last.
#[derive(Clone, Debug, Default)]
pub(super) struct HeardBeacons {
    last_us: BTreeMap<u16, u64>,
}

impl HeardBeacons {
    /// The distance of a beacon was measured.
    pub(super) fn hear(&mut self, now_us: u64, beacon: u16) {
        if self.last_us.len() >= BEACONS_MAX && !self.last_us.contains_key(&beacon) {
            self.last_us.retain(|_, last_us| is_lately(now_us, *last_us));
            if self.last_us.len() >= BEACONS_MAX {
                return;
            }
        }
        self.last_us.insert(beacon, now_us);
    }

    /// Number of beacons in range.
    pub(super) fn count(&self, now_us: u64) -> u8 {
        let count = self
            .last_us
            .values()
            .filter(|last_us| is_lately(now_us, **last_us))
            .count();
        u8::try_from(count).unwrap_or(u8::MAX)
    }
}

fn is_lately(now_us: u64, last_us: u64) -> bool {
    now_us.saturating_sub(last_us) < LATELY_US
}

#[cfg(test)]
mod tests {
    use super::HeardBeacons;

    #[test]
    fn beacons_count_while_they_are_heard_and_half_a_minute_longer() {
        let mut heard = HeardBeacons::default();
        assert_eq!(heard.count(0), 0);
        for beacon in 0..4 {
            heard.hear(1_000_000, beacon);
        }
        heard.hear(20_000_000, 2);
        assert_eq!(heard.count(30_000_000), 4);
        assert_eq!(heard.count(31_000_000), 1, "three were silent for half a minute");
        heard.hear(32_000_000, 0);
        assert_eq!(heard.count(32_000_000), 2, "one came back");
    }

    #[test]
    fn invented_numbers_take_no_room_for_ever() {
        let mut heard = HeardBeacons::default();
        for beacon in 0..1_000 {
            heard.hear(1, beacon);
        }
        assert_eq!(heard.count(2), 64);
        heard.hear(60_000_000, 7_000);
        assert_eq!(heard.count(60_000_000), 1);
    }
}
