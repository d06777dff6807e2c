//! The simulated board, made like the SR8730's: parts of cordlib's capability traits that hold plain values.
//!
//! Before each pass of the firmware's loop the robot puts what the home's sensors say into the parts, after it it takes
//! out what the firmware set. So the parts know nothing of the world, and the world nothing of the firmware.

mod actuators;
mod persistent;
mod sensors;
mod serial;

pub use actuators::{Cleaner, Sounder, Supervisor, WheelBridges};
pub use persistent::Persistent;
pub use sensors::{
    BumperPins, ButtonPins, CliffReceivers, CurrentReadings, DockInputs, DustBoxPin, EncoderCounters,
    GyroReading, PackPins, ProximityReadings, WheelDropPins,
};
pub use serial::SerialPort;

pub(crate) use actuators::WATCHDOG_MS;

use cordlib::board::{Board, Clock, Parts};
use rvac_units::Tick;

/// The parts of the simulated board, as types.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedParts;

impl Parts for SimulatedParts {
    type Clock = TickCounter;
    type Link = SerialPort;
    type Wheels = WheelBridges;
    type Reset = Persistent;
    type Watchdog = Supervisor;
    type Encoders = EncoderCounters;
    type Bumpers = BumperPins;
    type Cliffs = CliffReceivers;
    type WheelDrops = WheelDropPins;
    type Proximity = ProximityReadings;
    type Gyro = GyroReading;
    type Currents = CurrentReadings;
    type BrushMain = Cleaner;
    type BrushSides = Cleaner;
    type Vacuum = Cleaner;
    type Charger = PackPins;
    type DockContacts = DockInputs;
    type DockBeams = DockInputs;
    type DustBox = DustBoxPin;
    type Beeper = Sounder;
    type Lights = cordlib::board::Absent;
    type Buttons = ButtonPins;
    type Probe = cordlib::board::Absent;
}

/// The millisecond counter; starts at 0 with each reset.
#[derive(Clone, Copy, Debug, Default)]
pub struct TickCounter {
    pub(crate) tick: Tick,
}

impl Clock for TickCounter {
    fn tick(&mut self) -> Tick {
        self.tick
    }
}

/// A board whose every output is off, as it stands the moment after a reset.
pub(crate) fn fresh(persistent: Persistent) -> Board<SimulatedParts> {
    Board {
        clock: TickCounter::default(),
        link: SerialPort::default(),
        wheels: WheelBridges::default(),
        reset: persistent,
        watchdog: Supervisor::default(),
        encoders: EncoderCounters::default(),
        bumpers: BumperPins::default(),
        cliffs: CliffReceivers::default(),
        wheel_drops: WheelDropPins::default(),
        proximity: ProximityReadings::default(),
        gyro: GyroReading::default(),
        currents: CurrentReadings::default(),
        brush_main: Cleaner::default(),
        brush_sides: Cleaner::default(),
        vacuum: Cleaner::default(),
        charger: PackPins::default(),
        dock_contacts: DockInputs::default(),
        dock_beams: DockInputs::default(),
        dust_box: DustBoxPin::default(),
        beeper: Sounder::default(),
        lights: cordlib::board::Absent,
        buttons: ButtonPins::default(),
        probe: cordlib::board::Absent,
    }
}
