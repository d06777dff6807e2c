//! Who must have shown a sign of life before the watchdog is fed (S5).
//!
//! cordlib asks for feeding when its own stages have run. Here the two that only the board can see join in: the interrupt that
//! counts milliseconds, and the converter. If either stands still the watchdog is not fed, and bites after 128 ms.

/// What was seen at the last feeding.
#[derive(Clone, Copy, Debug, Default)]
pub struct SignsOfLife {
    ticks: u32,
    scans: u32,
}

impl SignsOfLife {
    /// Whether both went on since this last said yes. `ticks` and `scans` count interrupts, wrapping.
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
