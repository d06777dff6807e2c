//! The charger, judged by what is really so in the pack (S18).

/// Charger and pack as they really are, faults of sensors left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Charging {
    /// The firmware drives the charging switch: closed at any time in the last 20 ms, which is an envelope of its pulses.
    pub driven: bool,
    /// A supply is on the contacts.
    pub supplied: bool,
    /// Current into the pack, mA, mean of the last 20 ms.
    pub current_ma: i32,
    /// At the pack's terminals, mV.
    pub pack_mv: i32,
    /// In the pack, tenths of a degree Celsius.
    pub temperature_dc: i32,
}

/// Milliseconds for which each cause has stood while the switch was driven.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ChargeStanding {
    pub(crate) unsupplied_ms: u32,
    pub(crate) driving_ms: u32,
    pub(crate) temperature_ms: u32,
    pub(crate) voltage_ms: u32,
    pub(crate) current_ms: u32,
    /// Driven in this charge, and not driven since.
    pub(crate) charged_ms: u32,
    rest_ms: u32,
}

/// No pack may be charged hotter or colder than this, tenths of a degree. The firmware stops at 50 degrees and does not start
/// below 0 by its own sensor, which may be wrong by 3 degrees.
const HOT_DC: i32 = 550;
const COLD_DC: i32 = -50;
/// 1.75 V a cell of twelve: the firmware stops at 1.70, by a divider of 1 %.
const VOLTAGE_MAX_MV: i32 = 21_000;
/// The firmware regulates to 1 A and stops at 1.25 A; its converter sees steps of 0.1 A.
const CURRENT_MAX_MA: i32 = 1_400;
/// A rest of half an hour ends a charge.
const REST_MS: u32 = 30 * 60_000;

impl ChargeStanding {
    pub(crate) fn update(&mut self, charging: &Charging, motors_run: bool) {
        let driven = charging.driven;
        let stand = |standing_ms: &mut u32, cause: bool| {
            *standing_ms = if driven && cause {
                standing_ms.saturating_add(1)
            } else {
                0
            };
        };
        stand(&mut self.unsupplied_ms, !charging.supplied);
        stand(&mut self.driving_ms, motors_run);
        let temperate = (COLD_DC..HOT_DC).contains(&charging.temperature_dc);
        stand(&mut self.temperature_ms, !temperate);
        stand(&mut self.voltage_ms, charging.pack_mv > VOLTAGE_MAX_MV);
        stand(&mut self.current_ms, charging.current_ma > CURRENT_MAX_MA);
        if driven {
            self.charged_ms = self.charged_ms.saturating_add(1);
            self.rest_ms = 0;
        } else {
            self.rest_ms = self.rest_ms.saturating_add(1);
            if self.rest_ms > REST_MS {
                self.charged_ms = 0;
            }
        }
    }
}
