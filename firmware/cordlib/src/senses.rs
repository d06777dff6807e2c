//! One look at the board's inputs, taken at the start of every pass.

use rvac_protocol::message::{Bumpers, Cliffs, Currents, Gyro, WheelDrops};
use rvac_units::Tick;

use crate::board::{
    Board, BumperSwitches, Buttons, Clock, CurrentSense, DockContacts, Encoders, HeadingSensor, Parts,
    WheelCounts, WheelDropSwitches,
};
use crate::floor::FloorWatch;

/// Inputs of one pass. Contacts are raw; the rules debounce them, each in its own way.
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
    pub(crate) buttons: u8,
    pub(crate) gyro: Option<Gyro>,
    pub(crate) currents: Option<Currents>,
}

impl Senses {
    /// Reads everything the rules need.
    pub(crate) fn read<P: Parts>(board: &mut Board<P>, floor: &mut FloorWatch) -> Self {
        let now = board.clock.tick();
        floor.update(&mut board.cliffs, now);
        Self {
            now,
            counts: board.encoders.counts(),
            bumpers: board.bumpers.pressed(),
            no_floor: floor.no_floor(),
            blinded: floor.blinded(),
            wheel_drops: board.wheel_drops.hanging(),
            docked: board.dock_contacts.closed(),
            buttons: board.buttons.down(),
            gyro: board.gyro.heading(),
            currents: board.currents.currents(),
        }
    }
}
