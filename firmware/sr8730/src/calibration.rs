//! Calibration of this robot: the values that its owner has measured, and assumed values where an assumption is safe.
//!
//! Values are used in groups: a part is available only if all values that it needs are known.

use cordlib::thermistor::MeasuredPoints;

use crate::generated::calibration::{COUNT, Calibrated, ENTRIES};
use crate::logic::beam::BeamCodes;
use crate::logic::calibration_record::{RecordFault, read};
use crate::logic::dock_code::LeadingOnes;
use crate::logic::gyro_frame::FrameKind;
use crate::logic::ladder::Ladder;
use crate::logic::proximity::ProximityScale;
use crate::logic::quadrature::PhaseOrder;

/// Bytes of a record: header, values, check value.
pub const RECORD_BYTES: usize = 8 + 4 * COUNT + 4;

/// All values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calibration {
    values: [Option<i32>; COUNT],
    fault: Option<RecordFault>,
}

/// Values for speed control of the wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelCalibration {
    /// Distance of the rim per encoder count, in nanometres.
    pub distance_per_count_nm: u32,
    /// Distance between the wheels, in micrometres.
    pub track_um: i32,
    /// Lines of the left wheel.
    pub left: PhaseOrder,
    /// Lines of the right wheel.
    pub right: PhaseOrder,
    /// Duty below which no wheel turns, in thousandths.
    pub dead_band_permille: i32,
    /// Speed of the rims at full duty, in mm/s.
    pub free_speed_mm_per_s: i32,
}

/// Scale of the wheel currents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurrentCalibration {
    /// Count of the left line without current.
    pub left_zero: i32,
    /// Count of the right line without current.
    pub right_zero: i32,
    /// Microamperes for one count, negative if the line falls with more current.
    pub scale_ua: i32,
}

/// How floor is distinguished from a drop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CliffCalibration {
    /// Rise of a level from a drop to the darkest floor, halved.
    pub floor_level: u16,
    /// Reference of the levels.
    pub emitters: CliffEmitters,
}

/// Wiring of the cliff sensors' emitters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CliffEmitters {
    /// LED_UNKNOWNS (RG0) switches them: a level is compared with the dark one before it.
    Switched,
    /// Nothing switches them: a level is compared with this one, measured over a drop.
    AlwaysLit(u16),
}

/// Port and protocol of the gyro module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GyroCalibration {
    /// UART 1 or 2.
    pub uart: u8,
    /// Its rate.
    pub baud: u32,
    /// Its frames.
    pub frame: FrameKind,
}

impl Calibration {
    /// From the record in flash. If the record cannot be used, only assumed values are known.
    #[must_use]
    pub fn from_record(record: &[u8]) -> Self {
        let ranges = ENTRIES.map(|entry| (entry.low, entry.high));
        match read(record, &ranges) {
            Ok(values) => Self { values, fault: None },
            Err(fault) => Self {
                values: [None; COUNT],
                fault: Some(fault),
            },
        }
    }

    /// Why the record is not used, if so.
    #[must_use]
    pub const fn fault(&self) -> Option<RecordFault> {
        self.fault
    }

    /// A measured value.
    #[must_use]
    pub fn measured(&self, which: Calibrated) -> Option<i32> {
        self.values.get(which.index()).copied().flatten()
    }

    /// A measured or assumed value.
    #[must_use]
    pub fn known(&self, which: Calibrated) -> Option<i32> {
        let assumed = ENTRIES.get(which.index()).and_then(|entry| entry.assumed);
        self.measured(which).or(assumed)
    }

    /// Speed control of the wheels.
    #[must_use]
    pub fn wheels(&self) -> Option<WheelCalibration> {
        let order = |which| {
            self.measured(which)
                .map(|value| PhaseOrder::from_calibration(Some(value)))
        };
        Some(WheelCalibration {
            distance_per_count_nm: u32::try_from(self.measured(Calibrated::WheelDistancePerCount)?).ok()?,
            track_um: self.measured(Calibrated::WheelTrack)?,
            left: order(Calibrated::WheelLeftOrder)?,
            right: order(Calibrated::WheelRightOrder)?,
            dead_band_permille: self.measured(Calibrated::WheelDeadBand)?,
            free_speed_mm_per_s: self.measured(Calibrated::WheelFreeSpeed)?,
        })
    }

    /// Currents of the wheels.
    #[must_use]
    pub fn currents(&self) -> Option<CurrentCalibration> {
        Some(CurrentCalibration {
            left_zero: self.measured(Calibrated::WheelLeftCurrentZero)?,
            right_zero: self.measured(Calibrated::WheelRightCurrentZero)?,
            scale_ua: self
                .measured(Calibrated::WheelCurrentScale)
                .filter(|scale| *scale != 0)?,
        })
    }

