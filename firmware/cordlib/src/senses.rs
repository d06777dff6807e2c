//! All inputs of the board, read once at the start of every pass.

use rvac_protocol::message::{Bumpers, Capabilities, Cliffs, Currents, Gyro, WheelDrops};
use rvac_units::Tick;

use crate::board::{
    Board, BumperSwitches, Buttons, Clock, CurrentSense, DockContacts, Encoders, HeadingSensor, Parts,
    WheelCounts, WheelDropSwitches,
};
use crate::floor::FloorWatch;

/// Inputs of one pass. Contacts are raw: each rule debounces them with its own times.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Senses {
    pub(crate) now: Tick,
    pub(crate) counts: WheelCounts,
    pub(crate) bumpers: Bumpers,
    /// Sensors that see no floor (S8), blinded ones included.
    pub(crate) no_floor: Cliffs,
    /// Sensors that failed their self-test (S9).
    pub(crate) blinded: Cliffs,
    pub(crate) wheel_drops: WheelDrops,
    pub(crate) docked: bool,
    /// Buttons that are down, as far as the board can tell which.
    pub(crate) buttons: u8,
    /// Any button is down, whichever.
    pub(crate) any_button: bool,
    pub(crate) gyro: Option<Gyro>,
    pub(crate) currents: Option<Currents>,
}

impl Senses {
    /// Reads everything the rules need. Parts that are not fitted or not calibrated read as their default.
    pub(crate) fn read<P: Parts>(
        board: &mut Board<P>,
        floor: &mut FloorWatch,
        fitted: &Capabilities,
    ) -> Self {
        let now = board.clock.tick();
        floor.update(&mut board.cliffs, now);
        let known_buttons = match fitted.buttons {
            count @ 0..=7 => (1_u8 << count).wrapping_sub(1),
            _ => u8::MAX,
        };
        Self {
            now,
            counts: board.encoders.counts(),
            bumpers: shown(fitted.bumpers > 0, board.bumpers.pressed()),
            no_floor: floor.no_floor(),
            blinded: floor.blinded(),
            wheel_drops: shown(fitted.wheel_drops > 0, board.wheel_drops.hanging()),
            docked: board.dock_contacts.closed(),
            buttons: board.buttons.down() & known_buttons,
            any_button: board.buttons.any_down(),
            gyro: board.gyro.heading().filter(|_| fitted.gyro),
            currents: board.currents.currents().filter(|_| fitted.currents),
        }
    }
}

/// The reading of a part if it is fitted, else the default.
pub(crate) fn shown<T: Default>(fitted: bool, reading: T) -> T {
    if fitted { reading } else { T::default() }
}
