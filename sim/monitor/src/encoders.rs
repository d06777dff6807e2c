//! Checks what the encoders count against the true rims (S13).

use crate::causes::{Drives, Pins};

/// Counts are compared with the rim's way once in this time: a count is half a millimetre, a millisecond too short.
const WINDOW_MS: u32 = 100;
/// Way of the rim in a window, micrometres, from which an encoder must count it: twice the least speed at which S13 looks.
const WAY_LEAST_UM: i32 = 10_000;

/// For how long each encoder has been wrong while its wheel was driven.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EncoderWatch {
    pub(crate) wrong_ms: [u32; 2],
    way_um: [i32; 2],
    /// The wheel turned the way it was driven, in the whole window.
    pushed: [bool; 2],
    counts: [i32; 2],
    elapsed_ms: u32,
}

impl EncoderWatch {
    /// Takes the next millisecond.
    pub(crate) fn update(&mut self, pins: &Pins, drives: &Drives) {
        if self.elapsed_ms == 0 {
            self.begin(pins.counts);
        }
        for side in [0, 1] {
            // A millimetre per second is a micrometre in this millisecond.
            self.way_um[side] = self.way_um[side].saturating_add(pins.rims_mm_per_s[side]);
            self.pushed[side] &= drives.wheels[side].signum() == pins.rims_mm_per_s[side].signum();
        }
        self.elapsed_ms += 1;
        if self.elapsed_ms >= WINDOW_MS {
            self.conclude(pins.counts);
        }
    }

    fn begin(&mut self, counts: [i32; 2]) {
        self.way_um = [0; 2];
        self.pushed = [true; 2];
        self.counts = counts;
    }

    fn conclude(&mut self, counts: [i32; 2]) {
        for side in [0, 1] {
            let counted = counts[side].wrapping_sub(self.counts[side]).signum();
            let way_um = self.way_um[side];
            let is_wrong = self.pushed[side] && way_um.abs() > WAY_LEAST_UM && counted != way_um.signum();
            self.wrong_ms[side] = if is_wrong {
                self.wrong_ms[side].saturating_add(WINDOW_MS)
            } else {
                0
            };
        }
        self.elapsed_ms = 0;
    }
}
