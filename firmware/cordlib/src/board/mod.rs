//! What a board must supply: one small trait for each capability, and [`Board`], which holds one part of each kind.
//!
//! A board author writes a type for every part the machine has, names them in an implementation of [`Parts`], uses
//! [`Absent`] for what the machine lacks, and fills a [`Board`] with them. What is absent is reported to the host as
//! absent; no value is made up for it.
//!
//! Rules for every part:
//! - Calls return at once. They never wait for hardware.
//! - A part never calls back into this crate. Interrupts put events into bounded queues of the part, and the main loop
//!   takes them out through the trait.
//! - Inputs are the raw state of the pin or converter; debouncing, thresholds and time-outs are done here, once for all
//!   boards.
//! - All outputs are off by pin default before the first line of firmware runs (S4).

mod absent;
mod cleaner;
mod clock;
mod contact;
mod dock;
mod ground;
mod kept;
mod link;
mod panel;
mod power;
mod probe;
mod ranging;
mod supervision;
mod wheels;

pub use absent::Absent;
pub use cleaner::CleaningMotor;
pub use clock::Clock;
pub use contact::{BumperSwitches, DustBox, WheelDropSwitches};
pub use dock::{DockBeams, DockContacts};
pub use ground::{CliffLevels, CliffSensors, Emitters};
pub use kept::{KEPT_WORDS, KeptMemory, KeptWords};
pub use link::{Link, Received};
pub use panel::{Beeper, Buttons, Lights};
pub use power::{
    ChargeDrive, Charger, ChargerReadings, CurrentSense, DockRequest, TemperatureRange, ThermistorFault,
};
pub use probe::PinProbe;
pub use ranging::{HeadingSensor, ProximitySensors};
pub use supervision::{HardwareChecks, HardwareFault, ResetRecord, Watchdog};
pub use wheels::{Encoders, WheelCounts, WheelDrive, WheelMotors};

use rvac_protocol::message::Capabilities;
use rvac_units::Throttle;

/// The types of a board's parts. `Absent` stands for what the machine lacks; clock, link, wheels, reset record and
/// watchdog are what every machine has.
pub trait Parts {
    /// Millisecond clock.
    type Clock: Clock;
    /// Bytes to and from the host.
    type Link: Link;
    /// Bridges of the two wheels.
    type Wheels: WheelMotors;
    /// Why the chip started, and how often recently.
    type Reset: ResetRecord;
    /// Hardware watchdog.
    type Watchdog: Watchdog;
    /// Memory that a reset leaves alone.
    type Kept: KeptMemory;
    /// Self-checks of the hardware.
    type Checks: HardwareChecks;
    /// Wheel encoders.
    type Encoders: Encoders;
    /// Bumper switches.
    type Bumpers: BumperSwitches;
    /// Cliff sensors.
    type Cliffs: CliffSensors;
    /// Wheel drop switches.
    type WheelDrops: WheelDropSwitches;
    /// Proximity sensors.
    type Proximity: ProximitySensors;
    /// Gyro.
    type Gyro: HeadingSensor;
    /// Motor currents.
    type Currents: CurrentSense;
    /// Main brush.
    type BrushMain: CleaningMotor;
    /// Side brushes, driven together.
    type BrushSides: CleaningMotor;
    /// Suction.
    type Vacuum: CleaningMotor;
    /// Battery measurement and charger.
    type Charger: Charger;
    /// Dock contacts.
    type DockContacts: DockContacts;
    /// Dock beam receivers.
    type DockBeams: DockBeams;
    /// Dust box switch.
    type DustBox: DustBox;
    /// Sound.
    type Beeper: Beeper;
    /// Lights.
    type Lights: Lights;
    /// Buttons.
    type Buttons: Buttons;
    /// Raw readings.
    type Probe: PinProbe;
}

/// The parts of one machine.
#[allow(
    missing_docs,
    reason = "each field is the part that its type in `Parts` describes"
)]
pub struct Board<P: Parts> {
    pub clock: P::Clock,
    pub link: P::Link,
    pub wheels: P::Wheels,
    pub reset: P::Reset,
    pub watchdog: P::Watchdog,
    pub kept: P::Kept,
    pub checks: P::Checks,
    pub encoders: P::Encoders,
    pub bumpers: P::Bumpers,
    pub cliffs: P::Cliffs,
    pub wheel_drops: P::WheelDrops,
    pub proximity: P::Proximity,
    pub gyro: P::Gyro,
    pub currents: P::Currents,
    pub brush_main: P::BrushMain,
    pub brush_sides: P::BrushSides,
    pub vacuum: P::Vacuum,
    pub charger: P::Charger,
    pub dock_contacts: P::DockContacts,
    pub dock_beams: P::DockBeams,
    pub dust_box: P::DustBox,
    pub beeper: P::Beeper,
    pub lights: P::Lights,
    pub buttons: P::Buttons,
    pub probe: P::Probe,
}

impl<P: Parts> core::fmt::Debug for Board<P> {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.debug_struct("Board").finish_non_exhaustive()
    }
}

impl<P: Parts> Board<P> {
    /// Switches off everything that moves or charges. For a panic handler without access to the `Cord`: it rebuilds the
    /// parts and calls this.
    pub fn all_off(&mut self) {
        self.charger.drive(ChargeDrive::Off);
        self.motors_off();
    }

    /// Brakes the wheels and switches off every motor and the sound. Reflexes, `stop` and hardware faults all end motion
    /// here.
    pub fn motors_off(&mut self) {
        self.wheels.drive(WheelDrive::Brake, WheelDrive::Brake);
        self.brush_main.set(Throttle::ZERO);
        self.brush_sides.set(Throttle::ZERO);
        self.vacuum.set(Throttle::ZERO);
        self.beeper.silence();
    }

    /// What this board has, for the handshake.
    #[must_use]
    pub fn capabilities() -> Capabilities {
        let fitted = P::Cliffs::FITTED;
        Capabilities {
            encoders: P::Encoders::PRESENT,
            gyro: P::Gyro::PRESENT,
            bumpers: P::Bumpers::ZONES,
            cliffs: u8::from(fitted.left) + u8::from(fitted.middle) + u8::from(fitted.right),
            wheel_drops: P::WheelDrops::SWITCHES,
            proximity: P::Proximity::COUNT,
            dock_receivers: P::DockBeams::COUNT,
            buttons: P::Buttons::COUNT,
            leds: P::Lights::COUNT,
            beeper: P::Beeper::PRESENT,
            brush_main: P::BrushMain::PRESENT,
            brush_sides: P::BrushSides::PRESENT,
            vacuum: P::Vacuum::PRESENT,
            currents: P::Currents::PRESENT,
            battery: P::Charger::PRESENT,
            charger: P::Charger::CHARGES && P::Kept::PRESENT,
            probe: P::Probe::PRESENT,
        }
    }
}
