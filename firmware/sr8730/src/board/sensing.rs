//! Sensors that are read from the converter: cliffs, proximity, wheel currents.

use cordlib::board::{CliffLevels, CliffSensors, CurrentSense, Emitters, ProximitySensors};
use pic32mx3_hal::gpio::{Level, Output, Pin};
use rvac_protocol::message::{Cliffs, Currents, PROXIMITY_SENSORS};
use rvac_units::Current;

use super::converter;
use super::encoders::Odometer;
use super::tick;
use crate::calibration::{Calibration, CliffCalibration, CliffEmitters, CurrentCalibration};
use crate::generated::calibration::Calibrated;
use crate::generated::pins::{self, Signal};
use crate::logic::floor_light::{FrozenReadingDetector, frozen_after_counts};
use crate::logic::proximity::{ProximityScale, SENSORS};

const CLIFFS: [Signal; 3] = [pins::CLIFF_LEFT, pins::CLIFF_MIDDLE, pins::CLIFF_RIGHT];

/// The cliff sensors.
#[derive(Debug)]
pub struct CliffReceivers {
    /// LED_UNKNOWNS, if it is known to be the supply of the emitters.
    emitters: Option<Pin<'G', 0, Output>>,
    calibration: Option<CliffCalibration>,
    lit: bool,
    watch: [FrozenReadingDetector; 3],
    odometer: Odometer,
    frozen_after_counts: u32,
    seen: u32,
    plausible: [bool; 3],
}

impl CliffReceivers {
    /// With their calibrated emitters and levels; `emitters` is the line that switches them, if any.
    #[must_use]
    pub fn take(emitters: Option<Pin<'G', 0, Output>>, calibration: &Calibration) -> Self {
        Self {
            emitters,
            calibration: calibration.cliffs(),
            lit: true,
            watch: [FrozenReadingDetector::default(); 3],
            odometer: Odometer::default(),
            frozen_after_counts: frozen_after_counts(calibration.measured(Calibrated::WheelDistancePerCount)),
            seen: 0,
            plausible: [true; 3],
        }
    }

    /// Levels for emitters that are always lit. The level of a drop stands in for the dark reading. A receiver with
    /// implausible readings reports that level when lit as well, which cordlib treats as a drop.
    fn always_lit(&mut self, counts: [u16; 3], drop_level: u16) -> [u16; 3] {
        if !self.lit {
            return [drop_level; 3];
        }
        let scans = converter::scans();
        if scans != self.seen {
            self.seen = scans;
            let counts_moved = self.odometer.take();
            for ((plausible, watch), count) in self.plausible.iter_mut().zip(&mut self.watch).zip(counts) {
                *plausible = watch.is_plausible(count, counts_moved, self.frozen_after_counts);
            }
        }
        let [left, middle, right] = self.plausible;
        let judged = |plausible: bool, count| if plausible { count } else { drop_level };
        let [left_count, middle_count, right_count] = counts;
        [
            judged(left, left_count),
            judged(middle, middle_count),
            judged(right, right_count),
        ]
    }
}

impl CliffSensors for CliffReceivers {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        self.lit = emitters == Emitters::On;
        if let Some(emitters) = &mut self.emitters {
            emitters.set_level(if self.lit { Level::High } else { Level::Low });
        }
    }

    fn levels(&mut self) -> CliffLevels {
        let counts = converter::whole(|| CLIFFS.map(converter::count));
        let levels = match self.calibration.map(|known| known.emitters) {
            Some(CliffEmitters::AlwaysLit(drop_level)) => self.always_lit(counts, drop_level),
            Some(CliffEmitters::Switched) | None => counts,
        };
        let [left, middle, right] = levels;
        CliffLevels { left, middle, right }
    }
}

/// The seven infrared proximity sensors.
#[derive(Debug)]
pub struct ProximityReceivers {
    scale: Option<ProximityScale>,
}

impl ProximityReceivers {
    /// With the calibrated readings for no object and for contact, if they are known.
    #[must_use]
    pub const fn take(scale: Option<ProximityScale>) -> Self {
        Self { scale }
    }
}

impl ProximitySensors for ProximityReceivers {
    const COUNT: u8 = SENSORS as u8;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        let mut closeness = [0; PROXIMITY_SENSORS];
        if let Some(scale) = self.scale {
            for (sensor, place) in closeness.iter_mut().take(SENSORS).enumerate() {
                let (dark, lit) = converter::proximity(sensor);
                *place = scale.closeness(dark, lit);
            }
        }
        closeness
    }
}

/// Currents of the wheels. The main brush has no such line.
#[derive(Debug)]
pub struct WheelCurrents {
    calibration: Option<CurrentCalibration>,
    filters: [LowPass; 2],
    at: u32,
}

/// First-order low-pass filter over some milliseconds: the line has no filter, and a motor with 20 kHz PWM makes it
/// noisy.
#[derive(Clone, Copy, Debug, Default)]
struct LowPass {
    sixteenths: i32,
}

impl LowPass {
    const fn take(&mut self, count: u16) {
        self.sixteenths += count as i32 - self.sixteenths / 16;
    }
}

impl WheelCurrents {
    /// With offset and scale, if they are calibrated.
    #[must_use]
    pub fn take(calibration: Option<CurrentCalibration>) -> Self {
        Self {
            calibration,
            filters: [LowPass::default(); 2],
            at: tick::ticks(),
        }
    }
}

impl CurrentSense for WheelCurrents {
    const PRESENT: bool = true;
    const BRUSH_MAIN: bool = false;

    fn currents(&mut self) -> Option<Currents> {
        let known = self.calibration?;
        converter::age_ms()?;
        let counts = [pins::WHEEL_LEFT_CURRENT, pins::WHEEL_RIGHT_CURRENT].map(converter::count);
        let now = tick::ticks();
        let [left, right] = &mut self.filters;
        let [left_count, right_count] = counts;
        if now != self.at {
            self.at = now;
            left.take(left_count);
            right.take(right_count);
        }
        let current = |filter: &LowPass, zero: i32| {
            // Below 1,023 counts of 50 mA: fits.
            Current((filter.sixteenths / 16 - zero) * known.scale_ua / 1_000)
        };
        Some(Currents {
            wheel_left: current(left, known.left_zero),
            wheel_right: current(right, known.right_zero),
            brush_main: Current::ZERO,
        })
    }
}
