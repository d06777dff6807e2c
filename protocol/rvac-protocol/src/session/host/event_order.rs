//! Delivers events in order and once.

use rvac_units::Tick;

use crate::session::EVENTS_WAITING;

/// A gap that repeats have not filled after this long is permanent.
const GAP_MS: u32 = 2_000;

/// How the host treats an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    /// Deliver it.
    Next,
    /// It was delivered before, or it came too early and will be repeated.
    Hold,
    /// This many are lost; the event itself will be repeated.
    Lost(u16),
}

/// Which event is expected.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EventOrder {
    expected: u16,
    gap_since: Option<Tick>,
    unconfirmed: bool,
}

impl EventOrder {
    pub(super) fn take(&mut self, number: u16, now: Tick) -> Arrival {
        let ahead = number.wrapping_sub(self.expected);
        if ahead == 0 {
            self.expected = number.wrapping_add(1);
            self.gap_since = None;
            self.unconfirmed = true;
            return Arrival::Next;
        }
        if ahead >= 0x8000 {
            self.unconfirmed = true;
            return Arrival::Hold;
        }
        let since = *self.gap_since.get_or_insert(now);
        // The robot's queue never spans more numbers, so older events are no longer in it.
        let beyond_queue = ahead.saturating_add(1).saturating_sub(EVENTS_WAITING as u16);
        let lost = if now.since(since) >= GAP_MS {
            ahead
        } else {
            beyond_queue
        };
        if lost == 0 {
            return Arrival::Hold;
        }
        self.expected = self.expected.wrapping_add(lost);
        self.gap_since = None;
        Arrival::Lost(lost)
    }

    /// The number to confirm now, if one is due.
    pub(super) fn take_confirmation(&mut self) -> Option<u16> {
        let due = core::mem::take(&mut self.unconfirmed);
        due.then(|| self.expected.wrapping_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use rvac_units::Tick;

    use super::{Arrival, EventOrder};

    #[test]
    fn once_and_in_order() {
        let mut order = EventOrder::default();
        assert_eq!(order.take(0, Tick(0)), Arrival::Next);
        assert_eq!(order.take(2, Tick(1)), Arrival::Hold);
        assert_eq!(order.take_confirmation(), Some(0));
        assert_eq!(order.take_confirmation(), None);
        assert_eq!(order.take(1, Tick(100)), Arrival::Next);
        assert_eq!(order.take(2, Tick(101)), Arrival::Next);
        assert_eq!(order.take(0, Tick(102)), Arrival::Hold);
        assert_eq!(order.take_confirmation(), Some(2));
    }

    #[test]
    fn a_gap_that_stays_is_reported_and_skipped() {
        let mut order = EventOrder::default();
        assert_eq!(order.take(4, Tick(0)), Arrival::Hold);
        assert_eq!(order.take(4, Tick(1_999)), Arrival::Hold);
        assert_eq!(order.take(4, Tick(2_000)), Arrival::Lost(4));
        assert_eq!(order.take(4, Tick(2_100)), Arrival::Next);
    }

    #[test]
    fn what_cannot_be_in_the_queue_any_more_is_lost_at_once() {
        let mut order = EventOrder::default();
        assert_eq!(order.take(15, Tick(0)), Arrival::Hold);
        assert_eq!(order.take(19, Tick(1)), Arrival::Lost(4));
        assert_eq!(order.take(4, Tick(2)), Arrival::Next);
    }
}
