//! What comes over the link, counted: how good it is and what is wrong with it.

use rvac_units::Tick;

/// Packets of some time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PacketCounts {
    /// Undamaged ones.
    pub good: u32,
    /// Those with a wrong CRC, and what is no packet.
    pub bad: u32,
}

impl PacketCounts {
    /// Good and bad ones.
    #[must_use]
    pub const fn all(self) -> u32 {
        self.good.saturating_add(self.bad)
    }

    /// Share of the bad ones, 0..1.
    #[must_use]
    pub fn bad_share(self) -> f64 {
        f64::from(self.bad) / f64::from(self.all().max(1))
    }

    const fn plus(self, other: Self) -> Self {
        Self {
            good: self.good.saturating_add(other.good),
            bad: self.bad.saturating_add(other.bad),
        }
    }
}

/// Quality of the link as the host sees it, over the last 5 s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkQuality {
    /// Packets from the robot.
    pub inbound: PacketCounts,
    /// Packets to the robot, as it counts them in its `info`.
    pub outbound: PacketCounts,
    /// Newest round trip of a numbered command in ms.
    pub round_trip_ms: Option<u32>,
}

impl LinkQuality {
    /// Packets of both directions.
    #[must_use]
    pub const fn both(self) -> PacketCounts {
        self.inbound.plus(self.outbound)
    }
}

/// What has come from the robot, as totals that wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrivals {
    /// States that were newer than all before.
    pub states: u32,
    /// Pieces that are no packets of a robot.
    pub garbled: u32,
    /// Packets whose CRC is wrong.
    pub corrupted: u32,
    /// States with the tick of the one before.
    pub repeated: u32,
    /// States whose tick does not follow from those before.
    pub stray: u32,
    /// Jumps of the robot's clock that were believed.
    pub clock_jumps: u32,
}

impl Arrivals {
    /// What came after `earlier`.
    #[must_use]
    pub const fn since(self, earlier: Self) -> Self {
        Self {
            states: self.states.wrapping_sub(earlier.states),
            garbled: self.garbled.wrapping_sub(earlier.garbled),
            corrupted: self.corrupted.wrapping_sub(earlier.corrupted),
            repeated: self.repeated.wrapping_sub(earlier.repeated),
            stray: self.stray.wrapping_sub(earlier.stray),
            clock_jumps: self.clock_jumps.wrapping_sub(earlier.clock_jumps),
        }
    }
}

/// Length of the window in slices.
const SLICES: usize = 5;
/// Length of a slice.
const SLICE_MS: u32 = 1_000;

/// Good and bad packets of the last five seconds, in one direction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QualityWindow {
    slices: [PacketCounts; SLICES],
    newest: usize,
    newest_since: Tick,
}

impl QualityWindow {
    pub(crate) fn record(&mut self, good: u32, bad: u32, now: Tick) {
        self.turn(now);
        if let Some(slice) = self.slices.get_mut(self.newest) {
            *slice = slice.plus(PacketCounts { good, bad });
        }
    }

    /// Drops old slices.
    pub(crate) fn turn(&mut self, now: Tick) {
        let passed = now.since(self.newest_since) / SLICE_MS;
        for _ in 0..passed.min(SLICES as u32) {
            self.newest = self.newest.wrapping_add(1) % SLICES;
            if let Some(slice) = self.slices.get_mut(self.newest) {
                *slice = PacketCounts::default();
            }
        }
        self.newest_since = self.newest_since.after(passed.saturating_mul(SLICE_MS));
    }

    /// All of them.
    pub(crate) fn totals(&self) -> PacketCounts {
        self.slices
            .iter()
            .fold(PacketCounts::default(), |sum, slice| sum.plus(*slice))
    }
}

#[cfg(test)]
mod tests {
    use rvac_units::Tick;

    use super::{Arrivals, PacketCounts, QualityWindow};

    #[test]
    fn shares_are_of_all_packets_and_totals_wrap() {
        let share = |good, bad| PacketCounts { good, bad }.bad_share();
        assert_eq!((share(0, 0), share(3, 1), share(0, 2)), (0.0, 0.25, 1.0));
        let before = Arrivals {
            states: u32::MAX,
            ..Arrivals::default()
        };
        assert_eq!(Arrivals::default().since(before).states, 1);
    }

    /// Two `info` of a robot whose counters stand near 2^32 once ended the daemon.
    #[test]
    fn no_count_of_a_robot_is_too_large() {
        let mut window = QualityWindow::default();
        let now = Tick(0);
        window.record(u32::MAX - 1, u32::MAX, now);
        window.record(u32::MAX - 1, u32::MAX, now.after(1));
        window.record(1, 1, now.after(2_000));
        let most = PacketCounts {
            good: u32::MAX,
            bad: u32::MAX,
        };
        assert_eq!(window.totals(), most);
        assert_eq!(most.all(), u32::MAX);
        assert_eq!(most.bad_share(), 1.0);
    }

    #[test]
    fn what_is_older_than_five_seconds_does_not_count() {
        let mut window = QualityWindow::default();
        let start = Tick(u32::MAX - 2_000);
        window.turn(start);
        window.record(0, 50, start);
        window.record(50, 0, start.after(4_000));
        assert_eq!(window.totals(), PacketCounts { good: 50, bad: 50 });
        window.turn(start.after(6_000));
        assert_eq!(window.totals(), PacketCounts { good: 50, bad: 0 });
        window.turn(start.after(60_000));
        assert_eq!(window.totals(), PacketCounts::default());
    }
}
