//! The main loop.

use rvac_protocol::message::Inhibits;

use crate::board::{Board, Parts};
use crate::parameters::Parameters;

/// The firmware of one robot: everything between the parts of the board and the wire.
#[derive(Debug)]
pub struct Cord<P: Parts> {
    board: Board<P>,
    parameters: Parameters,
}

impl<P: Parts> Cord<P> {
    /// Takes the board over. All motors are switched off, motion is inhibited until the host arms.
    #[must_use]
    pub fn new(board: Board<P>, parameters: Parameters) -> Self {
        let mut cord = Self { board, parameters };
        cord.board.all_off();
        cord
    }

    /// One pass of the main loop. Call it as often as the board can, at least once a millisecond where rules with
    /// reaction times of 20 ms are to hold with margin; a simulator calls it once for each simulated millisecond.
    pub fn step(&mut self) {}

    /// A hardware fault was found (clock monitor, memory check, a trap that returned): everything off, latched as
    /// `internal`.
    pub fn hardware_fault(&mut self) {
        self.board.all_off();
    }

    /// The board, for example to put simulated readings into its parts between two steps.
    pub const fn board(&self) -> &Board<P> {
        &self.board
    }

    /// As [`Self::board`], to change it.
    pub const fn board_mut(&mut self) -> &mut Board<P> {
        &mut self.board
    }

    /// The parameters.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Everything that keeps the robot from moving now.
    #[must_use]
    pub fn inhibits(&self) -> Inhibits {
        Inhibits::NONE
    }

    /// Whether the host has armed motion.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        false
    }

    /// Whether a lease (or a `move` with a living link) covers wheel motion now.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        false
    }
}
