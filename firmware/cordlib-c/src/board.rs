//! The board, made of callbacks and pushed inputs.

use cord::board::{
    Absent, Beeper, BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CleaningMotor,
    CliffLevels, CliffSensors, Clock, CurrentSense, DockContacts, DockRequest, Emitters, Encoders,
    HardwareChecks, HardwareFault, HeadingSensor, Lights, Link, Parts, Received, ResetRecord, Watchdog,
    WheelCounts, WheelDrive, WheelDropSwitches, WheelMotors,
};
use rvac_protocol::message::{Bumpers, Cliffs, Currents, Gyro, ResetCause, WheelDrops};
use rvac_units::{Frequency, Ratio, Throttle, Tick};

use crate::callbacks::callbacks;
use crate::inputs::{QUEUE_BYTES, inputs};
use crate::machine::machine;
use crate::time::{hw_get_time, hw_get_time_ms};

/// Left wheel.
pub const CORD_MOTOR_WHEEL_LEFT: i32 = 0;
/// Right wheel.
pub const CORD_MOTOR_WHEEL_RIGHT: i32 = 1;
/// Main brush.
pub const CORD_MOTOR_BRUSH_MAIN: i32 = 2;
/// Both side brushes.
pub const CORD_MOTOR_BRUSH_SIDES: i32 = 3;
/// Suction.
pub const CORD_MOTOR_VACUUM: i32 = 4;

/// Every part of the C board. Each is a view of the one set of inputs and callbacks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foreign;

impl Parts for Foreign {
    type Clock = Foreign;
    type Link = Foreign;
    type Wheels = Foreign;
    type Reset = Foreign;
    type Watchdog = Foreign;
    type Kept = Foreign;
    type Checks = Foreign;
    type Encoders = Foreign;
    type Bumpers = Foreign;
    type Cliffs = CliffView;
    type WheelDrops = Foreign;
    type Proximity = Absent;
    type Gyro = Foreign;
    type Currents = Foreign;
    type BrushMain = ForeignMotor;
    type BrushSides = ForeignMotor;
    type Vacuum = ForeignMotor;
    type Charger = Foreign;
    type DockContacts = Foreign;
    type DockBeams = Absent;
    type DustBox = Absent;
    type Beeper = Foreign;
    type Lights = Foreign;
    type Buttons = Foreign;
    type Probe = Absent;
}

fn set_motor(motor: i32, throttle: Throttle) {
    if let Some(set) = callbacks().motor_throttle {
        set(motor, throttle.as_f64());
    }
}

impl Clock for Foreign {
    fn tick(&mut self) -> Tick {
        Tick(hw_get_time_ms())
    }

    fn microseconds(&mut self) -> u16 {
        let milliseconds = hw_get_time() * 1e3;
        ((milliseconds - milliseconds.floor()) * 1e3) as u16
    }
}

impl Link for Foreign {
    fn receive(&mut self) -> Option<Received> {
        inputs().received.pop_front()
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let queue = &mut inputs().to_send;
        let taken = bytes.len().min(QUEUE_BYTES.saturating_sub(queue.len()));
        queue.extend(bytes.iter().take(taken));
        taken
    }
}

impl WheelMotors for Foreign {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        set_motor(CORD_MOTOR_WHEEL_LEFT, left.duty());
        set_motor(CORD_MOTOR_WHEEL_RIGHT, right.duty());
    }
}

impl ResetRecord for Foreign {
    fn cause(&mut self) -> ResetCause {
        ResetCause::Unknown
    }

    fn boot_count(&mut self) -> u32 {
        machine().boot_count
    }

    fn recent(&mut self) -> u8 {
        machine().recent_resets
    }

    fn forget_recent(&mut self) {
        machine().recent_resets = 0;
    }
}

impl HardwareChecks for Foreign {
    fn stands(&mut self, fault: HardwareFault) -> bool {
        inputs().hardware_faults.contains(&fault)
    }
}

impl Watchdog for Foreign {
    fn feed(&mut self) {
        if let Some(feed) = callbacks().feed_watchdog {
            feed();
        }
    }
}

impl Encoders for Foreign {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        inputs().counts
    }
}

impl BumperSwitches for Foreign {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        inputs().bumpers
    }
}

/// Receivers that were not declared read as floor: cordlib's rule depends on the type only and would stop for them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CliffView {
    pub(crate) emitters: Emitters,
}

impl CliffSensors for CliffView {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        self.emitters = emitters;
        if let Some(set) = callbacks().cliff_emitters {
            set(i32::from(emitters == Emitters::On));
        }
    }

    fn levels(&mut self) -> CliffLevels {
        let absent = match self.emitters {
            Emitters::On => 1023,
            Emitters::Off => 0,
        };
        let (fitted, seen) = (machine().cliffs, inputs().cliffs);
        let level = |sensor: u8, level: u16| if sensor < fitted { level } else { absent };
        CliffLevels {
            left: level(0, seen.left),
            middle: level(1, seen.middle),
            right: level(2, seen.right),
        }
    }
}

impl WheelDropSwitches for Foreign {
    const SWITCHES: u8 = 2;

    fn hanging(&mut self) -> WheelDrops {
        inputs().wheel_drops
    }
}

impl HeadingSensor for Foreign {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        inputs().gyro
    }
}

impl CurrentSense for Foreign {
    const PRESENT: bool = true;

    fn currents(&mut self) -> Option<Currents> {
        inputs().currents
    }
}

/// A battery that is measured only: the C interface has no charging.
impl Charger for Foreign {
    const PRESENT: bool = true;
    const CHARGES: bool = false;

    fn readings(&mut self) -> Option<ChargerReadings> {
        let now = Tick(hw_get_time_ms());
        inputs().battery(now)
    }

    fn drive(&mut self, _: ChargeDrive) {}

    fn ask_dock(&mut self, _: DockRequest) {}
}

/// A cleaning motor by its number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForeignMotor(pub(crate) i32);

impl CleaningMotor for ForeignMotor {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        set_motor(self.0, duty);
    }
}

impl DockContacts for Foreign {
    fn closed(&mut self) -> bool {
        inputs().docked
    }
}

impl Beeper for Foreign {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, volume: Ratio) {
        if let Some(beep) = callbacks().beep {
            beep(pitch.as_hz(), volume.as_f64());
        }
    }

    fn silence(&mut self) {
        if let Some(beep) = callbacks().beep {
            beep(0.0, 0.0);
        }
    }
}

impl Lights for Foreign {
    const COUNT: u8 = 16;

    fn set(&mut self, light: u8, brightness: Ratio) {
        if let Some(led) = callbacks().led {
            led(i32::from(light), brightness.as_f64());
        }
    }
}

impl Buttons for Foreign {
    const COUNT: u8 = 8;

    fn down(&mut self) -> u8 {
        inputs().buttons
    }
}
