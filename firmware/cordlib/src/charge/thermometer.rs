//! The pack's temperature and its plausibility.

use crate::board::ThermistorFault;
use crate::rules::thermometer::{JUMP_CC, JUMP_MS, LEAST_CC, MOST_CC};

use super::meter::{Averages, PackTemperature};

/// The temperature and what is wrong with it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Thermometer {
    temperature: Option<PackTemperature>,
    /// Averages of the last second and of the one before: a jump in the middle of a second is shared by two.
    seconds_cc: [Option<i32>; 2],
    bad_ms: u32,
    bad: Option<ThermistorFault>,
    jump_ms: u32,
}

impl Thermometer {
    /// Time passes. Without a good reading the temperature becomes invalid.
    pub(super) const fn pass(&mut self, elapsed_ms: u32) {
        self.bad_ms = self.bad_ms.saturating_add(elapsed_ms);
        self.jump_ms = self.jump_ms.saturating_sub(elapsed_ms);
    }

    /// Takes the averages of 100 ms.
    pub(super) const fn each_tenth(&mut self, averages: &Averages) {
        match averages.temperature {
            Some(range) if range.warmest_cc >= LEAST_CC && range.coldest_cc <= MOST_CC => {
                self.temperature = Some(range);
                if self.jump_ms == 0 {
                    self.bad_ms = 0;
                    self.bad = None;
                }
            }
            Some(_) => self.doubt(ThermistorFault::Range),
            None => {
                if let Some(fault) = averages.fault {
                    self.doubt(fault);
                }
            }
        }
    }

    /// Takes the averages of a second.
    pub(super) fn each_second(&mut self, averages: &Averages) {
        let [last_cc, before_cc] = self.seconds_cc;
        self.seconds_cc = [averages.warmest_cc(), last_cc];
        let is_jump = |cc: Option<i32>, limit_cc: i32| match (cc, averages.warmest_cc()) {
            (Some(cc), Some(now_cc)) => now_cc.saturating_sub(cc).saturating_abs() > limit_cc,
            _ => false,
        };
        if is_jump(last_cc, JUMP_CC) || is_jump(before_cc, JUMP_CC + JUMP_CC / 2) {
            self.jump_ms = JUMP_MS;
            self.doubt(ThermistorFault::Jump);
        }
    }

    const fn doubt(&mut self, fault: ThermistorFault) {
        self.temperature = None;
        self.bad = Some(fault);
    }

    /// The newest temperature; `None` if none is plausible.
    pub(crate) const fn temperature(&self) -> Option<PackTemperature> {
        if self.jump_ms > 0 { None } else { self.temperature }
    }

    /// The most that it can be, in hundredths of a degree.
    pub(crate) fn warmest_cc(&self) -> Option<i32> {
        self.temperature().map(|temperature| temperature.warmest_cc)
    }

    /// A fault that has lasted for at least `span_ms`. A stopped converter counts as a frozen thermistor.
    pub(crate) fn fault_for(&self, span_ms: u32) -> Option<ThermistorFault> {
        (self.bad_ms >= span_ms || self.jump_ms > 0).then(|| self.bad.unwrap_or(ThermistorFault::Frozen))
    }
}
