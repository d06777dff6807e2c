//! S16: below 1.1 V a cell for 10 s the robot should return to its dock; below 1.0 V for 2 s brushes and suction are off;
//! below 0.9 V for 0.5 s everything is off. An empty pack recovers its voltage without load, so each level stays until the
//! pack is charged or exchanged.
//! S17: above 55 °C motors are off until the pack has cooled; above 60 °C that is latched. A temperature that cannot be
//! measured for 2 s is latched too.

use rvac_protocol::message::{Inhibit, Inhibits};
use rvac_units::Tick;

use crate::charge::Thermometer;
use crate::rules::battery::{
    CHARGED_MS, CHARGED_MV, COOLED_CC, COOLED_MS, EMPTY_MS, EMPTY_MV, EXCHANGED_MS, EXCHANGED_MV, HOT_CC,
    HOT_MS, LOW_MS, LOW_MV, OVERHEATED_CC, UNMEASURED_MS, WEAK_MS, WEAK_MV,
};
use crate::timing::HoldTimer;

/// Threshold in millivolts per cell, and how long the cell voltage must be below it.
const LEVELS: [(Inhibit, i32, u32); 3] = [
    (Inhibit::BatteryLow, LOW_MV, LOW_MS),
    (Inhibit::BatteryWeak, WEAK_MV, WEAK_MS),
    (Inhibit::BatteryEmpty, EMPTY_MV, EMPTY_MS),
];

/// What the rule looks at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackView {
    /// Averaged over 100 ms; `None` without fresh readings.
    pub(crate) pack_mv: Option<i32>,
    pub(crate) cells: i32,
    /// The contacts carry a supply.
    pub(crate) supplied: bool,
    pub(crate) thermometer: Thermometer,
}

/// One threshold of the voltage.
#[derive(Clone, Copy, Debug, Default)]
struct VoltageLevel {
    active: bool,
    below: HoldTimer,
    charged: HoldTimer,
    exchanged: HoldTimer,
}

/// State of the battery rules.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BatteryRule {
    levels: [VoltageLevel; LEVELS.len()],
    hot: bool,
    hot_for: HoldTimer,
    overheated_for: HoldTimer,
    cooled_for: HoldTimer,
    unmeasured: bool,
}

impl BatteryRule {
    /// Takes the pack's readings; returns what is to be latched.
    pub(crate) fn update(&mut self, view: &PackView, now: Tick) -> Inhibits {
        if let Some(pack_mv) = view.pack_mv {
            let cell_mv = pack_mv / view.cells.max(1);
            for (level, (_, least_mv, span_ms)) in self.levels.iter_mut().zip(LEVELS) {
                let above_mv = cell_mv.saturating_sub(least_mv);
                level.fall(above_mv, now, span_ms);
                level.recover(view.supplied && above_mv >= CHARGED_MV, cell_mv, now);
            }
        }
        let cc = view.thermometer.warmest_cc();
        let above = |limit_cc: i32| cc.is_some_and(|cc| cc > limit_cc);
        self.hot |= self.hot_for.for_at_least(above(HOT_CC), now, HOT_MS);
        let cooled = cc.is_some_and(|cc| cc < COOLED_CC);
        if self.cooled_for.for_at_least(self.hot && cooled, now, COOLED_MS) {
            self.hot = false;
        }
        let mut latched = Inhibits::NONE;
        if self
            .overheated_for
            .for_at_least(above(OVERHEATED_CC), now, HOT_MS)
        {
            latched.insert(Inhibit::BatteryOverheated);
        }
        let is_fault = view.thermometer.fault_for(UNMEASURED_MS).is_some();
        if is_fault {
            latched.insert(Inhibit::Thermistor);
        }
        self.unmeasured = is_fault || cc.is_none();
        latched
    }

    /// What inhibits now, besides what is latched.
    pub(crate) fn inhibits(&self) -> Inhibits {
        let mut inhibits = Inhibits::NONE;
        for (level, (inhibit, ..)) in self.levels.iter().zip(LEVELS) {
            if level.active {
                inhibits.insert(inhibit);
            }
        }
        if self.hot {
            inhibits.insert(Inhibit::BatteryHot);
        }
        inhibits
    }

    /// The pack is still too hot to clear `battery-overheated`.
    pub(crate) const fn is_hot(&self) -> bool {
        self.hot
    }

    /// The temperature still cannot be measured.
    pub(crate) const fn is_unmeasured(&self) -> bool {
        self.unmeasured
    }

    /// The levels and the heat that last until the pack was charged or has cooled, for the kept record.
    pub(crate) fn kept(&self) -> u8 {
        let levels = self.levels.iter().rev();
        levels.fold(u8::from(self.hot), |bits, level| {
            bits << 1 | u8::from(level.active)
        })
    }

    /// Goes on where the rule stood before a reset.
    pub(crate) fn take_up(&mut self, kept: u8) {
        for (place, level) in self.levels.iter_mut().enumerate() {
            level.active = kept & 1 << place != 0;
        }
        self.hot = kept & 1 << LEVELS.len() != 0;
    }
}

impl VoltageLevel {
    fn fall(&mut self, above_mv: i32, now: Tick, span_ms: u32) {
        self.active |= self.below.for_at_least(above_mv < 0, now, span_ms);
    }

    fn recover(&mut self, charged: bool, cell_mv: i32, now: Tick) {
        let over = self.charged.for_at_least(self.active && charged, now, CHARGED_MS)
            | self
                .exchanged
                .for_at_least(self.active && cell_mv >= EXCHANGED_MV, now, EXCHANGED_MS);
        if over {
            self.active = false;
        }
    }
}
