//! Switches: bumper, wheel drops, dust box, dock contacts, buttons. All are read in each pass of the main loop, far
//! more often than their rules require. cordlib debounces them.

use cordlib::board::{BumperSwitches, Buttons, DockContacts, DustBox, WheelDropSwitches};
use pic32mx3_hal::gpio::{Input, Pin};
use rvac_protocol::message::{Bumpers, ButtonProbe, WheelDrops};

use super::converter;
use crate::generated::pins;
use crate::logic::ladder::{self, Ladder};

/// The bumper's two switches.
#[derive(Debug)]
pub struct BumperContacts {
    /// RG9.
    pub left: Pin<'G', 9, Input>,
    /// RG15.
    pub right: Pin<'G', 15, Input>,
}

impl BumperSwitches for BumperContacts {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        Bumpers {
            left: self.left.is_low(),
            right: self.right.is_low(),
        }
    }
}

/// The wheels' drop switches.
#[derive(Debug)]
pub struct DropSwitches {
    /// RD6.
    pub left: Pin<'D', 6, Input>,
    /// RD7.
    pub right: Pin<'D', 7, Input>,
}

impl WheelDropSwitches for DropSwitches {
    const SWITCHES: u8 = 2;

    fn hanging(&mut self) -> WheelDrops {
        WheelDrops {
            left: self.left.is_low(),
            right: self.right.is_low(),
        }
    }
}

/// The switch behind the dust box.
#[derive(Debug)]
pub struct DustBoxSwitch {
    /// RF0.
    pub pin: Pin<'F', 0, Input>,
}

impl DustBox for DustBoxSwitch {
    fn inserted(&mut self) -> Option<bool> {
        Some(self.pin.is_low())
    }
}

/// The line that shows a supply on the contacts.
#[derive(Debug)]
pub struct Adapter {
    /// RB1.
    pub pin: Pin<'B', 1, Input>,
}

impl DockContacts for Adapter {
    fn closed(&mut self) -> bool {
        self.pin.is_high()
    }
}

/// Whether the contacts carry a supply, for the charger.
#[must_use]
pub(super) fn adapter_is_live() -> bool {
    let word = super::off::port(pins::ADAPTER).read();
    pins::ADAPTER.is_active(u32::from(word))
}

/// The three buttons.
#[derive(Debug)]
pub struct ButtonLines {
    any: Pin<'E', 9, Input>,
    ladder: Option<Ladder>,
}

impl ButtonLines {
    /// With the levels of the resistor ladder, if they are calibrated.
    #[must_use]
    pub const fn take(any: Pin<'E', 9, Input>, ladder: Option<Ladder>) -> Self {
        Self { any, ladder }
    }
}

impl Buttons for ButtonLines {
    const COUNT: u8 = ladder::BUTTONS;

    fn down(&mut self) -> u8 {
        ladder::down(
            self.any.is_low(),
            self.ladder.as_ref(),
            converter::count(pins::BUTTON_LADDER),
        )
    }
}

/// The buttons before calibration: any button, without knowing which.
#[must_use]
pub(super) fn raw_buttons() -> ButtonProbe {
    let word = super::off::port(pins::BUTTON_ANY).read();
    ButtonProbe {
        level: converter::count(pins::BUTTON_LADDER),
        pressed: pins::BUTTON_ANY.is_active(u32::from(word)),
    }
}
