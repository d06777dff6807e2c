//! What ends a charge: eight stops, each of which must suffice alone.

use heapless::Deque;
use rvac_protocol::message::ChargeEnd;

use crate::limit::within;

use super::meter::Means;
use super::scale::PackScale;

/// Which stops apply. The firmware uses [`AllStops`]; the campaign that shows that each one suffices alone uses its own.
pub trait Stops {
    /// Whether this end may end a charge.
    fn applies(&self, end: ChargeEnd) -> bool;
}

/// All stops apply.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AllStops;

impl Stops for AllStops {
    fn applies(&self, _: ChargeEnd) -> bool {
        true
    }
}

/// Temperature rise over three minutes that ends a charge at the full current: 0.8 degrees a minute, the lower end of what
/// makers advise, since half the capacity an hour heats a pack slowly. A weaker supply heats it less: the limit falls with
/// the current, to half a degree a minute.
const SLOPE_CC: i32 = 240;
const SLOPE_LEAST_CC: i32 = 150;
/// Windows of 10 s in three minutes.
const SLOPE_WINDOWS: usize = 18;
/// The slope means nothing in the first minutes.
const SLOPE_HOLD_OFF_MS: u32 = 3 * 60_000;
/// After storage or deep discharge the voltage may fall without meaning.
const DROP_HOLD_OFF_MS: u32 = 10 * 60_000;
/// The drop must last for this many windows of 10 s.
const DROP_WINDOWS: u8 = 6;
/// A voltage means something else when the current has changed by more than this: the pack's resistance moves it.
const SAME_CURRENT_MA: i32 = 80;
const PLATEAU_WINDOWS: u16 = 20 * 6;
const PLATEAU_HOLD_OFF_MS: u32 = 90 * 60_000;
const RISE_CC: i32 = 1_500;
/// No charge goes on in a pack that is this hot.
pub(super) const HOT_CC: i32 = 5_000;
/// No charge lasts longer, precharge and top-off included.
pub(super) const TIME_MS: u32 = 3 * 3_600_000 + 1_800_000;
/// Weight of a new 10 s mean in the smoothed voltage is one in this many.
const SMOOTHING: i32 = 4;
/// The smoothed voltage is kept in parts of a millivolt.
const FINE: i32 = 16;

/// A charge as far as the stops look at it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// Time since the current began to flow at this rate, in ms.
    pub(super) phase_ms: u32,
    /// Time in which current was wanted, in the whole charge, in ms.
    pub(super) flowed_ms: u32,
    /// Charge that went in, in mA s.
    pub(super) charged_mas: u32,
    /// Temperature when the charge began.
    pub(super) start_cc: i32,
    /// The full current flows, so that slopes of voltage mean something.
    pub(super) full_rate: bool,
    pub(super) scale: PackScale,
}

/// The stops that need a memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Detectors {
    temperatures_cc: Deque<i32, { SLOPE_WINDOWS + 1 }>,
    smooth: Option<i32>,
    peak: i32,
    peak_current_ma: i32,
    drop_windows: u8,
    plateau_from: i32,
    plateau_windows: u16,
}

impl Detectors {
    /// The current starts anew: what was seen before means nothing.
    pub(super) fn restart(&mut self) {
        *self = Self::default();
    }

    /// The stops that look once a second. `end` asks whether a stop applies.
    pub(super) fn each_second(means: &Means, progress: &Progress, stops: &impl Stops) -> Option<ChargeEnd> {
        let temperature_cc = means.temperature_cc;
        let at_least = |limit_cc: i32| temperature_cc.is_some_and(|cc| cc >= limit_cc);
        let found = [
            (ChargeEnd::Hot, at_least(HOT_CC)),
            (
                ChargeEnd::Rise,
                at_least(progress.start_cc.saturating_add(RISE_CC)),
            ),
            (
                ChargeEnd::Voltage,
                means.pack_mv >= progress.scale.voltage_max_mv(),
            ),
            (
                ChargeEnd::Charge,
                progress.charged_mas >= progress.scale.charge_max_mas(),
            ),
            (ChargeEnd::Time, progress.flowed_ms >= TIME_MS),
        ];
        found
            .into_iter()
            .find_map(|(end, is_found)| (is_found && stops.applies(end)).then_some(end))
    }

