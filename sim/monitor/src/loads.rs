//! Checks the wheels' motors against their true currents (S11) and against what was asked of them (S12).

use super::causes::{Drives, Pins, stand};

/// What a wheel's motor really draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WheelLoad {
    /// Now, mA.
    pub current_ma: i32,
    /// When it is held fast at full drive, mA.
    pub held_ma: i32,
}

/// A robot whose limit nobody has measured switches off at 1.5 A, on a line that may show a fifth less and 60 mA less.
const ALWAYS_TOO_MUCH_MA: i32 = 2_000;
/// So much of what a held wheel draws is drawn by a wheel that hardly turns, in hundredths.
const NEARLY_HELD: i32 = 95;
/// Speed by which a wheel may exceed what was asked: a push, one count of the encoder in a control period, a settling controller.
const SLACK_MM_PER_S: i32 = 120;

/// Milliseconds for which each wheel drew too much, or turned too fast, while it was driven.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LoadTimes {
    pub(crate) too_much_ms: [u32; 2],
    pub(crate) nearly_held_ms: [u32; 2],
    pub(crate) too_fast_ms: [u32; 2],
}

impl LoadTimes {
    /// Takes the next millisecond; `asked_mm_per_s` is the fastest rim that anybody has asked for, `None` = any.
    pub(crate) fn update(&mut self, pins: &Pins, drives: &Drives, asked_mm_per_s: Option<i32>) {
        let most = asked_mm_per_s.map(|asked| asked + asked / 2 + SLACK_MM_PER_S);
        for side in [0, 1] {
            let is_driven = drives.wheels[side] != 0;
            let WheelLoad { current_ma, held_ma } = pins.loads.map(|loads| loads[side]).unwrap_or_default();
            let is_known = is_driven && held_ma > 0;
            stand(
                &mut self.too_much_ms[side],
                is_known && current_ma > ALWAYS_TOO_MUCH_MA,
            );
            stand(
                &mut self.nearly_held_ms[side],
                is_known && current_ma > held_ma / 100 * NEARLY_HELD,
            );
            let rim = pins.rims_mm_per_s[side].abs();
            stand(
                &mut self.too_fast_ms[side],
                is_driven && most.is_some_and(|most| rim > most),
            );
        }
    }
}