    /// Whether the main brush gives pulses often enough to detect a standstill within the 300 ms of S11.
    #[must_use]
    pub fn brush_gives_pulses(&self) -> bool {
        const PULSES_PER_S_MIN: i32 = 20;
        let rate = self.measured(Calibrated::BrushMainPulseRate);
        rate.is_some_and(|rate| rate >= PULSES_PER_S_MIN)
            && self.measured(Calibrated::BrushMainDeadBand).is_some()
    }

    /// Which button is which.
    #[must_use]
    pub fn ladder(&self) -> Option<Ladder> {
        let levels = [
            Calibrated::ButtonLadder1,
            Calibrated::ButtonLadder2,
            Calibrated::ButtonLadder3,
        ];
        Ladder::new(levels.map(|which| self.measured(which)))
    }

    /// Floor or drop.
    #[must_use]
    pub fn cliffs(&self) -> Option<CliffCalibration> {
        let level = |which| self.measured(which).and_then(|level| u16::try_from(level).ok());
        let emitters = match self.measured(Calibrated::CliffEmitterLine)? {
            1 => CliffEmitters::Switched,
            _ => CliffEmitters::AlwaysLit(level(Calibrated::CliffDropLevel)?),
        };
        Some(CliffCalibration {
            floor_level: level(Calibrated::CliffFloorLevel)?,
            emitters,
        })
    }

    /// Proximity sensors.
    #[must_use]
    pub fn proximity(&self) -> Option<ProximityScale> {
        let none = self.measured(Calibrated::ProximityNone)?;
        ProximityScale::new(none, self.measured(Calibrated::ProximityTouching)?)
    }

    /// Whether the charger may be used: its power stage was tested on a bench, and pack and divider are known.
    #[must_use]
    pub fn allows_charging(&self) -> bool {
        self.measured(Calibrated::ChargeStageChecked) == Some(1)
            && self.measured(Calibrated::BatteryScale).is_some()
            && self.measured(Calibrated::BatteryCapacity).is_some()
    }

    /// Two points of the thermistor's curve, if a third one agreed with them.
    #[must_use]
    pub fn thermistor(&self) -> Option<MeasuredPoints> {
        self.measured(Calibrated::ThermistorChecked)
            .filter(|checked| *checked == 1)?;
        Some(MeasuredPoints {
            ice: self.measured(Calibrated::ThermistorIce)?,
            warm: self.measured(Calibrated::ThermistorWarm)?,
            warm_dc: self.measured(Calibrated::ThermistorWarmTemperature)?,
        })
    }

    /// Current above which a wheel stands still, in mA: three quarters of what a held wheel draws from a full pack, which
    /// an empty one still reaches.
    #[must_use]
    pub fn wheel_current_max_ma(&self) -> i32 {
        let stall_ma = self.known(Calibrated::WheelStallCurrent).unwrap_or_default();
        stall_ma / 4 * 3
    }

    /// The code for the dock.
    #[must_use]
    pub fn dock_code(&self) -> LeadingOnes {
        LeadingOnes::from_calibration(self.known(Calibrated::DockCodeOnes))
    }

    /// The beams of the dock.
    #[must_use]
    pub fn beams(&self) -> Option<BeamCodes> {
        let codes = [
            Calibrated::DockBeamLeft,
            Calibrated::DockBeamRight,
            Calibrated::DockBeamNear,
        ];
        BeamCodes::new(
            codes.map(|which| self.measured(which)),
            self.measured(Calibrated::DockBeamShort),
        )
    }

