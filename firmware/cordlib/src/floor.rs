//! Evaluation and self-test of the cliff sensors (S9).
//!
//! Every 0.9 s the emitters go dark for 2 ms, and each receiver's ambient level is read. A lit level that exceeds the
//! ambient level by the machine's threshold is floor. A receiver that is stuck at any level, or saturated by sunlight,
//! therefore stops seeing floor at the next test, within one second, and counts as a cliff.

use rvac_protocol::message::Cliffs;
use rvac_units::Tick;

use crate::board::{CliffLevels, CliffSensors, Emitters};
use crate::rules::cliff_test::{SETTLE_MS, TEST_PERIOD_MS};
use crate::timing::Deadline;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EmitterPhase {
    Lit,
    Dark,
    Relighting,
}

/// State of the evaluation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FloorWatch {
    fitted: bool,
    floor_level_min: u16,
    phase: EmitterPhase,
    phase_end: Deadline,
    ambient: CliffLevels,
    lit: CliffLevels,
    no_floor: Cliffs,
    blinded: Cliffs,
}

impl FloorWatch {
    /// Starts with a self-test, so that no level is used before its ambient part is known. `floor_level_min` is `None` if
    /// the threshold is not calibrated; the sensors then count as not fitted.
    pub(crate) fn new<C: CliffSensors>(sensors: &mut C, now: Tick, floor_level_min: Option<u16>) -> Self {
        sensors.set_emitters(Emitters::Off);
        Self {
            fitted: floor_level_min.is_some() && C::FITTED != Cliffs::default(),
            floor_level_min: floor_level_min.unwrap_or(u16::MAX).max(1),
            phase: EmitterPhase::Dark,
            phase_end: Deadline::at(now.after(SETTLE_MS)),
            ambient: CliffLevels::default(),
            lit: CliffLevels::default(),
            no_floor: Cliffs::default(),
            blinded: Cliffs::default(),
        }
    }

    /// Sensors that see no floor.
    pub(crate) const fn no_floor(&self) -> Cliffs {
        self.no_floor
    }

    /// Sensors that see as much light without their emitter as with it.
    pub(crate) const fn blinded(&self) -> Cliffs {
        self.blinded
    }

    /// Runs in every pass. From darkening to the end of relighting the last result stays.
    pub(crate) fn update<C: CliffSensors>(&mut self, sensors: &mut C, now: Tick) {
        if !self.fitted {
            return;
        }
        let phase_over = self.phase_end.has_come(now);
        match self.phase {
            EmitterPhase::Lit if phase_over => {
                sensors.set_emitters(Emitters::Off);
                self.enter(EmitterPhase::Dark, now.after(SETTLE_MS));
            }
            EmitterPhase::Dark if phase_over => {
                self.ambient = sensors.levels();
                sensors.set_emitters(Emitters::On);
                self.enter(EmitterPhase::Relighting, now.after(SETTLE_MS));
            }
            EmitterPhase::Relighting if phase_over => {
                self.judge(sensors.levels(), C::FITTED);
                self.blinded = self.lit_without_emitter(C::FITTED);
                self.enter(EmitterPhase::Lit, now.after(TEST_PERIOD_MS));
            }
            EmitterPhase::Lit => self.judge(sensors.levels(), C::FITTED),
            EmitterPhase::Dark | EmitterPhase::Relighting => {}
        }
    }

    fn enter(&mut self, phase: EmitterPhase, end: Tick) {
        self.phase = phase;
        self.phase_end = Deadline::at(end);
    }

    fn judge(&mut self, lit: CliffLevels, fitted: Cliffs) {
        if self.lit == lit && self.phase == EmitterPhase::Lit {
            return;
        }
        self.lit = lit;
        let missing = |lit: u16, ambient: u16| lit.saturating_sub(ambient) < self.floor_level_min;
        self.no_floor = Cliffs {
            left: fitted.left && missing(lit.left, self.ambient.left),
            middle: fitted.middle && missing(lit.middle, self.ambient.middle),
            right: fitted.right && missing(lit.right, self.ambient.right),
        };
    }

    fn lit_without_emitter(&self, fitted: Cliffs) -> Cliffs {
        let bright = |ambient: u16| ambient >= self.floor_level_min;
        Cliffs {
            left: fitted.left && self.no_floor.left && bright(self.ambient.left),
            middle: fitted.middle && self.no_floor.middle && bright(self.ambient.middle),
            right: fitted.right && self.no_floor.right && bright(self.ambient.right),
        }
    }
}
