//! The board's parts on the chip: one file for each kind, and [`wiring`], which lists them all.
//!
//! # Interrupts
//! | level | source | what it does |
//! | --- | --- | --- |
//! | 6 | change notice | time and level of an edge of the link; pulses of the main brush |
//! | 6 | clock monitor | everything off |
//! | 5 | Timer4, while something is sent | next level of the link |
//! | 4 | input captures 1 to 4 | counts of the wheels |
//! | 3 | ADC, once a millisecond | copies a scan, selects the next proximity sensor |
//! | 3 | Timer3, while charging | the charger's pulse of this PWM period |
//! | 3 | Timer1, during 16.5 of 200 ms while current is requested | half a carrier period of the code for the dock |
//! | 3 | external interrupts, UARTs | edges of the beam receivers, bytes of the gyro module |
//! | 2 | core timer | the millisecond |
//!
//! Handlers and main loop share only atomic words and bounded rings.

pub mod bus_clock;
pub mod charger;
pub mod checks;
pub mod cleaners;
pub mod contacts;
pub mod converter;
pub mod encoders;
pub mod interlock;
pub mod kept;
pub mod link;
pub mod off;
pub mod panel;
pub mod probe;
pub mod receivers;
pub mod resets;
pub mod sensing;
pub mod serial;
pub mod tick;
pub mod wheels;
pub mod wiring;

use cordlib::board::{Board, Parts};

use cleaners::{BrushMain, Switched};
use pic32mx3_hal::gpio::{Output, Pin};

/// The types of this board's parts.
#[derive(Clone, Copy, Debug)]
pub struct Sr8730;

impl Parts for Sr8730 {
    type Clock = tick::TickClock;
    type Link = link::BoardLink;
    type Wheels = wheels::Wheels;
    type Reset = resets::Starts;
    type Watchdog = resets::Supervised;
    type Kept = kept::KeptCopies;
    type Checks = checks::SelfChecks;
    type Encoders = encoders::WheelEncoders;
    type Bumpers = contacts::BumperContacts;
    type Cliffs = sensing::CliffReceivers;
    type WheelDrops = contacts::DropSwitches;
    type Proximity = sensing::ProximityReceivers;
    type Gyro = serial::GyroModule;
    type Currents = sensing::WheelCurrents;
    type BrushMain = BrushMain;
    type BrushSides = Switched<Pin<'A', 4, Output>>;
    type Vacuum = Switched<Pin<'D', 5, Output>>;
    type Charger = charger::PackCharger;
    type DockContacts = contacts::Adapter;
    type DockBeams = receivers::BeamReceivers;
    type DustBox = contacts::DustBoxSwitch;
    type Beeper = panel::Speaker;
    type Lights = panel::PanelLights;
    type Buttons = contacts::ButtonLines;
    type Probe = probe::RawReadings;
}

/// Result of the parts' service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Service {
    /// Nothing special.
    Well,
    /// A guarded variable and its complement disagree.
    DamagedVariable,
}

/// Periodic work of the parts, once a millisecond, besides the calls from cordlib.
pub fn service(board: &mut Board<Sr8730>) -> Service {
    board.wheels.service();
    board.brush_main.service();
    board.brush_sides.service();
    board.vacuum.service();
    let damaged = board.charger.service();
    board.link.service();
    board.encoders.service();
    board.gyro.service();
    board.probe.service();
    board.dock_beams.service();
    board.lights.service();
    if damaged {
        Service::DamagedVariable
    } else {
        Service::Well
    }
}