    /// The gyro module.
    #[must_use]
    pub fn gyro(&self) -> Option<GyroCalibration> {
        Some(GyroCalibration {
            uart: u8::try_from(self.measured(Calibrated::GyroUart)?).ok()?,
            baud: u32::try_from(self.measured(Calibrated::GyroRate)?).ok()?,
            frame: FrameKind::from_calibration(self.measured(Calibrated::GyroFrame))?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Calibration, CliffEmitters};
    use crate::generated::calibration::{COUNT, Calibrated, ENTRIES};
    use crate::logic::calibration_record::{MAGIC, RecordFault, UNKNOWN, VERSION};
    use rvac_protocol::crc::crc32c;
    use std::vec::Vec;

    fn record(values: &[i32; COUNT]) -> Vec<u8> {
        let count = u16::try_from(COUNT).unwrap();
        let header = [
            &MAGIC.to_le_bytes()[..],
            &VERSION.to_le_bytes(),
            &count.to_le_bytes(),
        ]
        .concat();
        let body = values.iter().flat_map(|value| value.to_le_bytes());
        let mut bytes: Vec<u8> = header.into_iter().chain(body).collect();
        bytes.extend((!crc32c(u32::MAX, &bytes)).to_le_bytes());
        bytes
    }

    fn highest_but(changes: &[(Calibrated, i32)]) -> Calibration {
        let mut values = ENTRIES.map(|entry| entry.high);
        for (which, value) in changes {
            values[which.index()] = *value;
        }
        Calibration::from_record(&record(&values))
    }

    #[test]
    fn an_erased_record_leaves_all_parts_absent() {
        let calibration = Calibration::from_record(&[0xFF; 4_096]);
        assert_eq!(calibration.fault(), Some(RecordFault::Absent));
        assert_eq!(calibration.wheels(), None);
        assert_eq!(calibration.currents(), None);
        assert_eq!(calibration.ladder(), None);
        assert_eq!(calibration.cliffs(), None);
        assert_eq!(calibration.proximity(), None);
        assert_eq!(calibration.beams(), None);
        assert_eq!(calibration.gyro(), None);
        assert!(!calibration.allows_charging() && !calibration.brush_gives_pulses());
        assert_eq!(calibration.known(Calibrated::BatteryScale), Some(32_549));
    }

    #[test]
    fn each_missing_value_takes_its_part_away() {
        let missing = |which| highest_but(&[(which, UNKNOWN)]);
        for which in [
            Calibrated::WheelDistancePerCount,
            Calibrated::WheelTrack,
            Calibrated::WheelLeftOrder,
            Calibrated::WheelRightOrder,
            Calibrated::WheelDeadBand,
            Calibrated::WheelFreeSpeed,
        ] {
            assert!(highest_but(&[]).wheels().is_some());
            assert_eq!(missing(which).wheels(), None, "{which:?}");
        }
        for which in [
            Calibrated::BatteryScale,
            Calibrated::BatteryCapacity,
            Calibrated::ChargeStageChecked,
        ] {
            assert!(highest_but(&[]).allows_charging());
            assert!(
                !missing(which).allows_charging(),
                "{which:?}: an assumed value is not enough to charge"
            );
        }
        assert_eq!(missing(Calibrated::GyroRate).gyro(), None);
        assert_eq!(missing(Calibrated::DockBeamShort).beams(), None);
    }

    #[test]
    fn points_of_the_thermistor_count_only_with_a_third_that_agrees() {
        let checked = [
            (Calibrated::ThermistorIce, 8_517),
            (Calibrated::ThermistorWarm, 7_260),
            (Calibrated::ThermistorWarmTemperature, 400),
        ];
        assert!(highest_but(&checked).thermistor().is_some());
        for which in [
            Calibrated::ThermistorIce,
            Calibrated::ThermistorWarm,
            Calibrated::ThermistorWarmTemperature,
            Calibrated::ThermistorChecked,
        ] {
            assert_eq!(highest_but(&[(which, UNKNOWN)]).thermistor(), None, "{which:?}");
        }
        assert_eq!(
            highest_but(&[(Calibrated::ThermistorChecked, 0)]).thermistor(),
            None
        );
    }

    #[test]
    fn a_wheel_is_off_below_what_an_empty_pack_gives_a_held_one() {
        assert_eq!(
            highest_but(&[(Calibrated::WheelStallCurrent, 1_600)]).wheel_current_max_ma(),
            1_200
        );
        assert_eq!(
            Calibration::from_record(&[0xFF; 4_096]).wheel_current_max_ma(),
            1_500
        );
    }

    #[test]
    fn a_stage_that_failed_on_the_bench_never_charges() {
        assert!(!highest_but(&[(Calibrated::ChargeStageChecked, 0)]).allows_charging());
    }

    #[test]
    fn emitters_that_nothing_switches_need_the_level_of_a_drop() {
        let lit = [
            (Calibrated::CliffEmitterLine, 0),
            (Calibrated::CliffDropLevel, 40),
        ];
        let found = highest_but(&lit).cliffs().unwrap();
        assert_eq!(found.emitters, CliffEmitters::AlwaysLit(40));
        let unknown = [
            (Calibrated::CliffEmitterLine, 0),
            (Calibrated::CliffDropLevel, UNKNOWN),
        ];
        assert_eq!(highest_but(&unknown).cliffs(), None);
        let switched = [(Calibrated::CliffDropLevel, UNKNOWN)];
        assert_eq!(
            highest_but(&switched).cliffs().unwrap().emitters,
            CliffEmitters::Switched
        );
    }

    #[test]
    fn names_and_places_of_the_record_agree() {
        for (place, entry) in ENTRIES.iter().enumerate() {
            assert_eq!(entry.value.index(), place, "{:?}", entry.value);
            assert!(entry.low <= entry.high);
        }
    }
}
