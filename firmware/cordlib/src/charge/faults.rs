//! Faults: they stop a charge until a person clears them.

use rvac_protocol::message::{ChargeFault, ChargePhase};

use crate::board::ThermistorFault;
use crate::rules::charge_fault::{
    ABSENT_MS, ADAPTER_MAX_MV, COOLED_CC, FORGIVE_MS, INTERRUPTIONS_MAX, LEAK_MA, LEAK_MS, NO_CURRENT_MA,
    NO_CURRENT_MS, NO_CURRENT_PAUSE_MS, NO_CURRENT_TRIES, OFFSET_FAULT_MA, OVER_MS, SETTLE_MS, THERMISTOR_MS,
    TOO_HOT_CC,
};
use crate::rules::charge_guard::AGE_MAX_MS;

use super::controller::{ChargeContext, ChargeController, Docking};
use super::frozen_sensor::FrozenSensorDetector;
use super::meter::{Averages, AveragingWindow, CompletedWindows};
use super::stops::Stops;

/// How long each condition has lasted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaultWatch {
    over_ms: u32,
    leak_ms: u32,
    no_current_ms: u32,
    no_current_tries: u8,
    frozen_sensor: FrozenSensorDetector,
    /// Averages of the last second and of the one before: a jump in the middle of a second is shared by two.
    seconds_mv: [Option<i32>; 2],
    supplied: bool,
    interruptions: u8,
    forgive_ms: u32,
}

impl FaultWatch {
    pub(super) const fn pass(&mut self, supplied: bool, elapsed_ms: u32) {
        if self.supplied && !supplied {
            self.interruptions = self.interruptions.saturating_add(1);
        }
        self.supplied = supplied;
        self.forgive_ms = self.forgive_ms.saturating_add(elapsed_ms);
        if self.forgive_ms >= FORGIVE_MS {
            self.forgive_ms = 0;
            self.interruptions = self.interruptions.saturating_sub(1);
        }
    }

    /// The switch was opened. The voltage falls with the current, which is no jump.
    pub(super) const fn interrupt(&mut self) {
        self.seconds_mv = [None; 2];
    }

    /// Resets the timers of faults that need a charge. A shorted switch needs none.
    fn rest_but_for_leaks(&mut self) {
        let leak_ms = self.leak_ms;
        self.rest();
        self.leak_ms = leak_ms;
    }

    /// Resets the timers: off the dock the charger has no faults. The count of interruptions stays.
    fn rest(&mut self) {
        *self = Self {
            supplied: self.supplied,
            interruptions: self.interruptions,
            forgive_ms: self.forgive_ms,
            ..Self::default()
        };
    }
}

/// Adds to a span while a condition holds, else resets it; returns whether it has reached `limit_ms`.
fn lasts(span_ms: &mut u32, condition: bool, elapsed_ms: u32, limit_ms: u32) -> bool {
    *span_ms = if condition {
        span_ms.saturating_add(elapsed_ms)
    } else {
        0
    };
    *span_ms >= limit_ms
}

impl<S: Stops> ChargeController<S> {
    /// Looks for a fault in the measurements of this pass.
    pub(super) fn find_fault(
        &mut self,
        windows: &CompletedWindows,
        context: ChargeContext,
    ) -> Option<ChargeFault> {
        if context.docking == Docking::Away {
            self.watch.rest();
            return None;
        }
        if context.docking == Docking::Leaving {
            self.watch.rest_but_for_leaks();
        }
        let leak = windows
            .of(AveragingWindow::Tenth)
            .and_then(|averages| self.find_leak(&averages));
        if self.phase == ChargePhase::Fault || context.docking == Docking::Leaving {
            return leak.filter(|_| self.fault != Some(ChargeFault::Shorted));
        }
        let at_work = self.is_charging() || self.phase == ChargePhase::Maintain;
        leak.or_else(|| (at_work && self.meter.age_ms() > AGE_MAX_MS).then_some(ChargeFault::Stale))
            .or_else(|| self.find_in_envelope(windows))
            .or_else(|| self.find_in_tenth(windows))
            .or_else(|| self.find_in_second(windows))
            .or_else(|| self.find_wrong_offset(windows))
    }

