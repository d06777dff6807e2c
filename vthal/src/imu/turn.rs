//! Integrates turn rates to the angle turned.

/// A pause between two samples after which the turn is unknown, ns.
const GAP_NS: i64 = 100_000_000;

/// Adds up a rate over time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turn {
    total_rad: f64,
    last: Option<(i64, f64)>,
}

impl Turn {
    /// Takes a sample of the rate and gives the total in microradians, wrapping as the wire's headings do. The rate between
    /// two samples is taken as a straight line. Over a gap nothing is added; samples that go back in time are dropped.
    pub(super) fn take(&mut self, time_ns: i64, rate_rad_per_s: f64) -> i32 {
        if let Some((last_ns, last_rate)) = self.last {
            let elapsed_ns = time_ns - last_ns;
            if (1..=GAP_NS).contains(&elapsed_ns) {
                self.total_rad += (last_rate + rate_rad_per_s) / 2.0 * elapsed_ns as f64 * 1e-9;
            }
        }
        self.last = Some((time_ns, rate_rad_per_s));
        // The cast to 64 bits saturates after 290,000 turns of the earth; the one to 32 bits is the wrap.
        (self.total_rad * 1e6).round() as i64 as i32
    }

    /// The sensor was away: the total stays, what was turned meanwhile is not known.
    pub(super) fn interrupt(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::Turn;

    const MS: i64 = 1_000_000;

    #[test]
    fn a_rate_becomes_a_turn() {
        let mut turn = Turn::default();
        assert_eq!(turn.take(5 * MS, 1.0), 0);
        assert_eq!(turn.take(15 * MS, 1.0), 10_000);
        assert_eq!(turn.take(25 * MS, 3.0), 30_000);
    }

    #[test]
    fn gaps_and_steps_back_add_nothing() {
        let mut turn = Turn::default();
        turn.take(0, 1.0);
        turn.take(10 * MS, 1.0);
        assert_eq!(turn.take(200 * MS, 1.0), 10_000, "too long");
        assert_eq!(turn.take(190 * MS, 1.0), 10_000, "backwards");
        assert_eq!(turn.take(200 * MS, 1.0), 20_000);
        turn.interrupt();
        assert_eq!(turn.take(205 * MS, 1.0), 20_000, "it was away");
    }

    #[test]
    fn the_total_wraps_as_the_wire_does() {
        let mut turn = Turn::default();
        let mut last = 0_i32;
        let mut sum = 0_i64;
        for step in 0..60_000_i64 {
            let now = turn.take(step * 100 * MS, 1.0);
            sum += i64::from(now.wrapping_sub(last));
            last = now;
        }
        assert!((sum - 5_999_900_000).abs() < 10, "{sum}");
    }
}
