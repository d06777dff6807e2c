//! Events on their way to the host: numbered, repeated until confirmed.

use heapless::Deque;
use rvac_units::Tick;

use super::Mode;
use crate::message::{Event, NumberedEvent, Sequence};
use crate::session::EVENTS_WAITING;

/// Pause between repeats.
pub(super) const REPEAT_MS: u32 = 100;
/// Events that are repeated at a time, so that repeats leave room on the line.
const REPEATED: usize = 4;

#[derive(Clone, Copy, Debug)]
struct Waiting {
    event: NumberedEvent,
    sent: Option<Tick>,
}

/// The queue.
#[derive(Clone, Debug, Default)]
pub(super) struct EventQueue {
    waiting: Deque<Waiting, EVENTS_WAITING>,
    next_number: u16,
}

impl EventQueue {
    pub(super) fn queue(&mut self, kind: Event, tick: Tick) {
        if self.waiting.is_full() {
            self.waiting.pop_front();
        }
        let event = NumberedEvent {
            number: self.next_number,
            tick,
            kind,
        };
        self.next_number = self.next_number.wrapping_add(1);
        // There is room: the oldest has just left.
        self.waiting.push_back(Waiting { event, sent: None }).ok();
    }

    /// The event to send now. In hand mode each event is sent once and dropped, because nobody confirms it.
    pub(super) fn take_due(&mut self, mode: Mode, now: Tick) -> Option<NumberedEvent> {
        if mode == Mode::Hand {
            return self.waiting.pop_front().map(|waiting| waiting.event);
        }
        let due = self
            .waiting
            .iter_mut()
            .enumerate()
            .find(|(index, waiting)| match waiting.sent {
                None => true,
                Some(sent) => *index < REPEATED && now.since(sent) >= REPEAT_MS,
            });
        due.map(|(_, waiting)| {
            waiting.sent = Some(now);
            waiting.event
        })
    }

    /// Drops all events up to and including `number`.
    pub(super) fn confirm(&mut self, number: u16) {
        while let Some(waiting) = self.waiting.front() {
            if Sequence(waiting.event.number).is_newer_than(Sequence(number)) {
                break;
            }
            self.waiting.pop_front();
        }
    }

    /// A new session: numbers start at 0, and the first `state` shows the present levels.
    pub(super) fn restart(&mut self) {
        *self = Self::default();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}
