//! The zero of the current: two dividers that differ by a hundredth show half an ampere where none flows. Off the dock
//! none can flow, so there the zero is learned; it is a share of the pack's voltage.

use super::meter::Means;

/// A larger zero is a broken sensor, in mA.
const ZERO_MAX_MA: i32 = 400;
/// Weight of a new second is one in this many.
const SMOOTHING: i32 = 32;
/// Kept in parts of a milliampere.
const FINE: i32 = 16;

/// The zero.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Zero {
    offset: i32,
    at_mv: i32,
    seconds: i32,
    broken: bool,
}

impl Zero {
    /// A second in which no current could flow is over.
    pub(super) fn learn(&mut self, means: &Means) {
        self.broken = means.current_ma.saturating_abs() > ZERO_MAX_MA;
        if self.broken {
            return;
        }
        let fine = means.current_ma.saturating_mul(FINE);
        // The plain mean of the first seconds, then a running one.
        self.seconds = self.seconds.saturating_add(1).min(SMOOTHING);
        let change = fine.saturating_sub(self.offset) / self.seconds.max(1);
        self.offset = self.offset.saturating_add(change);
        self.at_mv = means.pack_mv;
    }

    /// The averages with the zero taken off.
    pub(super) fn correct(&self, means: Means) -> Means {
        let scaled = if self.at_mv > 0 {
            let product = i64::from(self.offset).saturating_mul(i64::from(means.pack_mv));
            i32::try_from(product / i64::from(self.at_mv.max(1))).unwrap_or(0)
        } else {
            0
        };
        Means {
            current_ma: means.current_ma.saturating_sub(scaled / FINE),
            ..means
        }
    }

    /// Whether the sensor shows more than any divider could.
    pub(super) const fn is_broken(&self) -> bool {
        self.broken
    }
}
