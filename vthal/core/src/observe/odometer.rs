//! Encoder counts to way, across wraps and resets.

/// Adds up differences of wrapping totals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct WrappingTotal {
    last: Option<i32>,
    sum: i64,
}

impl WrappingTotal {
    fn take(&mut self, total: i32) -> i64 {
        if let Some(last) = self.last {
            self.sum += i64::from(total.wrapping_sub(last));
        }
        self.last = Some(total);
        self.sum
    }
}

/// Raw totals of the firmware at one moment: encoder counts and gyro heading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RawTotals {
    /// Left encoder, counts.
    pub count_left: i32,
    /// Right encoder, counts.
    pub count_right: i32,
    /// Gyro heading in microradians, if there is a gyro.
    pub heading_urad: Option<i32>,
}

/// Way and heading since the device was attached.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// Left rim in metres.
    pub left_m: f64,
    /// Right rim in metres.
    pub right_m: f64,
    /// Gyro heading in radians.
    pub heading_rad: Option<f64>,
}

/// Turns raw totals into way. Right as long as no encoder makes 2^31 counts between two reports.
#[derive(Clone, Copy, Debug, Default)]
pub struct Odometer {
    left: WrappingTotal,
    right: WrappingTotal,
    heading: WrappingTotal,
}

impl Odometer {
    /// Takes the totals of a report; `count_m` is the way of the rim per count.
    pub fn take(&mut self, raw: RawTotals, count_m: f64) -> Travel {
        Travel {
            left_m: self.left.take(raw.count_left) as f64 * count_m,
            right_m: self.right.take(raw.count_right) as f64 * count_m,
            heading_rad: raw
                .heading_urad
                .map(|heading| self.heading.take(heading) as f64 * 1e-6),
        }
    }

    /// The wheels' totals begin anew at a value that says nothing about the past: the microcontroller was reset. The way
    /// made so far stays.
    pub fn rebase_wheels(&mut self) {
        self.left.last = None;
        self.right.last = None;
    }

    /// As [`Self::rebase_wheels`], for the heading.
    pub fn rebase_heading(&mut self) {
        self.heading.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::{Odometer, RawTotals};

    const COUNT_M: f64 = 0.001;

    fn raw(count_left: i32, count_right: i32) -> RawTotals {
        RawTotals {
            count_left,
            count_right,
            heading_urad: None,
        }
    }

    #[test]
    fn the_first_report_is_the_origin() {
        let travel = Odometer::default().take(raw(123_456, -5), COUNT_M);
        assert_eq!((travel.left_m, travel.right_m), (0.0, 0.0));
    }

    #[test]
    fn wraps_in_both_directions_are_ways_not_jumps() {
        let mut odometer = Odometer::default();
        odometer.take(raw(i32::MAX - 1, i32::MIN + 1), COUNT_M);
        let travel = odometer.take(raw(i32::MIN + 1, i32::MAX - 1), COUNT_M);
        assert_eq!((travel.left_m, travel.right_m), (0.003, -0.003));
    }

    #[test]
    fn a_reset_keeps_the_way_made_so_far() {
        let mut odometer = Odometer::default();
        odometer.take(raw(0, 0), COUNT_M);
        odometer.take(raw(500, 400), COUNT_M);
        odometer.rebase_wheels();
        let travel = odometer.take(raw(3, 0), COUNT_M);
        assert_eq!((travel.left_m, travel.right_m), (0.5, 0.4));
        assert_eq!(odometer.take(raw(13, 0), COUNT_M).left_m, 0.51);
    }

    #[test]
    fn the_heading_unwraps_through_the_whole_range() {
        let mut odometer = Odometer::default();
        let at = |heading| RawTotals {
            heading_urad: Some(heading),
            ..RawTotals::default()
        };
        odometer.take(at(i32::MAX), COUNT_M);
        let travel = odometer.take(at(i32::MIN + 999_999), COUNT_M);
        assert_eq!(travel.heading_rad, Some(1.0));
    }
}
