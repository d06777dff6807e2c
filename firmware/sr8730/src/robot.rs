//! The robot: its parameters, its start, its main loop.

use cordlib::board::{ChargeDrive, HardwareFault};
use cordlib::{Cord, Parameters};
use pic32mx3_hal::flash::DataFlash;
use pic32mx3_hal::{Peripherals, interrupt, reset};
use rvac_protocol::message::{Capabilities, Inhibit, Inhibits, Limits, LogLevel};
use rvac_units::{AngularSpeed, Current, Length, Speed, Throttle};

use crate::board::checks::StartVerdict;
use crate::board::resets::{self, Starts};
use crate::board::{Service, Sr8730, service, tick, wiring};
use crate::calibration::{Calibration, RECORD_BYTES};
use crate::generated::calibration::Calibrated;
use crate::generated::{machine, variant};
use crate::logic::calibration_record::RecordFault;
use crate::logic::display::DisplayContent;
use crate::logic::reset_log::FatalCause;

/// The display is written that often.
const DISPLAY_PERIOD_MS: u8 = 100;
/// Inhibits that stay until somebody clears them.
const LATCHED: Inhibits = latched();

const fn latched() -> Inhibits {
    let mut latched = Inhibits::NONE;
    let mut number = 0;
    while number < Inhibit::ALL.len() {
        if Inhibit::ALL[number].is_latched() {
            latched.insert(Inhibit::ALL[number]);
        }
        number += 1;
    }
    latched
}

/// The whole robot.
#[derive(Debug)]
pub struct RobotProgram {
    cord: Cord<Sr8730>,
    until_display_ms: u8,
}

impl RobotProgram {
    /// Builds the robot from the chip as the start-up code leaves it: all outputs off.
    #[must_use]
    pub fn new(chip: Peripherals) -> Self {
        let starts = Starts::take();
        let fatal_cause = starts.fatal_cause();
        let calibration = Calibration::from_record(&record(&chip.data_flash));
        let mut board = wiring::assemble(chip, &calibration, starts);
        let verdict = board.checks.check_at_start();
        let mut robot = Self {
            cord: Cord::new(board, parameters(&calibration)),
            until_display_ms: 0,
        };
        robot.report_last_run(fatal_cause);
        robot.report_start(calibration.fault(), verdict);
        robot
    }

    /// What a check of the last run found is latched: the reset that followed must not take that away.
    fn report_last_run(&mut self, fatal_cause: FatalCause) {
        let fault = match fatal_cause {
            FatalCause::None => return,
            FatalCause::Memory | FatalCause::Flash | FatalCause::Stack | FatalCause::Variable => {
                HardwareFault::Memory
            }
            FatalCause::Clock => HardwareFault::Clock,
            FatalCause::Panic | FatalCause::Exception | FatalCause::StrayInterrupt | FatalCause::Register => {
                HardwareFault::Internal
            }
        };
        self.cord.log(LogLevel::Error, fatal_cause.words());
        self.cord.hardware_fault(fault);
    }

    fn report_start(&mut self, record: Option<RecordFault>, verdict: StartVerdict) {
        let record = match record {
            None => None,
            Some(RecordFault::Absent) => Some("not calibrated: parts are absent"),
            Some(RecordFault::Foreign) => Some("calibration is of another kind: parts are absent"),
            Some(RecordFault::Count(_)) => Some("calibration is of another firmware: parts are absent"),
            Some(RecordFault::Damaged) => Some("calibration is damaged: parts are absent"),
        };
        if let Some(words) = record {
            self.cord.log(LogLevel::Warn, words);
        }
        // cordlib latches these in its first pass, for as long as they stand.
        match verdict {
            StartVerdict::Sound => {}
            StartVerdict::DamagedImage => self.cord.log(LogLevel::Error, "image in flash is damaged"),
            StartVerdict::UncheckedImage => self.cord.log(LogLevel::Error, "image carries no check value"),
            StartVerdict::FaultyMemory => self.cord.log(LogLevel::Error, "a cell of memory is faulty"),
        }
    }

    /// Enables interrupts and runs the main loop.
    pub fn run(mut self) -> ! {
        interrupt::start();
        loop {
            if !cfg!(feature = "free-running") {
                tick::wait();
            }
            if tick::take_news() {
                self.millisecond();
            } else {
                self.cord.step();
            }
        }
    }

    fn millisecond(&mut self) {
        if let Some(fatal_cause) = self.cord.board_mut().checks.service() {
            fail_safe_reset(fatal_cause);
        }
        self.cord.step();
        if variant::DISPLAY.is_some() {
            self.write_display();
        }
        match service(self.cord.board_mut()) {
            Service::Well => {}
            Service::DamagedVariable => fail_safe_reset(FatalCause::Variable),
        }
    }

    #[inline(never)]
    /// The charge of the battery, with the colon while it charges, unless a fault is latched.
    fn write_display(&mut self) {
        if self.until_display_ms > 0 {
            self.until_display_ms -= 1;
            return;
        }
        self.until_display_ms = DISPLAY_PERIOD_MS - 1;
        let charging = self.cord.charge_drive() != ChargeDrive::Off;
        let content = if self.cord.inhibits().intersects(LATCHED) {
            DisplayContent::Fault
        } else {
            self.cord
                .battery_charge()
                .map_or(DisplayContent::UnknownCharge, DisplayContent::Charge)
        };
        self.cord.board_mut().lights.write(content, charging);
    }
}

