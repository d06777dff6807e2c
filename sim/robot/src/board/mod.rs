//! The simulated boards: implementations of cordlib's board traits that hold plain values. The [`Outfit`] lists the
//! parts of a board.
//!
//! Before each pass of the firmware's loop the robot writes the home's sensor values into the parts; after it the robot
//! reads the outputs that the firmware set. The parts are independent of the world, and the world of the firmware.

mod actuators;
mod one_line;
mod outfit;
mod persistent;
mod sensors;
mod serial;

pub use actuators::{Cleaner, SimulatedWatchdog, Sounder, WheelBridges};
pub use outfit::{Outfit, Relax, Sr8730Outfit};
pub use persistent::{KeptRam, PersistentMemory};
pub use sensors::{
    BumperPins, ButtonPins, CurrentReadings, DockInputs, DustBoxPin, EncoderCounters, GyroSensor, PackPins,
    ProximityReadings, SimulatedCliffs, WheelDropPins,
};
pub use serial::SerialPort;

pub(crate) use actuators::WATCHDOG_MS;
pub(crate) use one_line::OneLine;

use core::marker::PhantomData;

use cordlib::board::{Board, Clock, Parts};
use rvac_units::Tick;

/// The parts of a simulated board, as types.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedParts<O>(PhantomData<O>);

impl<O: Outfit> Parts for SimulatedParts<O> {
    type Clock = TickCounter;
    type Link = SerialPort;
    type Wheels = WheelBridges;
    type Reset = PersistentMemory;
    type Watchdog = SimulatedWatchdog;
    type Kept = KeptRam;
    type Checks = cordlib::board::Absent;
    type Encoders = EncoderCounters;
    type Bumpers = BumperPins;
    type Cliffs = SimulatedCliffs;
    type WheelDrops = WheelDropPins<O>;
    type Proximity = ProximityReadings<O>;
    type Gyro = GyroSensor<O>;
    type Currents = CurrentReadings<O>;
    type BrushMain = Cleaner;
    type BrushSides = Cleaner;
    type Vacuum = Cleaner;
    type Charger = PackPins<O>;
    type DockContacts = DockInputs<O>;
    type DockBeams = DockInputs<O>;
    type DustBox = DustBoxPin<O>;
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

/// A board after a reset: every output is off.
pub(crate) fn fresh<O: Outfit>(persistent: PersistentMemory, kept: KeptRam) -> Board<SimulatedParts<O>> {
    Board {
        clock: TickCounter::default(),
        link: SerialPort::default(),
        wheels: WheelBridges::default(),
        reset: persistent,
        watchdog: SimulatedWatchdog::default(),
        kept,
        checks: cordlib::board::Absent,
        encoders: EncoderCounters::default(),
        bumpers: BumperPins::default(),
        cliffs: SimulatedCliffs::default(),
        wheel_drops: WheelDropPins::default(),
        proximity: ProximityReadings::default(),
        gyro: GyroSensor::default(),
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
