//! The state machine of a charge.

use rvac_protocol::message::{ChargeEnd, ChargeFault, ChargePhase};

use super::cold_rate::ColdRate;
use super::controller::{ChargeContext, ChargeController};
use super::meter::{Averages, AveragingWindow, CompletedWindows};
use super::scale::PackLimits;
use super::stops::{ChargeProgress, Detectors, Stops};
use crate::rules::charge_fault::OFFSET_FAULT_MA;
use crate::rules::charge_guard::REST_MS;
use crate::rules::charge_phase::{
    DOCKED_MS, LONG_REST_MS, PRECHARGE_MS, TOP_OFF_MAX_CC, TOP_OFF_MS, UNDOCKED_MS, WARMEST_CC,
};
use crate::rules::charge_stop::TIME_MS;

/// A charge that was interrupted for longer is over, and its counts are reset.
const AWAY_MS: u32 = REST_MS;
/// An interruption of the current that restarts the detectors.
const PAUSE_MS: u32 = 10_000;
/// A full pack is not charged again before this time, which doubles whenever the pack turns out to be still full.
const RECHARGE_MS: u32 = 2 * 3_600_000;
const RECHARGE_MAX_MS: u32 = 16 * 3_600_000;
/// Pause between two pulses of `maintain`, and their longest length.
const PULSE_PERIOD_MS: u32 = 120_000;
const PULSE_MAX_MS: u32 = 20_000;
/// After this time without a pulse the pack shows its resting voltage.
const PULSE_REST_MS: u32 = 100_000;

/// Counts of one charge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ChargeRecord {
    /// Time in which current was wanted and could flow.
    flowed_ms: u32,
    charged_mas: u32,
    start_cc: Option<i32>,
    /// Time in this phase, interruptions not counted.
    phase_ms: u32,
    /// Time of `precharge` in this charge. An interruption does not restart it.
    precharge_ms: u32,
    /// Time without current.
    paused_ms: u32,
    rate: ColdRate,
    flowing: bool,
}

/// The temperature of a charge that has not begun, in the kept record.
const NOT_BEGUN: u32 = i32::MIN as u32;

impl ChargeRecord {
    /// Words in the kept record.
    pub(super) const WORDS: usize = 5;

    /// For the kept record.
    pub(super) fn words(&self) -> [u32; Self::WORDS] {
        [
            self.flowed_ms,
            self.charged_mas,
            self.start_cc.map_or(NOT_BEGUN, i32::cast_unsigned),
            self.paused_ms,
            self.precharge_ms,
        ]
    }

    /// From the kept record: a charge that is interrupted.
    pub(super) fn from_words(
        [flowed_ms, charged_mas, start_cc, paused_ms, precharge_ms]: [u32; Self::WORDS],
    ) -> Self {
        Self {
            flowed_ms,
            charged_mas,
            start_cc: (start_cc != NOT_BEGUN).then_some(start_cc.cast_signed()),
            paused_ms,
            precharge_ms,
            ..Self::default()
        }
    }

    /// Full current flowed for so long and was not counted.
    pub(super) const fn note_flow(&mut self, ms: u32, full_ma: u32) {
        self.flowed_ms = self.flowed_ms.saturating_add(ms);
        self.precharge_ms = self.precharge_ms.saturating_add(ms);
        self.charged_mas = self
            .charged_mas
            .saturating_add((ms / 1_000).saturating_mul(full_ma));
    }

    pub(super) const fn pass(&mut self, charging: bool, elapsed_ms: u32) {
        self.paused_ms = self.paused_ms.saturating_add(elapsed_ms);
        if !charging && self.paused_ms >= AWAY_MS {
            self.start_cc = None;
        }
    }

    /// The same charge after a reset.
    pub(super) const fn interrupted(self) -> Self {
        Self {
            flowing: false,
            phase_ms: 0,
            ..self
        }
    }

    /// Whether a charge is under way or interrupted for a short time.
    pub(super) const fn has_begun(&self) -> bool {
        self.start_cc.is_some()
    }

    /// No current may flow now.
    pub(super) const fn pause(&mut self) {
        self.flowing = false;
    }

