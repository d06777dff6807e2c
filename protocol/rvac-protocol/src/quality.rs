//! Quality of the link, and the speed that it allows.

use rvac_units::Tick;

/// The speed that the quality of the link allows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LinkVerdict {
    /// At most 1 % of the packets of the last 5 s were bad: full speed.
    #[default]
    Good,
    /// More than 1 %: half speed.
    Poor,
    /// More than 10 %: stop.
    Bad,
}

/// Quality of the link as the host sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkQuality {
    /// Packets of the last 5 s, in both directions as far as known.
    pub packets: u32,
    /// Bad ones among them.
    pub bad: u32,
    /// Newest round trip of a numbered command in ms.
    pub round_trip_ms: Option<u32>,
    /// The worse of both directions.
    pub verdict: LinkVerdict,
}

/// Length of the window in slices.
const SLICES: usize = 5;
/// Length of a slice.
const SLICE_MS: u32 = 1_000;

/// Good and bad packets of the last five seconds, in one direction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QualityWindow {
    slices: [Slice; SLICES],
    newest: usize,
    newest_since: Tick,
}

#[derive(Clone, Copy, Debug, Default)]
struct Slice {
    good: u32,
    bad: u32,
}

impl QualityWindow {
    pub(crate) fn record(&mut self, good: u32, bad: u32, now: Tick) {
        self.turn(now);
        if let Some(slice) = self.slices.get_mut(self.newest) {
            slice.good = slice.good.saturating_add(good);
            slice.bad = slice.bad.saturating_add(bad);
        }
    }

    /// Drops old slices.
    pub(crate) fn turn(&mut self, now: Tick) {
        let passed = now.since(self.newest_since) / SLICE_MS;
        for _ in 0..passed.min(SLICES as u32) {
            self.newest = (self.newest + 1) % SLICES;
            if let Some(slice) = self.slices.get_mut(self.newest) {
                *slice = Slice::default();
            }
        }
        self.newest_since = self.newest_since.after(passed * SLICE_MS);
    }

    /// Good and bad packets.
    pub(crate) fn totals(&self) -> (u32, u32) {
        self.slices
            .iter()
            .fold((0, 0), |(good, bad), slice| (good + slice.good, bad + slice.bad))
    }

    pub(crate) fn verdict(&self) -> LinkVerdict {
        let (good, bad) = self.totals();
        let all = u64::from(good) + u64::from(bad);
        let bad = u64::from(bad);
        if bad * 10 > all {
            LinkVerdict::Bad
        } else if bad * 100 > all {
            LinkVerdict::Poor
        } else {
            LinkVerdict::Good
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_units::Tick;

    use super::{LinkVerdict, QualityWindow};

    #[track_caller]
    fn check(good: u32, bad: u32, expected: LinkVerdict) {
        let mut window = QualityWindow::default();
        window.record(good, bad, Tick(10));
        assert_eq!(window.verdict(), expected, "{bad} bad of {}", good + bad);
    }

    #[test]
    fn limits_are_one_and_ten_percent() {
        check(0, 0, LinkVerdict::Good);
        check(99, 1, LinkVerdict::Good);
        check(98, 2, LinkVerdict::Poor);
        check(90, 10, LinkVerdict::Poor);
        check(89, 11, LinkVerdict::Bad);
    }

    #[test]
    fn what_is_older_than_five_seconds_does_not_count() {
        let mut window = QualityWindow::default();
        let start = Tick(u32::MAX - 2_000);
        window.turn(start);
        window.record(0, 50, start);
        window.record(50, 0, start.after(4_000));
        assert_eq!(window.totals(), (50, 50));
        window.turn(start.after(6_000));
        assert_eq!(window.totals(), (50, 0));
        window.turn(start.after(60_000));
        assert_eq!(window.totals(), (0, 0));
    }
}
