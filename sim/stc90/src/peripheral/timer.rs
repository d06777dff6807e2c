//! One of the timers 0 and 1: a counter of 8, 13 or 16 bits.

/// A timer's way to count, as TMOD names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// 13 bits: TL holds five of them.
    Bits13,
    /// 16 bits.
    Bits16,
    /// 8 bits in TL, which TH refills.
    Refilled,
    /// Timer 0 becomes two counters of 8 bits; timer 1 stops.
    Split,
}

impl Mode {
    fn of(bits: u8) -> Self {
        match bits & 3 {
            0 => Self::Bits13,
            1 => Self::Bits16,
            2 => Self::Refilled,
            _ => Self::Split,
        }
    }
}

/// TMOD, one half: the pin of the external interrupt lets it count.
const GATE: u8 = 0x08;
/// TMOD, one half: counts falling edges of its pin instead of cycles.
const EXTERNAL: u8 = 0x04;

/// A timer without its start bit and its flag, which are in TCON.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Timer {
    pub(super) low: u8,
    pub(super) high: u8,
    control: u8,
    /// The external interrupt's pin is high.
    pub(super) gate_is_open: bool,
}

impl Timer {
    pub(super) fn new() -> Self {
        Self {
            low: 0,
            high: 0,
            control: 0,
            gate_is_open: true,
        }
    }

    /// Takes its half of TMOD.
    pub(super) fn configure(&mut self, control: u8) {
        self.control = control & 0x0F;
    }

    /// Its half of TMOD.
    pub(super) fn control(&self) -> u8 {
        self.control
    }

    pub(super) fn mode(&self) -> Mode {
        Mode::of(self.control)
    }

    /// Whether its gate lets it count.
    pub(super) fn is_let(&self) -> bool {
        self.control & GATE == 0 || self.gate_is_open
    }

    /// Whether it counts edges of its pin.
    pub(super) fn is_external(&self) -> bool {
        self.control & EXTERNAL != 0
    }

    /// Counts of a whole round.
    fn round(&self) -> u64 {
        match self.mode() {
            Mode::Bits13 => 0x2000,
            Mode::Bits16 => 0x1_0000,
            Mode::Refilled => 0x100 - u64::from(self.high),
            Mode::Split => 0x100,
        }
    }

    /// Counts until the next overflow, 1 at least. In split mode that of TL.
    pub(super) fn left(&self) -> u64 {
        match self.mode() {
            Mode::Bits13 => 0x2000 - (u64::from(self.high) << 5 | u64::from(self.low & 0x1F)),
            Mode::Bits16 => 0x1_0000 - u64::from(u16::from_le_bytes([self.low, self.high])),
            Mode::Refilled | Mode::Split => 0x100 - u64::from(self.low),
        }
    }

    /// Counts; says whether it overflowed.
    pub(super) fn count(&mut self, counts: u64) -> bool {
        let left = self.left();
        if counts < left {
            self.set(self.value() + counts);
            return false;
        }
        let bottom = match self.mode() {
            Mode::Refilled => u64::from(self.high),
            Mode::Bits13 | Mode::Bits16 | Mode::Split => 0,
        };
        self.set(bottom + (counts - left) % self.round());
        true
    }

    fn value(&self) -> u64 {
        match self.mode() {
            Mode::Bits13 => u64::from(self.high) << 5 | u64::from(self.low & 0x1F),
            Mode::Bits16 => u64::from(u16::from_le_bytes([self.low, self.high])),
            Mode::Refilled | Mode::Split => u64::from(self.low),
        }
    }

    fn set(&mut self, value: u64) {
        match self.mode() {
            Mode::Bits13 => {
                // The upper three bits of TL mean nothing. As in uCsim they stay until the other five roll over.
                let rolls = value < self.value() || (value >> 5) as u8 != self.high;
                let rest = if rolls { 0 } else { self.low & 0xE0 };
                (self.low, self.high) = (rest | value as u8 & 0x1F, (value >> 5) as u8);
            }
            Mode::Bits16 => [self.low, self.high] = (value as u16).to_le_bytes(),
            Mode::Refilled | Mode::Split => self.low = value as u8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Timer;

    fn timer(control: u8, low: u8, high: u8) -> Timer {
        Timer {
            low,
            high,
            control,
            gate_is_open: true,
        }
    }

    /// Counting many at once is counting one by one.
    #[test]
    fn a_jump_ends_where_single_counts_do() {
        for mode in 0..4 {
            for (low, high) in [(0, 0), (0xFE, 0xFF), (0x1F, 0xFF), (5, 0xF0), (0xFF, 0)] {
                let mut single = timer(mode, low, high);
                let mut overflowed = false;
                for counts in 1..700 {
                    overflowed |= single.count(1);
                    let mut jumped = timer(mode, low, high);
                    assert_eq!(jumped.count(counts), overflowed, "mode {mode}, {counts}");
                    assert_eq!(jumped, single, "mode {mode}, {counts}");
                }
            }
        }
    }

    #[test]
    fn it_overflows_when_nothing_is_left() {
        for (control, low, high, left) in [
            (0, 0x1E, 0xFF, 2),
            (1, 0x78, 0xEC, 5000),
            (2, 0xFC, 0x10, 4),
            (3, 0xFF, 0x10, 1),
        ] {
            assert_eq!(timer(control, low, high).left(), left);
            assert!(!timer(control, low, high).count(left - 1));
            assert!(timer(control, low, high).count(left));
        }
    }
}