    /// Current is wanted, and everything is ready for it.
    pub(super) fn want(&mut self, phase: ChargePhase, elapsed_ms: u32) {
        self.flowed_ms = self.flowed_ms.saturating_add(elapsed_ms);
        self.phase_ms = self.phase_ms.saturating_add(elapsed_ms);
        if phase == ChargePhase::Precharge {
            self.precharge_ms = self.precharge_ms.saturating_add(elapsed_ms);
        }
    }

    /// The switch is driven.
    pub(super) const fn flow(&mut self) {
        self.flowing = true;
        self.paused_ms = 0;
    }

    pub(super) fn gather(&mut self, averages: &Averages) {
        let seconds_ms = i64::from(averages.elapsed_ms);
        let mas = i64::from(averages.current_ma.max(0)).saturating_mul(seconds_ms) / 1_000;
        self.charged_mas = self
            .charged_mas
            .saturating_add(u32::try_from(mas).unwrap_or(u32::MAX));
    }

    /// Resumes a charge that was interrupted for a short time, else begins a new one.
    fn begin(&mut self, temperature_cc: i32) {
        if self.start_cc.is_none() {
            *self = Self {
                start_cc: Some(temperature_cc),
                rate: self.rate,
                ..Self::default()
            };
        }
        self.phase_ms = 0;
        self.paused_ms = 0;
    }

    /// The charge is over: the next one starts from zero.
    pub(super) const fn finish(&mut self) {
        self.start_cc = None;
    }

    /// Whether the switch was driven in the last pass.
    pub(super) const fn flows(&self) -> bool {
        self.flowing
    }

    /// Whether current has flowed for less than `span_ms`.
    pub(super) const fn is_young(&self, span_ms: u32) -> bool {
        self.flowed_ms < span_ms
    }

    fn progress(&self, scale: PackLimits) -> ChargeProgress {
        ChargeProgress {
            phase_ms: self.phase_ms,
            flowed_ms: self.flowed_ms,
            charged_mas: self.charged_mas,
            start_cc: self.start_cc.unwrap_or(i32::MAX / 2),
            full_rate: self.rate == ColdRate::Full,
            scale,
        }
    }
}

/// Pulses of `maintain`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MaintenancePulse {
    on: bool,
    ms: u32,
    from_mas: u32,
    /// The pack cools down before the first one.
    cool_ms: u32,
}

/// When the next charge may begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rest {
    left_ms: u32,
    recharge_ms: u32,
    /// The host wants a charge now.
    wanted: bool,
    /// The host wants none.
    forbidden: bool,
}

impl Rest {
    /// Words in the kept record.
    pub(super) const WORDS: usize = 2;

    /// For the kept record.
    pub(super) const fn words(&self) -> [u32; Self::WORDS] {
        [self.left_ms, self.recharge_ms]
    }

    /// From the kept record.
    pub(super) const fn from_words([left_ms, recharge_ms]: [u32; Self::WORDS]) -> Self {
        Self {
            left_ms,
            recharge_ms,
            wanted: false,
            forbidden: false,
        }
    }

    /// Whether the host wants no charge.
    pub(super) const fn is_forbidden(&self) -> bool {
        self.forbidden
    }

    /// The host wants no charge.
    pub(super) const fn forbid(&mut self) {
        self.forbidden = true;
    }

    pub(super) const fn pass(&mut self, elapsed_ms: u32) {
        self.left_ms = self.left_ms.saturating_sub(elapsed_ms);
    }

    pub(super) const fn wait(&mut self, ms: u32) {
        self.left_ms = ms;
    }
}

impl<S: Stops> ChargeController<S> {
    /// The host wants a full charge now, or none until it says otherwise or the robot docks anew.
    pub fn want(&mut self, wanted: bool) {
        self.rest.wanted = wanted;
        self.rest.forbidden = !wanted;
        if wanted {
            self.rest.wait(0);
        } else if self.is_charging() || self.phase == ChargePhase::Maintain {
            self.finish(ChargeEnd::Stopped);
        }
    }

    /// The full current flows, as far as the controller knows.
    pub(super) fn is_at_full_rate(&self) -> bool {
        self.phase == ChargePhase::Fast && self.charge.rate == ColdRate::Full && self.charge.flows()
    }

