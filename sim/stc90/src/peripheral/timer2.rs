//! Timer 2: 16 bits with reload or capture, up and down, and the UART's best source of a rate.

/// Ticks of a machine cycle: as rate of the UART it counts each second clock of twelve, or each of six.
pub const TICKS_PER_CYCLE: u64 = 6;

const TF2: u8 = 0x80;
const EXF2: u8 = 0x40;
const RCLK: u8 = 0x20;
const TCLK: u8 = 0x10;
const EXEN2: u8 = 0x08;
const TR2: u8 = 0x04;
const EXTERNAL: u8 = 0x02;
const CAPTURE: u8 = 0x01;

/// T2MOD: up and down.
const DCEN: u8 = 0x01;
/// T2MOD: the pin P1.0 puts out a clock.
pub(super) const T2OE: u8 = 0x02;
/// Counts of a whole round without reload.
const ROUND: u64 = 0x1_0000;

/// A way to count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    Rate,
    Capture,
    Reload,
    UpAndDown,
}

/// Timer 2 with its registers.
#[derive(Clone, Debug)]
pub(super) struct Timer2 {
    control: u8,
    mode: u8,
    pub(super) reload: [u8; 2],
    pub(super) count: [u8; 2],
    /// The pin T2EX is high.
    trigger_is_high: bool,
    cycle: u64,
}

impl Timer2 {
    pub(super) fn new(cycle: u64) -> Self {
        Self {
            control: 0,
            mode: 0,
            reload: [0; 2],
            count: [0; 2],
            trigger_is_high: true,
            cycle,
        }
    }

    fn used_for(&self) -> Use {
        if self.control & (RCLK | TCLK) != 0 {
            Use::Rate
        } else if self.control & CAPTURE != 0 {
            Use::Capture
        } else if self.mode & DCEN != 0 {
            Use::UpAndDown
        } else {
            Use::Reload
        }
    }

    fn counts_cycles(&self) -> bool {
        self.control & (TR2 | EXTERNAL) == TR2
    }

    fn counts_down(&self) -> bool {
        self.used_for() == Use::UpAndDown && !self.trigger_is_high
    }

    /// What an overflow leaves.
    fn bottom(&self) -> u64 {
        match self.used_for() {
            Use::Capture => 0,
            Use::Rate | Use::Reload | Use::UpAndDown => u64::from(u16::from_le_bytes(self.reload)),
        }
    }

    fn value(&self) -> u64 {
        u64::from(u16::from_le_bytes(self.count))
    }

    /// Counts until the next overflow.
    fn left(&self) -> u64 {
        if self.counts_down() {
            // Underflow comes one count after the value of the reload register.
            return (self.value().wrapping_sub(self.bottom()) & 0xFFFF) + 1;
        }
        ROUND - self.value()
    }

    /// Counts up to `cycle`.
    pub(super) fn advance(&mut self, cycle: u64) {
        let cycles = cycle.saturating_sub(self.cycle);
        self.cycle = self.cycle.max(cycle);
        if cycles != 0 && self.counts_cycles() {
            let is_rate = self.used_for() == Use::Rate;
            self.count_on(if is_rate { cycles * TICKS_PER_CYCLE } else { cycles });
        }
    }

    /// Time passes in which the chip has no clock.
    pub(super) fn skip_to(&mut self, cycle: u64) {
        self.cycle = cycle;
    }

    fn count_on(&mut self, counts: u64) {
        let left = self.left();
        let down = self.counts_down();
        if counts < left {
            let value = if down {
                self.value().wrapping_sub(counts)
            } else {
                self.value() + counts
            };
            self.count = (value as u16).to_le_bytes();
            return;
        }
        let round = ROUND - self.bottom();
        let past = (counts - left) % round;
        let overflows = 1 + (counts - left) / round;
        let value = if down { 0xFFFF - past } else { self.bottom() + past };
        self.count = (value as u16).to_le_bytes();
        match self.used_for() {
            Use::Rate => {}
            Use::Capture | Use::Reload => self.control |= TF2,
            Use::UpAndDown => {
                self.control |= TF2;
                // A seventeenth bit.
                self.control ^= if overflows & 1 != 0 { EXF2 } else { 0 };
            }
        }
    }

    /// A falling edge on the counting pin T2.
    pub(super) fn pulse(&mut self) {
        if self.control & (TR2 | EXTERNAL) == TR2 | EXTERNAL {
            self.count_on(1);
        }
    }

    /// The pin T2EX changes.
    pub(super) fn trigger(&mut self, is_high: bool) {
        let falls = self.trigger_is_high && !is_high;
        self.trigger_is_high = is_high;
        let kind = self.used_for();
        if !falls || self.control & EXEN2 == 0 || kind == Use::UpAndDown {
            return;
        }
        self.control |= EXF2;
        match kind {
            Use::Capture => self.reload = self.count,
            Use::Reload => self.count = self.reload,
            Use::Rate | Use::UpAndDown => {}
        }
    }

