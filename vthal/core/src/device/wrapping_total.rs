//! Totals that wrap, and start again when the robot restarts.

/// Adds up differences of wrapping totals. Right as long as no total makes 2^31 between two reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct WrappingTotal {
    last: Option<i32>,
    sum: i64,
}

impl WrappingTotal {
    /// Takes a total and gives the sum since the first one.
    pub(crate) fn take(&mut self, total: i32) -> i64 {
        if let Some(last) = self.last {
            self.sum = self.sum.saturating_add(i64::from(total.wrapping_sub(last)));
        }
        self.last = Some(total);
        self.sum
    }

    /// The next total says nothing about the past. The sum so far stays.
    pub(crate) const fn rebase(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::WrappingTotal;

    #[test]
    fn the_first_total_is_the_origin() {
        assert_eq!(WrappingTotal::default().take(123_456), 0);
    }

    #[test]
    fn wraps_in_both_directions_are_ways_not_jumps() {
        let mut up = WrappingTotal::default();
        up.take(i32::MAX - 1);
        assert_eq!(up.take(i32::MIN + 1), 3);
        let mut down = WrappingTotal::default();
        down.take(i32::MIN + 1);
        assert_eq!(down.take(i32::MAX - 1), -3);
    }

    #[test]
    fn a_reset_keeps_what_came_before() {
        let mut total = WrappingTotal::default();
        total.take(0);
        total.take(500);
        total.rebase();
        assert_eq!(total.take(3), 500);
        assert_eq!(total.take(13), 510);
    }
}