    /// The current that is wanted now, in mA; 0 = none.
    pub(super) fn target_ma(&self) -> i32 {
        match self.phase {
            _ if self.charge.rate == ColdRate::None => 0,
            ChargePhase::Precharge | ChargePhase::Fast | ChargePhase::TopOff
                if self.charge.rate == ColdRate::Slow =>
            {
                self.scale.cool_ma()
            }
            ChargePhase::Fast => self.scale.full_ma(),
            ChargePhase::Precharge | ChargePhase::TopOff => self.scale.slow_ma(),
            ChargePhase::Maintain if self.pulse.on => self.scale.slow_ma(),
            _ => 0,
        }
    }

    /// Advances the state machine by what was measured.
    pub(super) fn advance(&mut self, windows: &CompletedWindows, context: ChargeContext) {
        if !context.is_docked() {
            self.leave_dock();
            return;
        }
        if self.phase == ChargePhase::Fast && self.charge.paused_ms >= PAUSE_MS {
            self.detectors.restart();
            self.charge.phase_ms = 0;
        }
        if let Some(averages) = windows.of(AveragingWindow::Second) {
            let averages = self.current_offset.correct(averages);
            self.charge.rate = averages.temperature.map_or(ColdRate::None, |temperature| {
                self.charge.rate.at(temperature.coldest_cc)
            });
            match self.phase {
                ChargePhase::Idle => self.consider(&averages),
                ChargePhase::Precharge => self.precharge(&averages),
                ChargePhase::Fast => self.fast(&averages),
                ChargePhase::TopOff => self.top_off(&averages),
                ChargePhase::Maintain => self.maintain(&averages),
                ChargePhase::Fault => {}
            }
        }
        if let (Some(averages), ChargePhase::Fast) = (windows.of(AveragingWindow::TenSeconds), self.phase) {
            let averages = self.current_offset.correct(averages);
            let progress = self.charge.progress(self.scale);
            let found = self.detectors.each_ten_seconds(&averages, &progress, &self.stops);
            if let Some(end) = found {
                self.finish(end);
            }
        }
    }

    fn leave_dock(&mut self) {
        if self.is_charging() {
            self.end = Some(ChargeEnd::Undocked);
        }
        if self.phase != ChargePhase::Fault {
            self.phase = ChargePhase::Idle;
        }
        self.full = false;
        // After a reset the contacts count as open until they are debounced: that does not end a rest that was kept.
        if self.undocked_ms < UNDOCKED_MS {
            return;
        }
        self.rest = Rest {
            recharge_ms: self.rest.recharge_ms,
            ..Rest::default()
        };
    }

    /// Whether a charge may begin, and with which phase.
    fn consider(&mut self, averages: &Averages) {
        let settled =
            self.docked_ms >= DOCKED_MS && self.supplied_ms >= DOCKED_MS && self.off_ms >= DOCKED_MS;
        let needed =
            self.rest.wanted || (self.rest.left_ms == 0 && averages.pack_mv < self.scale.recharge_mv());
        if !settled || !needed || self.rest.forbidden || self.rest.left_ms > 0 {
            return;
        }
        if averages.current_ma.saturating_abs() >= OFFSET_FAULT_MA {
            return;
        }
        let known = self.thermometer.temperature().is_some() && self.charge.rate != ColdRate::None;
        let Some(cc) = averages.warmest_cc().filter(|cc| known && *cc <= WARMEST_CC) else {
            return;
        };
        if let Some(fault) = self.scale.unfit(averages.pack_mv) {
            self.fail(fault);
            return;
        }
        self.rest.wanted = false;
        self.full = false;
        self.charge.begin(cc);
        self.detectors.restart();
        self.phase = if averages.pack_mv < self.scale.precharge_mv() {
            ChargePhase::Precharge
        } else {
            ChargePhase::Fast
        };
    }

    fn precharge(&mut self, averages: &Averages) {
        if averages.pack_mv < self.scale.deep_mv() {
            self.fail(ChargeFault::DeepDischarge);
        } else if averages.pack_mv >= self.scale.precharge_mv() {
            self.charge.phase_ms = 0;
            self.detectors.restart();
            self.phase = ChargePhase::Fast;
        } else if self.charge.precharge_ms >= PRECHARGE_MS {
            self.fail(ChargeFault::Precharge);
        }
    }

    fn fast(&mut self, averages: &Averages) {
        let progress = self.charge.progress(self.scale);
        if let Some(end) = Detectors::each_second(averages, &progress, &self.stops) {
            self.finish(end);
        }
    }