    /// The next overflow that sets the flag.
    pub(super) fn next(&self) -> u64 {
        let sets_flag = self.used_for() != Use::Rate && self.control & TF2 == 0;
        if sets_flag && self.counts_cycles() {
            self.cycle + self.left()
        } else {
            u64::MAX
        }
    }

    /// Whether it asks for an interrupt. As a seventeenth bit, EXF2 does not.
    pub(super) fn requests(&self) -> bool {
        let flags = if self.used_for() == Use::UpAndDown {
            TF2
        } else {
            TF2 | EXF2
        };
        self.control & flags != 0
    }

    /// T2CON.
    pub(super) fn control(&self) -> u8 {
        self.control
    }

    pub(super) fn set_control(&mut self, value: u8) {
        self.control = value;
    }

    /// T2MOD, whose unused bits read as zero.
    pub(super) fn mode(&self) -> u8 {
        self.mode
    }

    pub(super) fn set_mode(&mut self, value: u8) {
        self.mode = value & (DCEN | T2OE);
    }

    /// Ticks between two overflows, as the UART's transmitter uses them.
    pub(super) fn transmit_period(&self) -> Option<Option<u64>> {
        self.period_for(TCLK)
    }

    /// Ticks between two overflows, as the UART's receiver uses them.
    pub(super) fn receive_period(&self) -> Option<Option<u64>> {
        self.period_for(RCLK)
    }

    /// Nothing when timer 2 is not chosen; nothing inside when it is and stands still.
    fn period_for(&self, choice: u8) -> Option<Option<u64>> {
        if self.control & choice == 0 {
            return None;
        }
        let period = ROUND - u64::from(u16::from_le_bytes(self.reload));
        Some(self.counts_cycles().then_some(period))
    }
}

#[cfg(test)]
mod tests {
    use super::{CAPTURE, DCEN, EXEN2, EXF2, RCLK, TCLK, TF2, TR2, Timer2};

    fn timer(control: u8, count: u16, reload: u16) -> Timer2 {
        let mut timer = Timer2::new(0);
        timer.set_control(control);
        timer.count = count.to_le_bytes();
        timer.reload = reload.to_le_bytes();
        timer
    }

    fn value(timer: &Timer2) -> u16 {
        u16::from_le_bytes(timer.count)
    }

    #[test]
    fn it_reloads_and_flags() {
        let mut timer = timer(TR2, 0xFFFE, 0xFF00);
        assert_eq!(timer.next(), 2);
        timer.advance(1);
        assert!(!timer.requests());
        timer.advance(5);
        assert!(timer.requests());
        assert_eq!(value(&timer), 0xFF03);
        assert_eq!(timer.next(), u64::MAX);
    }

    #[test]
    fn as_rate_it_counts_six_times_a_cycle_and_never_flags() {
        let mut timer = timer(TR2 | RCLK | TCLK, 0xFFCF, 0xFFCF);
        timer.advance(8);
        assert_eq!(value(&timer), 0xFFFF);
        timer.advance(9);
        assert_eq!(value(&timer), 0xFFCF + 5);
        assert!(!timer.requests());
        assert_eq!(timer.transmit_period(), Some(Some(49)));
    }

    #[test]
    fn its_trigger_captures_or_reloads() {
        let mut capturing = timer(TR2 | EXEN2 | CAPTURE, 0x1234, 0);
        capturing.trigger(false);
        assert_eq!(capturing.reload, [0x34, 0x12]);
        let mut reloading = timer(TR2 | EXEN2, 0x1234, 0x8000);
        reloading.trigger(false);
        assert_eq!(value(&reloading), 0x8000);
        assert_eq!(reloading.control() & (EXF2 | TF2), EXF2);
        let mut deaf = timer(TR2, 0x1234, 0x8000);
        deaf.trigger(false);
        assert_eq!(value(&deaf), 0x1234);
    }

    #[test]
    fn it_counts_down_to_its_reload_value() {
        let mut timer = timer(TR2, 0x1002, 0x1000);
        timer.set_mode(DCEN);
        timer.trigger(false);
        assert_eq!(timer.next(), 3);
        timer.advance(2);
        assert_eq!(value(&timer), 0x1000);
        timer.advance(3);
        assert_eq!(value(&timer), 0xFFFF);
        assert_eq!(timer.control() & (EXF2 | TF2), EXF2 | TF2);
        timer.trigger(true);
        timer.advance(4);
        assert_eq!(value(&timer), 0x1000);
        assert_eq!(timer.control() & EXF2, 0);
    }
}