    /// Current flows though the switch is off.
    fn find_leak(&mut self, averages: &Averages) -> Option<ChargeFault> {
        let current_ma = self.current_offset.correct(*averages).current_ma;
        let leaks = self.off_ms >= SETTLE_MS && current_ma > LEAK_MA;
        lasts(&mut self.watch.leak_ms, leaks, averages.elapsed_ms, LEAK_MS).then_some(ChargeFault::Shorted)
    }

    /// Whether current flows though the switch is off, and has done so for a second.
    pub(crate) const fn leaks(&self) -> bool {
        self.watch.leak_ms >= LEAK_MS
    }

    fn find_in_envelope(&mut self, windows: &CompletedWindows) -> Option<ChargeFault> {
        let averages = windows.of(AveragingWindow::Envelope)?;
        let current_ma = self.current_offset.correct(averages).current_ma;
        let over = self.off_ms == 0 && current_ma > self.scale.over_current_ma();
        lasts(&mut self.watch.over_ms, over, averages.elapsed_ms, OVER_MS).then_some(ChargeFault::OverCurrent)
    }

    fn find_in_tenth(&mut self, windows: &CompletedWindows) -> Option<ChargeFault> {
        let averages = windows.of(AveragingWindow::Tenth)?;
        let at_work = self.is_charging() || self.phase == ChargePhase::Maintain;
        if averages.input_mv > ADAPTER_MAX_MV {
            return Some(ChargeFault::Adapter);
        }
        if at_work && self.watch.interruptions > INTERRUPTIONS_MAX {
            return Some(ChargeFault::Contact);
        }
        if !self.is_at_full_rate() {
            self.watch.frozen_sensor.pause();
        } else if self
            .watch
            .frozen_sensor
            .is_frozen(averages.warmest_cc(), averages.elapsed_ms)
        {
            return Some(ChargeFault::ThermistorFrozen);
        }
        let thermistor = self.thermometer.fault_for(THERMISTOR_MS).filter(|_| at_work);
        thermistor.map(|fault| match fault {
            ThermistorFault::Open => ChargeFault::ThermistorOpen,
            ThermistorFault::Shorted => ChargeFault::ThermistorShorted,
            ThermistorFault::Range => ChargeFault::ThermistorRange,
            ThermistorFault::Jump => ChargeFault::ThermistorJump,
            ThermistorFault::Frozen => ChargeFault::ThermistorFrozen,
        })
    }

    fn find_in_second(&mut self, windows: &CompletedWindows) -> Option<ChargeFault> {
        let averages = self.current_offset.correct(windows.of(AveragingWindow::Second)?);
        let at_work = self.is_charging() || self.phase == ChargePhase::Maintain;
        if at_work && averages.warmest_cc().is_some_and(|cc| cc >= TOO_HOT_CC) {
            return Some(ChargeFault::TooHot);
        }
        let flows = self.charge.flows();
        let [last_mv, before_mv] = self.watch.seconds_mv;
        self.watch.seconds_mv = [flows.then_some(averages.pack_mv), last_mv];
        let young = self.charge.is_young(ABSENT_MS);
        if flows && averages.pack_mv >= self.scale.voltage_max_mv() && young {
            return Some(ChargeFault::NoBattery);
        }
        let jumped = |mv: Option<i32>| mv.is_some_and(|mv| self.scale.is_jump(mv, averages.pack_mv));
        if flows && (jumped(last_mv) || jumped(before_mv)) {
            return Some(if young {
                ChargeFault::NoBattery
            } else {
                ChargeFault::VoltageJump
            });
        }
        let rests = self.off_ms >= averages.elapsed_ms.saturating_add(SETTLE_MS)
            && self.supplied_ms >= averages.elapsed_ms;
        if rests && self.scale.unfit(averages.pack_mv) == Some(ChargeFault::NoBattery) {
            return Some(ChargeFault::NoBattery);
        }
        self.find_no_current(&averages)
    }

