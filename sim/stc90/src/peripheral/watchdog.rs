//! The watchdog: resets the chip when it is not fed.

const ENABLE: u8 = 0x20;
const CLEAR: u8 = 0x10;
const IN_IDLE: u8 = 0x08;
const PRESCALER: u8 = 0x07;

/// Cycles of the watchdog with the prescaler at one half of it.
const CYCLES: u64 = 32_768;

/// The watchdog. Once enabled it runs until a reset.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watchdog {
    control: u8,
    /// Cycles counted since it was fed, up to `since`.
    counted: u64,
    since: u64,
    is_stopped: bool,
}

impl Watchdog {
    /// After a reset; an option of the chip lets it run at once, with the longest time.
    pub(super) fn new(runs: bool, cycle: u64) -> Self {
        Self {
            control: if runs { ENABLE | PRESCALER } else { 0 },
            counted: 0,
            since: cycle,
            is_stopped: false,
        }
    }

    fn runs(&self) -> bool {
        self.control & ENABLE != 0 && !self.is_stopped
    }

    fn period(&self) -> u64 {
        CYCLES << ((self.control & PRESCALER) + 1)
    }

    fn advance(&mut self, cycle: u64) {
        if self.runs() {
            self.counted += cycle.saturating_sub(self.since);
        }
        self.since = cycle;
    }

    /// The cycle in which it resets the chip.
    pub(super) fn next(&self) -> u64 {
        if self.runs() {
            self.since + self.period().saturating_sub(self.counted)
        } else {
            u64::MAX
        }
    }

    /// WDT_CONTR. The bit that feeds reads as zero.
    pub(super) fn control(&self) -> u8 {
        self.control
    }

    pub(super) fn set_control(&mut self, value: u8, cycle: u64) {
        self.advance(cycle);
        let still_runs = self.control & ENABLE;
        self.control = value & (ENABLE | IN_IDLE | PRESCALER) | still_runs;
        if value & CLEAR != 0 || still_runs == 0 {
            self.counted = 0;
        }
    }

    /// The core goes to sleep, in which the watchdog counts only if told so.
    pub(super) fn idle(&mut self, cycle: u64) {
        self.advance(cycle);
        self.is_stopped = self.control & IN_IDLE == 0;
    }

    /// The chip has no clock any more.
    pub(super) fn stop(&mut self, cycle: u64) {
        self.advance(cycle);
        self.is_stopped = true;
    }

    /// The core goes on.
    pub(super) fn wake(&mut self, cycle: u64) {
        self.advance(cycle);
        self.is_stopped = false;
    }
}

#[cfg(test)]
mod tests {
    use super::{CLEAR, ENABLE, IN_IDLE, Watchdog};

    #[test]
    fn its_time_doubles_with_each_step_of_the_prescaler() {
        for (prescaler, cycles) in [(0, 65_536), (1, 131_072), (7, 8_388_608)] {
            let mut watchdog = Watchdog::new(false, 0);
            assert_eq!(watchdog.next(), u64::MAX);
            watchdog.set_control(ENABLE | CLEAR | prescaler, 100);
            assert_eq!(watchdog.next(), 100 + cycles);
        }
    }

    #[test]
    fn it_can_be_fed_and_not_stopped() {
        let mut watchdog = Watchdog::new(false, 0);
        watchdog.set_control(ENABLE, 0);
        watchdog.set_control(0, 10);
        assert_eq!(watchdog.next(), 65_536);
        watchdog.set_control(CLEAR, 20);
        assert_eq!(watchdog.next(), 65_556);
        assert_eq!(watchdog.control(), ENABLE);
    }

    #[test]
    fn it_sleeps_with_the_core_unless_told_otherwise() {
        let mut watchdog = Watchdog::new(false, 0);
        watchdog.set_control(ENABLE, 0);
        watchdog.idle(100);
        assert_eq!(watchdog.next(), u64::MAX);
        watchdog.wake(1000);
        assert_eq!(watchdog.next(), 65_536 + 900);
        watchdog.set_control(ENABLE | CLEAR | IN_IDLE, 2000);
        watchdog.idle(2000);
        assert_eq!(watchdog.next(), 2000 + 65_536);
    }
}
