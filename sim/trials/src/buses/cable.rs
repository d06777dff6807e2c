//! The cable between a master and the chip, whatever the bus.

use pic32::board::EmulatedRobot;
use pic32::pins::Pin;
use rvac_channel::FaultRates;

use super::noise::{BusNoise, PulseFault};
use super::now;

/// What damages the lines, when they are out, and what the robot said on them.
#[derive(Clone, Debug)]
pub struct Cable {
    noise: Option<BusNoise>,
    /// The times between which it is out, in cycles of the chip.
    out: (u64, u64),
    attention: Pin,
    said: Vec<u8>,
}

impl Cable {
    /// A cable that is in and damages nothing, with this pin for attention.
    pub(super) const fn new(attention: Pin) -> Self {
        Self {
            noise: None,
            out: (0, 0),
            attention,
            said: Vec::new(),
        }
    }

    /// From now on the lines are damaged.
    pub fn make_noisy(&mut self, seed: u64, rates: FaultRates) {
        self.noise = Some(BusNoise::new(seed, rates));
    }

    /// From now on they are not.
    pub fn make_quiet(&mut self) {
        self.noise = None;
    }

    /// The cable is out between these cycles. Without it the lines rest at both ends.
    pub const fn cut(&mut self, from: u64, until: u64) {
        self.out = (from, until);
    }

    /// What the robot has said since the last call, as its pins had it.
    pub fn take_said(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.said)
    }

    /// Whether the robot says that it has something to say.
    #[must_use]
    pub fn is_called(&self, robot: &EmulatedRobot) -> bool {
        !self.is_out(now(robot)) && robot.machine().level(self.attention).is_high()
    }

    pub(super) const fn is_out(&self, cycle: u64) -> bool {
        self.out.0 <= cycle && cycle < self.out.1
    }

    /// The robot has said this.
    pub(super) fn say(&mut self, said: Option<u8>) {
        self.said.extend(said);
    }

    /// The level that arrives.
    pub(super) fn bit(&mut self, level: bool) -> bool {
        self.noise.as_mut().map_or(level, |noise| noise.bit(level))
    }

    /// What happens to the next pulse of the clock.
    pub(super) fn pulse(&mut self) -> PulseFault {
        self.noise.as_mut().map_or(PulseFault::None, BusNoise::pulse)
    }

    /// Whether a spike hits the bit under way.
    pub(super) fn strikes(&mut self) -> bool {
        self.noise.as_mut().is_some_and(BusNoise::strikes)
    }
}