/// The calibration record at the start of the data page.
fn record(flash: &DataFlash) -> [u8; RECORD_BYTES] {
    let mut record = [0; RECORD_BYTES];
    for (offset, bytes) in (0..).step_by(4).zip(record.as_chunks_mut::<4>().0) {
        *bytes = flash.word(offset).unwrap_or(u32::MAX).to_le_bytes();
    }
    record
}

/// Switches everything off, notes the cause for the next start, and resets the chip, which makes every pin an input.
pub fn fail_safe_reset(fatal_cause: FatalCause) -> ! {
    crate::board::off::everything();
    resets::note(fatal_cause);
    reset::software_reset()
}

/// The parameters of this robot for cordlib. Parts that are not calibrated are not fitted.
#[must_use]
pub fn parameters(calibration: &Calibration) -> Parameters {
    let wheels = calibration.wheels();
    let limits = Limits {
        speed_max: Speed(machine::SPEED_MAX_UM_PER_S),
        turn_max: AngularSpeed(machine::TURN_MAX_URAD_PER_S),
        track: Length(wheels.map_or(0, |known| known.track_um)),
        count_nm: wheels.map_or(0, |known| known.distance_per_count_nm),
        radius: Length(machine::RADIUS_UM),
        swath: Length(machine::SWATH_UM),
    };
    let mut parameters = Parameters::for_machine(machine::DEVICE, variant::FIRMWARE, limits);
    if let Some(known) = wheels {
        parameters.wheel.speed_at_full = Speed(known.free_speed_mm_per_s * 1_000);
        parameters.wheel.dead_band = Throttle::saturating_from_millionths(known.dead_band_permille * 1_000);
    }
    parameters.guard.wheel_current_max = Current(calibration.wheel_current_max_ma());
    if let Some(known) = calibration.cliffs() {
        parameters.guard.floor_level_min = known.floor_level;
    }
    let capacity = calibration.measured(Calibrated::BatteryCapacity);
    if let Some(capacity) = capacity.and_then(|capacity| u16::try_from(capacity).ok()) {
        parameters.pack.capacity_mah = capacity;
    }
    parameters.pack.measured = capacity.is_some() && calibration.measured(Calibrated::BatteryScale).is_some();
    parameters.fitted = Some(fitted(calibration));
    parameters
}

/// The capabilities that are reported to the host.
fn fitted(calibration: &Calibration) -> Capabilities {
    let all = cordlib::board::Board::<Sr8730>::capabilities();
    let count = |known: bool, count: u8| if known { count } else { 0 };
    Capabilities {
        encoders: calibration.wheels().is_some(),
        gyro: calibration.gyro().is_some(),
        cliffs: count(calibration.cliffs().is_some(), all.cliffs),
        proximity: count(calibration.proximity().is_some(), all.proximity),
        dock_receivers: count(calibration.beams().is_some(), all.dock_receivers),
        buttons: count(calibration.ladder().is_some(), all.buttons),
        // The ninth light is a line of unknown purpose. It is hidden once its purpose is calibrated.
        leds: all.leds - u8::from(calibration.cliffs().is_some()),
        currents: calibration.currents().is_some(),
        charger: calibration.allows_charging(),
        ..all
    }
}

#[cfg(test)]
mod tests {
    use super::parameters;
    use crate::calibration::Calibration;
    use crate::generated::calibration::{COUNT, ENTRIES};
    use crate::logic::calibration_record::{MAGIC, VERSION};
    use rvac_protocol::crc::crc32c;
    use std::vec::Vec;

    fn measured() -> Calibration {
        let count = u16::try_from(COUNT).unwrap();
        let mut record: Vec<u8> = [
            &MAGIC.to_le_bytes()[..],
            &VERSION.to_le_bytes(),
            &count.to_le_bytes(),
        ]
        .concat();
        record.extend(ENTRIES.iter().flat_map(|entry| entry.high.to_le_bytes()));
        record.extend((!crc32c(u32::MAX, &record)).to_le_bytes());
        Calibration::from_record(&record)
    }

    #[test]
    fn what_nobody_has_measured_is_not_fitted() {
        let fitted = parameters(&Calibration::from_record(&[0xFF; 4_096]))
            .fitted
            .unwrap();
        assert!(!fitted.encoders && !fitted.gyro && !fitted.currents && !fitted.charger);
        assert_eq!(
            (
                fitted.cliffs,
                fitted.proximity,
                fitted.dock_receivers,
                fitted.buttons
            ),
            (0, 0, 0, 0)
        );
        assert!(fitted.battery && fitted.probe && fitted.beeper && fitted.brush_main);
        assert_eq!((fitted.bumpers, fitted.wheel_drops, fitted.leds), (2, 2, 9));
    }

    #[test]
    fn a_calibrated_robot_has_everything_with_its_own_figures() {
        let parameters = parameters(&measured());
        let fitted = parameters.fitted.unwrap();
        assert!(fitted.encoders && fitted.gyro && fitted.currents && fitted.charger);
        assert_eq!(
            (
                fitted.cliffs,
                fitted.proximity,
                fitted.dock_receivers,
                fitted.buttons
            ),
            (3, 7, 4, 3)
        );
        assert_eq!(fitted.leds, 8);
        assert_eq!(parameters.limits.count_nm, 50_000_000);
        assert_eq!(parameters.limits.track.0, 500_000);
        assert_eq!(parameters.wheel.dead_band.millionths(), 900_000);
        assert_eq!(parameters.pack.capacity_mah, 5_000);
    }
}
