//! What ends a charge: eight termination criteria, each of which must suffice alone.

use heapless::Deque;
use rvac_protocol::message::ChargeEnd;

use crate::limit::within;
use crate::rules::charge_stop::{
    HOT_CC, NEGATIVE_DELTA_V_HOLD_OFF_MS, NEGATIVE_DELTA_V_WINDOWS, SAME_CURRENT_MA, TEMPERATURE_RISE_CC,
    TEMPERATURE_SLOPE_CC, TEMPERATURE_SLOPE_HOLD_OFF_MS, TEMPERATURE_SLOPE_LEAST_CC,
    TEMPERATURE_SLOPE_WINDOWS, TIME_MS, ZERO_DELTA_V_HOLD_OFF_MS, ZERO_DELTA_V_WINDOWS,
};

use super::meter::Averages;
use super::scale::PackLimits;

/// Which stops apply. The firmware uses [`AllStops`]; the campaign that tests each one alone uses its own.
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

/// Weight of a new 10 s mean in the smoothed voltage is one in this many.
const SMOOTHING: i32 = 4;
/// The smoothed voltage is kept in 16ths of a millivolt.
const FINE: i32 = 16;

/// The state of a charge that the stops need.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChargeProgress {
    /// Time since the current began to flow at this rate, in ms.
    pub(super) phase_ms: u32,
    /// Time in which current was wanted, in the whole charge, in ms.
    pub(super) flowed_ms: u32,
    /// Charge that went in, in mA s.
    pub(super) charged_mas: u32,
    /// Temperature when the charge began, the most that it could be.
    pub(super) start_cc: i32,
    /// The full current flows, so that 0dV is meaningful.
    pub(super) full_rate: bool,
    pub(super) scale: PackLimits,
}

/// The stops that need a history.
#[derive(Clone, Debug, Default)]
pub(super) struct Detectors {
    temperatures_cc: Deque<i32, { TEMPERATURE_SLOPE_WINDOWS + 1 }>,
    smooth: Option<i32>,
    peak: i32,
    peak_current_ma: i32,
    negative_delta_v_windows: u8,
    zero_delta_v_from: i32,
    zero_delta_v_windows: u16,
}

impl Detectors {
    /// The current starts anew: the history is void.
    pub(super) fn restart(&mut self) {
        *self = Self::default();
    }

    /// The limits, checked once a second.
    pub(super) fn each_second(
        averages: &Averages,
        progress: &ChargeProgress,
        stops: &impl Stops,
    ) -> Option<ChargeEnd> {
        let warmest_cc = averages.warmest_cc();
        let at_least = |limit_cc: i32| warmest_cc.is_some_and(|cc| cc >= limit_cc);
        let found = [
            (ChargeEnd::Hot, at_least(HOT_CC)),
            (
                ChargeEnd::TemperatureRise,
                at_least(progress.start_cc.saturating_add(TEMPERATURE_RISE_CC)),
            ),
            (
                ChargeEnd::Voltage,
                averages.pack_mv >= progress.scale.voltage_max_mv(),
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

    /// dT/dt, -dV and 0dV, checked once in 10 s. `averages` has the current offset subtracted.
    pub(super) fn each_ten_seconds(
        &mut self,
        averages: &Averages,
        progress: &ChargeProgress,
        stops: &impl Stops,
    ) -> Option<ChargeEnd> {
        let temperature_slope = self.is_temperature_slope(averages, progress);
        self.smooth_voltage(averages);
        let negative_delta_v = self.is_negative_delta_v(averages.current_ma, progress);
        let zero_delta_v = self.is_zero_delta_v(progress);
        let found = [
            (ChargeEnd::TemperatureSlope, temperature_slope),
            (ChargeEnd::NegativeDeltaV, negative_delta_v),
            (ChargeEnd::ZeroDeltaV, zero_delta_v),
        ];
        found
            .into_iter()
            .find_map(|(end, is_found)| (is_found && stops.applies(end)).then_some(end))
    }

    fn is_temperature_slope(&mut self, averages: &Averages, progress: &ChargeProgress) -> bool {
        let Some(newest_cc) = averages.warmest_cc() else {
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
            averages.current_ma.saturating_mul(TEMPERATURE_SLOPE_CC) / progress.scale.full_ma().max(1),
            TEMPERATURE_SLOPE_LEAST_CC,
            TEMPERATURE_SLOPE_CC,
        );
        let oldest_cc = self.temperatures_cc.front().copied().unwrap_or(newest_cc);
        spans_three_minutes
            && progress.phase_ms >= TEMPERATURE_SLOPE_HOLD_OFF_MS
            && newest_cc.saturating_sub(oldest_cc) >= limit_cc
    }

    fn smooth_voltage(&mut self, averages: &Averages) {
        let newest = averages.pack_mv.saturating_mul(FINE);
        let smooth = self.smooth.map_or(newest, |smooth| {
            smooth.saturating_add(newest.saturating_sub(smooth) / SMOOTHING)
        });
        self.smooth = Some(smooth);
    }

    fn is_negative_delta_v(&mut self, current_ma: i32, progress: &ChargeProgress) -> bool {
        let smooth = self.smooth.unwrap_or(0);
        let changed = current_ma.saturating_sub(self.peak_current_ma).saturating_abs() > SAME_CURRENT_MA;
        if smooth > self.peak || changed || progress.phase_ms < NEGATIVE_DELTA_V_HOLD_OFF_MS {
            self.peak = smooth;
            self.peak_current_ma = current_ma;
            self.negative_delta_v_windows = 0;
            return false;
        }
        let below =
            self.peak.saturating_sub(smooth) >= progress.scale.negative_delta_v_mv().saturating_mul(FINE);
        self.negative_delta_v_windows = if below {
            self.negative_delta_v_windows.saturating_add(1)
        } else {
            0
        };
        self.negative_delta_v_windows >= NEGATIVE_DELTA_V_WINDOWS
    }

    /// Applies at full current only: at C/10 the voltage is flat all the time.
    fn is_zero_delta_v(&mut self, progress: &ChargeProgress) -> bool {
        let smooth = self.smooth.unwrap_or(0);
        let rise = smooth.saturating_sub(self.zero_delta_v_from);
        if rise >= progress.scale.zero_delta_v_mv().saturating_mul(FINE) || !progress.full_rate {
            self.zero_delta_v_from = smooth;
            self.zero_delta_v_windows = 0;
            return false;
        }
        self.zero_delta_v_windows = self.zero_delta_v_windows.saturating_add(1);
        self.zero_delta_v_windows >= ZERO_DELTA_V_WINDOWS && progress.flowed_ms >= ZERO_DELTA_V_HOLD_OFF_MS
    }
}
