//! Sensor inputs: values that the robot fills in before each pass of the firmware.

use cordlib::board::{
    BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CliffLevels, CliffSensors, CurrentSense,
    DockBeams, DockContacts, DockRequest, DustBox, Emitters, Encoders, HeadingSensor, ProximitySensors,
    WheelCounts, WheelDropSwitches,
};
use rvac_protocol::message::{Bumpers, Cliffs, Currents, DockReceivers, Gyro, PROXIMITY_SENSORS, WheelDrops};

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
pub struct CliffReceivers {
    pub(crate) levels: CliffLevels,
    pub(crate) emitters: Emitters,
}

impl Default for CliffReceivers {
    fn default() -> Self {
        Self {
            levels: CliffLevels::default(),
            emitters: Emitters::On,
        }
    }
}

impl CliffSensors for CliffReceivers {
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
pub struct WheelDropPins {
    pub(crate) hanging: WheelDrops,
}

impl WheelDropSwitches for WheelDropPins {
    const SWITCHES: u8 = 2;

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
pub struct ProximityReadings {
    pub(crate) closeness: [u8; PROXIMITY_SENSORS],
}

impl ProximitySensors for ProximityReadings {
    const COUNT: u8 = 7;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        self.closeness
    }
}

/// Gyro.
#[derive(Clone, Copy, Debug, Default)]
pub struct GyroReading {
    pub(crate) gyro: Option<Gyro>,
}

impl HeadingSensor for GyroReading {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        self.gyro
    }
}

/// Motor currents.
#[derive(Clone, Copy, Debug, Default)]
pub struct CurrentReadings {
    pub(crate) currents: Option<Currents>,
}

impl CurrentSense for CurrentReadings {
    const PRESENT: bool = true;

    fn currents(&mut self) -> Option<Currents> {
        self.currents
    }
}

/// Battery and charger.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackPins {
    pub(crate) readings: Option<ChargerReadings>,
    pub(crate) drive: ChargeDrive,
    pub(crate) request: DockRequest,
}

impl Charger for PackPins {
    const PRESENT: bool = true;
    const CHARGES: bool = true;

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
pub struct DockInputs {
    pub(crate) closed: bool,
    pub(crate) symbols: DockReceivers,
}

impl DockContacts for DockInputs {
    fn closed(&mut self) -> bool {
        self.closed
    }
}

impl DockBeams for DockInputs {
    const COUNT: u8 = 4;

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
pub struct DustBoxPin {
    pub(crate) inserted: bool,
}

impl DustBox for DustBoxPin {
    fn inserted(&mut self) -> Option<bool> {
        Some(self.inserted)
    }
}
