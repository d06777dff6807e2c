//! Offset of the current measurement: two dividers that differ by 1 % show half an ampere where none flows. Off the dock no
//! current can flow, so the offset is learned there. It is proportional to the pack's voltage.

use super::meter::Averages;

/// A larger offset is a broken sensor, in mA.
const OFFSET_MAX_MA: i32 = 400;
/// Weight of a new second is one in this many.
const SMOOTHING: i32 = 32;
/// Kept in parts of a milliampere.
const FINE: i32 = 16;

/// The learned offset.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CurrentOffset {
    offset: i32,
    at_mv: i32,
    seconds: i32,
    broken: bool,
}

impl CurrentOffset {
    /// Takes the averages of a second in which no current could flow.
    pub(super) fn learn(&mut self, averages: &Averages) {
        self.broken = averages.current_ma.saturating_abs() > OFFSET_MAX_MA;
        if self.broken {
            return;
        }
        let fine = averages.current_ma.saturating_mul(FINE);
        // The plain mean of the first seconds, then an exponential moving average.
        self.seconds = self.seconds.saturating_add(1).min(SMOOTHING);
        let change = fine.saturating_sub(self.offset) / self.seconds.max(1);
        self.offset = self.offset.saturating_add(change);
        self.at_mv = averages.pack_mv;
    }

    /// The averages with the offset subtracted.
    #[inline(never)]
    pub(super) fn correct(&self, averages: Averages) -> Averages {
        let scaled = if self.at_mv > 0 {
            let product = i64::from(self.offset).saturating_mul(i64::from(averages.pack_mv));
            i32::try_from(product / i64::from(self.at_mv.max(1))).unwrap_or(0)
        } else {
            0
        };
        Averages {
            current_ma: averages.current_ma.saturating_sub(scaled / FINE),
            ..averages
        }
    }

    /// Whether the offset is larger than the dividers can explain.
    pub(super) const fn is_broken(&self) -> bool {
        self.broken
    }
}
