//! Conditions for feeding the watchdog (S5).
//!
//! cordlib feeds it when its own stages have run. Two more conditions are known to the board only: the interrupt that
//! counts milliseconds and the ADC must run. If either stops, the watchdog is not fed and resets the chip after 128 ms.

/// Counters at the last feeding.
#[derive(Clone, Copy, Debug, Default)]
pub struct SignsOfLife {
    ticks: u32,
    scans: u32,
}

impl SignsOfLife {
    /// Whether both have advanced since this last returned true. `ticks` and `scans` count interrupts, wrapping.
    pub const fn are_complete(&mut self, ticks: u32, scans: u32) -> bool {
        let complete = ticks != self.ticks && scans != self.scans;
        if complete {
            self.ticks = ticks;
            self.scans = scans;
        }
        complete
    }
}

#[cfg(test)]
mod tests {
    use super::SignsOfLife;

    #[test]
    fn both_must_go_on() {
        let mut life = SignsOfLife::default();
        assert!(life.are_complete(1, 1));
        for scans in 2..100 {
            assert!(!life.are_complete(1, scans), "the clock stands still");
        }
        assert!(life.are_complete(2, 100));
        for ticks in 3..100 {
            assert!(!life.are_complete(ticks, 100), "the converter stands still");
        }
        assert!(life.are_complete(100, 101));
    }
}