    /// Ten seconds of rest show a current that cannot flow.
    fn find_wrong_offset(&mut self, windows: &CompletedWindows) -> Option<ChargeFault> {
        let averages = self
            .current_offset
            .correct(windows.of(AveragingWindow::TenSeconds)?);
        let needed = self.phase == ChargePhase::Idle && averages.pack_mv < self.scale.recharge_mv();
        let rested = self.off_ms >= averages.elapsed_ms.saturating_add(SETTLE_MS);
        let docked = self.docked_ms >= averages.elapsed_ms;
        let wrong =
            averages.current_ma.saturating_abs() >= OFFSET_FAULT_MA || self.current_offset.is_broken();
        (needed && rested && docked && wrong).then_some(ChargeFault::CurrentOffset)
    }

    /// A dock that gives no current is asked again after a pause; the third time it is a fault.
    fn find_no_current(&mut self, averages: &Averages) -> Option<ChargeFault> {
        let dry = self.regulator.must_flow() && averages.current_ma < NO_CURRENT_MA;
        if self.regulator.must_flow() && !dry {
            self.watch.no_current_tries = 0;
        }
        if !lasts(
            &mut self.watch.no_current_ms,
            dry,
            averages.elapsed_ms,
            NO_CURRENT_MS,
        ) {
            return None;
        }
        self.watch.no_current_ms = 0;
        self.watch.no_current_tries = self.watch.no_current_tries.saturating_add(1);
        if self.watch.no_current_tries >= NO_CURRENT_TRIES {
            return Some(ChargeFault::NoCurrent);
        }
        self.phase = ChargePhase::Idle;
        self.rest.wait(NO_CURRENT_PAUSE_MS);
        None
    }

    /// Stops charging with a fault.
    pub(super) fn fail(&mut self, fault: ChargeFault) {
        self.history.note_fault();
        self.fault = Some(fault);
        self.phase = ChargePhase::Fault;
        self.full = false;
        self.regulator.restart();
        self.charge.finish();
    }

    /// Clears the fault for a person; false if its cause remains. The third fault within a day cannot be cleared until the
    /// first of them is a day old.
    pub fn clear(&mut self) -> bool {
        let Some(fault) = self.fault else {
            return true;
        };
        if self.cause_remains(fault) {
            return false;
        }
        if self.history.is_faulty_day() {
            self.fault = Some(ChargeFault::Repeated);
            return false;
        }
        self.fault = None;
        self.watch.rest();
        self.watch.interruptions = 0;
        self.rest.wait(0);
        self.phase = ChargePhase::Idle;
        true
    }

    fn cause_remains(&self, fault: ChargeFault) -> bool {
        let supplied = self.supplied_ms > 0;
        let pack = self.pack();
        match fault {
            ChargeFault::TooHot => self.thermometer.warmest_cc().is_none_or(|cc| cc >= COOLED_CC),
            ChargeFault::ThermistorOpen
            | ChargeFault::ThermistorShorted
            | ChargeFault::ThermistorRange
            | ChargeFault::ThermistorJump => self.thermometer.temperature().is_none(),
            ChargeFault::Stale => pack.is_none(),
            ChargeFault::Shorted => supplied && pack.is_none_or(|(_, current_ma)| current_ma > LEAK_MA),
            ChargeFault::Adapter => {
                supplied
                    && self
                        .tenth
                        .is_none_or(|averages| averages.input_mv > ADAPTER_MAX_MV)
            }
            ChargeFault::NoBattery | ChargeFault::DeepDischarge => {
                pack.is_none_or(|(pack_mv, _)| self.scale.unfit(pack_mv).is_some())
            }
            ChargeFault::Repeated => self.history.is_faulty_day(),
            ChargeFault::OverCurrent => {
                pack.is_some_and(|(_, current_ma)| current_ma > self.scale.over_current_ma())
            }
            ChargeFault::CurrentOffset => {
                supplied && pack.is_none_or(|(_, current_ma)| current_ma.saturating_abs() >= OFFSET_FAULT_MA)
            }
            // These show while current flows, and come again then.
            ChargeFault::NoCurrent
            | ChargeFault::ThermistorFrozen
            | ChargeFault::VoltageJump
            | ChargeFault::Precharge
            | ChargeFault::Contact => false,
        }
    }
}