    /// The stops that look at slopes, once in 10 s. `means` has the zero of the current taken off.
    pub(super) fn each_ten_seconds(
        &mut self,
        means: &Means,
        progress: &Progress,
        stops: &impl Stops,
    ) -> Option<ChargeEnd> {
        let slope = self.sees_slope(means, progress);
        self.smooth_voltage(means);
        let drop = self.sees_drop(means.current_ma, progress);
        let plateau = self.sees_plateau(progress);
        let found = [
            (ChargeEnd::Slope, slope),
            (ChargeEnd::Drop, drop),
            (ChargeEnd::Plateau, plateau),
        ];
        found
            .into_iter()
            .find_map(|(end, is_found)| (is_found && stops.applies(end)).then_some(end))
    }

    fn sees_slope(&mut self, means: &Means, progress: &Progress) -> bool {
        let Some(newest_cc) = means.temperature_cc else {
            self.temperatures_cc.clear();
            return false;
        };
        if self.temperatures_cc.is_full() {
            self.temperatures_cc.pop_front();
        }
        // There is room: the oldest has just left.
        self.temperatures_cc.push_back(newest_cc).ok();
        let spans_three_minutes = self.temperatures_cc.is_full();
        let limit_cc = within(
            means.current_ma.saturating_mul(SLOPE_CC) / progress.scale.full_ma().max(1),
            SLOPE_LEAST_CC,
            SLOPE_CC,
        );
        let oldest_cc = self.temperatures_cc.front().copied().unwrap_or(newest_cc);
        spans_three_minutes
            && progress.phase_ms >= SLOPE_HOLD_OFF_MS
            && newest_cc.saturating_sub(oldest_cc) >= limit_cc
    }

    fn smooth_voltage(&mut self, means: &Means) {
        let newest = means.pack_mv.saturating_mul(FINE);
        let smooth = self.smooth.map_or(newest, |smooth| {
            smooth.saturating_add(newest.saturating_sub(smooth) / SMOOTHING)
        });
        self.smooth = Some(smooth);
    }

    fn sees_drop(&mut self, current_ma: i32, progress: &Progress) -> bool {
        let smooth = self.smooth.unwrap_or(0);
        let changed = current_ma.saturating_sub(self.peak_current_ma).saturating_abs() > SAME_CURRENT_MA;
        if smooth > self.peak || changed || progress.phase_ms < DROP_HOLD_OFF_MS {
            self.peak = smooth;
            self.peak_current_ma = current_ma;
            self.drop_windows = 0;
            return false;
        }
        let below = self.peak.saturating_sub(smooth) >= progress.scale.drop_mv().saturating_mul(FINE);
        self.drop_windows = if below {
            self.drop_windows.saturating_add(1)
        } else {
            0
        };
        self.drop_windows >= DROP_WINDOWS
    }

    /// Where a tenth of the current flows the voltage is flat all the time.
    fn sees_plateau(&mut self, progress: &Progress) -> bool {
        let smooth = self.smooth.unwrap_or(0);
        let rise = smooth.saturating_sub(self.plateau_from);
        if rise >= progress.scale.plateau_mv().saturating_mul(FINE) || !progress.full_rate {
            self.plateau_from = smooth;
            self.plateau_windows = 0;
            return false;
        }
        self.plateau_windows = self.plateau_windows.saturating_add(1);
        self.plateau_windows >= PLATEAU_WINDOWS && progress.flowed_ms >= PLATEAU_HOLD_OFF_MS
    }
}
