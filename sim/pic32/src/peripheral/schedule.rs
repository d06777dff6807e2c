//! The next call of each peripheral. Nothing is polled: the machine runs to the nearest of these cycles.

use super::rate::NEVER;

/// A peripheral that can be called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    /// A level that was set ahead of time changes on a pin.
    Input,
    /// A period of timer 1 to 5 (0 to 4) ends.
    Timer(u8),
    /// Output compare 1 to 5 (0 to 4) changes its pin.
    Compare(u8),
    /// The analog converter ends sampling or converting.
    Analog,
    /// A byte has left UART 1 or 2 (0 or 1).
    Transmitter(u8),
    /// A byte has arrived at UART 1 or 2 (0 or 1).
    Receiver(u8),
    /// The clock of SPI 1 or 2 (0 or 1) changes.
    Spi(u8),
    /// A time of I2C 1 or 2 (0 or 1) is over.
    I2c(u8),
    /// The comparators look at their inputs.
    Comparators,
    /// A half second of the calendar is over.
    Calendar,
    /// A flash operation ends.
    Flash,
    /// The clock changes.
    Clock,
    /// The clock runs again after Sleep.
    Wake,
    /// The watchdog barks.
    Watchdog,
    /// A phase of an access of the parallel port ends.
    Parallel,
    /// DMA moves something.
    Dma,
}

const SLOTS: [Slot; 28] = [
    Slot::Input,
    Slot::Timer(0),
    Slot::Timer(1),
    Slot::Timer(2),
    Slot::Timer(3),
    Slot::Timer(4),
    Slot::Compare(0),
    Slot::Compare(1),
    Slot::Compare(2),
    Slot::Compare(3),
    Slot::Compare(4),
    Slot::Analog,
    Slot::Transmitter(0),
    Slot::Transmitter(1),
    Slot::Receiver(0),
    Slot::Receiver(1),
    Slot::Spi(0),
    Slot::Spi(1),
    Slot::I2c(0),
    Slot::I2c(1),
    Slot::Flash,
    Slot::Clock,
    Slot::Wake,
    Slot::Watchdog,
    Slot::Comparators,
    Slot::Calendar,
    Slot::Parallel,
    Slot::Dma,
];

impl Slot {
    const fn place(self) -> usize {
        match self {
            Slot::Input => 0,
            Slot::Timer(number) => 1 + number as usize,
            Slot::Compare(number) => 6 + number as usize,
            Slot::Analog => 11,
            Slot::Transmitter(number) => 12 + number as usize,
            Slot::Receiver(number) => 14 + number as usize,
            Slot::Spi(number) => 16 + number as usize,
            Slot::I2c(number) => 18 + number as usize,
            Slot::Flash => 20,
            Slot::Clock => 21,
            Slot::Wake => 22,
            Slot::Watchdog => 23,
            Slot::Comparators => 24,
            Slot::Calendar => 25,
            Slot::Parallel => 26,
            Slot::Dma => 27,
        }
    }
}

/// The calls that are due.
#[derive(Clone, Debug)]
pub(crate) struct Schedule {
    due: [u64; SLOTS.len()],
    next: u64,
}

impl Schedule {
    pub(crate) fn new() -> Schedule {
        Schedule {
            due: [NEVER; SLOTS.len()],
            next: NEVER,
        }
    }

    /// Calls this one at `cycle` instead of when it wanted before; [`NEVER`] takes it off.
    pub(crate) fn set(&mut self, slot: Slot, cycle: u64) {
        let place = &mut self.due[slot.place()];
        let before = std::mem::replace(place, cycle);
        if cycle <= self.next {
            self.next = cycle;
        } else if before == self.next {
            self.next = self.due.iter().copied().min().unwrap_or(NEVER);
        }
    }

    /// The nearest cycle.
    pub(crate) fn next(&self) -> u64 {
        self.next
    }

    /// Takes off and returns the earliest call that is due at `cycle`, with the cycle it is for. Calls for the same
    /// cycle come in the order of [`Slot`]: levels on pins first, so that a peripheral sees them.
    pub(crate) fn take_due(&mut self, cycle: u64) -> Option<(Slot, u64)> {
        if self.next > cycle {
            return None;
        }
        let place = self.due.iter().position(|&due| due == self.next)?;
        let due = self.next;
        self.set(SLOTS[place], NEVER);
        Some((SLOTS[place], due))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slot_has_its_own_place() {
        for (place, slot) in SLOTS.into_iter().enumerate() {
            assert_eq!(slot.place(), place);
        }
    }

    #[test]
    fn calls_come_in_order_and_once() {
        let mut schedule = Schedule::new();
        schedule.set(Slot::Analog, 20);
        schedule.set(Slot::Timer(2), 10);
        schedule.set(Slot::Input, 20);
        schedule.set(Slot::Timer(2), 30);
        assert_eq!(schedule.next(), 20);
        assert_eq!(schedule.take_due(19), None);
        assert_eq!(schedule.take_due(25), Some((Slot::Input, 20)));
        assert_eq!(schedule.take_due(25), Some((Slot::Analog, 20)));
        assert_eq!(schedule.take_due(25), None);
        assert_eq!(schedule.next(), 30);
    }
}