    fn top_off(&mut self, averages: &Averages) {
        let warm = averages.warmest_cc().is_none_or(|cc| cc >= TOP_OFF_MAX_CC);
        let over = self.charge.phase_ms >= TOP_OFF_MS || self.charge.flowed_ms >= TIME_MS;
        let high = averages.pack_mv >= self.scale.voltage_max_mv();
        if warm || over || high {
            self.fill();
        }
    }

    /// A charge has ended.
    fn finish(&mut self, end: ChargeEnd) {
        self.end = Some(end);
        self.regulator.restart();
        let warm = self
            .thermometer
            .warmest_cc()
            .is_none_or(|cc| cc >= TOP_OFF_MAX_CC);
        match end {
            ChargeEnd::TemperatureSlope | ChargeEnd::NegativeDeltaV if !warm => {
                self.charge.phase_ms = 0;
                self.phase = ChargePhase::TopOff;
            }
            ChargeEnd::TemperatureSlope
            | ChargeEnd::NegativeDeltaV
            | ChargeEnd::ZeroDeltaV
            | ChargeEnd::TemperatureRise
            | ChargeEnd::Charge => self.fill(),
            ChargeEnd::Time => self.idle(LONG_REST_MS),
            ChargeEnd::Hot | ChargeEnd::Voltage | ChargeEnd::Undocked | ChargeEnd::Stopped => {
                self.idle(REST_MS);
            }
        }
    }

    fn idle(&mut self, rest_ms: u32) {
        self.charge.finish();
        self.rest.wait(rest_ms);
        self.phase = ChargePhase::Idle;
    }

    /// The pack is full. If it took next to nothing, it was full before, and the next charge waits twice as long.
    fn fill(&mut self) {
        let was_full = self.charge.charged_mas < self.scale.capacity_mas() / 7;
        let longer_ms = self.rest.recharge_ms.saturating_mul(2).min(RECHARGE_MAX_MS);
        self.rest.recharge_ms = if was_full {
            longer_ms.max(RECHARGE_MS)
        } else {
            RECHARGE_MS
        };
        self.rest.wait(self.rest.recharge_ms);
        self.charge.finish();
        self.pulse = MaintenancePulse {
            cool_ms: REST_MS,
            ..MaintenancePulse::default()
        };
        self.full = true;
        self.gauge.fill();
        self.phase = ChargePhase::Maintain;
    }

    fn maintain(&mut self, averages: &Averages) {
        self.pulse.ms = self.pulse.ms.saturating_add(averages.elapsed_ms);
        self.pulse.cool_ms = self.pulse.cool_ms.saturating_sub(averages.elapsed_ms);
        let rested = !self.pulse.on && self.pulse.ms >= PULSE_REST_MS;
        let empty = rested && averages.pack_mv < self.scale.recharge_mv() && self.rest.left_ms == 0;
        if empty || self.rest.wanted {
            // The guard demands a rest between the last pulse and the charge.
            self.rest.wait(if self.rest.wanted { 0 } else { REST_MS });
            self.phase = ChargePhase::Idle;
            return;
        }
        if self.pulse.cool_ms == 0 && self.pack.drain_ma > 0 && self.history.may_maintain() {
            self.history.note_maintained(averages.elapsed_ms);
        }
        let drain_mas = u32::from(self.pack.drain_ma).saturating_mul(PULSE_PERIOD_MS / 1_000);
        let given_mas = self.charge.charged_mas.saturating_sub(self.pulse.from_mas);
        let in_window =
            self.charge.rate == ColdRate::Full && averages.warmest_cc().is_some_and(|cc| cc <= WARMEST_CC);
        let over = given_mas >= drain_mas || self.pulse.ms >= PULSE_MAX_MS || !in_window;
        if self.pulse.on && over {
            self.pulse.on = false;
        } else if !self.pulse.on && self.pulse.ms >= PULSE_PERIOD_MS {
            let due = in_window && drain_mas > 0 && self.pulse.cool_ms == 0 && self.history.may_maintain();
            self.pulse = MaintenancePulse {
                on: due,
                ms: 0,
                from_mas: self.charge.charged_mas,
                cool_ms: self.pulse.cool_ms,
            };
        }
    }
}
