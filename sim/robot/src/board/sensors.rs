//! Sensor inputs: values that the robot writes before each pass of the firmware. The outfit decides how many of a kind
//! there are.

use core::marker::PhantomData;

use cordlib::board::{
    BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CliffLevels, CliffSensors, CurrentSense,
    DockBeams, DockContacts, DockRequest, DustBox, Emitters, Encoders, HeadingSensor, ProximitySensors,
    WheelCounts, WheelDropSwitches,
};
use rvac_protocol::message::{Bumpers, Cliffs, Currents, DockReceivers, Gyro, PROXIMITY_SENSORS, WheelDrops};

use super::Outfit;

/// Bumper switches, two zones.
#[derive(Clone, Copy, Debug, Default)]
pub struct BumperPins {
    pub(crate) pressed: Bumpers,
}

impl BumperSwitches for BumperPins {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        self.pressed
    }
}

/// Cliff emitters and receivers. The home answers to the emitters a millisecond later.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedCliffs {
    pub(crate) levels: CliffLevels,
    pub(crate) emitters: Emitters,
}

impl Default for SimulatedCliffs {
    fn default() -> Self {
        Self {
            levels: CliffLevels::default(),
            emitters: Emitters::On,
        }
    }
}

impl CliffSensors for SimulatedCliffs {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        self.emitters = emitters;
    }

    fn levels(&mut self) -> CliffLevels {
        self.levels
    }
}

/// Wheel drop switches.
#[derive(Clone, Copy, Debug, Default)]
pub struct WheelDropPins<O> {
    pub(crate) hanging: WheelDrops,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> WheelDropSwitches for WheelDropPins<O> {
    const SWITCHES: u8 = O::WHEEL_DROPS;

    fn hanging(&mut self) -> WheelDrops {
        self.hanging
    }
}

/// Encoder counters.
#[derive(Clone, Copy, Debug, Default)]
pub struct EncoderCounters {
    pub(crate) counts: WheelCounts,
}

impl Encoders for EncoderCounters {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        self.counts
    }
}

/// Proximity sensors.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProximityReadings<O> {
    pub(crate) closeness: [u8; PROXIMITY_SENSORS],
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> ProximitySensors for ProximityReadings<O> {
    const COUNT: u8 = O::PROXIMITY;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        self.closeness
    }
}

/// Gyro.
#[derive(Clone, Copy, Debug, Default)]
pub struct GyroSensor<O> {
    pub(crate) gyro: Option<Gyro>,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> HeadingSensor for GyroSensor<O> {
    const PRESENT: bool = O::GYRO;

    fn heading(&mut self) -> Option<Gyro> {
        self.gyro
    }
}

/// Motor currents.
#[derive(Clone, Copy, Debug, Default)]
pub struct CurrentReadings<O> {
    pub(crate) currents: Option<Currents>,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> CurrentSense for CurrentReadings<O> {
    const PRESENT: bool = O::ANALOG;

    fn currents(&mut self) -> Option<Currents> {
        self.currents
    }
}

/// Battery and charger.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackPins<O> {
    pub(crate) readings: Option<ChargerReadings>,
    pub(crate) drive: ChargeDrive,
    pub(crate) request: DockRequest,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> Charger for PackPins<O> {
    const PRESENT: bool = O::ANALOG;
    const CHARGES: bool = O::DOCK_BEAMS > 0;

    fn readings(&mut self) -> Option<ChargerReadings> {
        self.readings
    }

    fn drive(&mut self, drive: ChargeDrive) {
        self.drive = drive;
    }

    fn ask_dock(&mut self, request: DockRequest) {
        self.request = request;
    }
}

/// Dock contacts and dock receivers.
#[derive(Clone, Copy, Debug, Default)]
pub struct DockInputs<O> {
    pub(crate) closed: bool,
    pub(crate) symbols: DockReceivers,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> DockContacts for DockInputs<O> {
    fn closed(&mut self) -> bool {
        self.closed
    }
}

impl<O: Outfit> DockBeams for DockInputs<O> {
    const COUNT: u8 = O::DOCK_BEAMS;

    fn symbols(&mut self) -> DockReceivers {
        self.symbols
    }
}

/// Buttons.
#[derive(Clone, Copy, Debug, Default)]
pub struct ButtonPins {
    pub(crate) down: u8,
}

impl Buttons for ButtonPins {
    const COUNT: u8 = 3;

    fn down(&mut self) -> u8 {
        self.down
    }
}

/// Switch behind the dust box.
#[derive(Clone, Copy, Debug, Default)]
pub struct DustBoxPin<O> {
    pub(crate) inserted: bool,
    pub(crate) outfit: PhantomData<O>,
}

impl<O: Outfit> DustBox for DustBoxPin<O> {
    fn inserted(&mut self) -> Option<bool> {
        O::DUST_BOX.then_some(self.inserted)
    }
}
