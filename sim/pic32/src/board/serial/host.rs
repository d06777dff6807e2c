//! The host's receiving side: from the robot's edges to the bytes that the host's driver gives out.

use std::collections::VecDeque;

use rvac_channel::{Channel, FaultRates, ReceivedByte};

use super::receiver::TimedByte;
use super::{BitReceiver, HostRate};
use crate::pins::Level;

/// A UART on the robot's transmit pin, a driver behind it, and the damage between.
#[derive(Clone, Debug)]
pub struct HostPort {
    receiver: BitReceiver,
    arrivals: Vec<TimedByte>,
    channel: Channel,
    faulty: bool,
    held_until: u64,
    cut_until: u64,
    waiting: VecDeque<ReceivedByte>,
    damaged: Vec<ReceivedByte>,
}

impl HostPort {
    /// A port on an idle line; damage follows from `seed`.
    #[must_use]
    pub fn new(rate: HostRate, seed: u64) -> Self {
        Self {
            receiver: BitReceiver::new(rate.bit_cycles()),
            arrivals: Vec::new(),
            channel: Channel::new(seed, FaultRates::NONE),
            faulty: false,
            held_until: 0,
            cut_until: 0,
            waiting: VecDeque::new(),
            damaged: Vec::new(),
        }
    }

    /// Sets how often what goes wrong from now on.
    pub fn set_rates(&mut self, rates: FaultRates) {
        self.channel.set_rates(rates);
        self.faulty = rates != FaultRates::NONE;
    }

    /// What arrives before `cycle` waits for it.
    pub fn hold_until(&mut self, cycle: u64) {
        self.held_until = self.held_until.max(cycle);
    }

    /// What arrives before `cycle` is lost.
    pub fn cut_until(&mut self, cycle: u64) {
        self.cut_until = self.cut_until.max(cycle);
    }

    /// Takes the robot's edges of a millisecond that ends at `end`. Gives what a perfect receiver has heard in it.
    pub fn take(&mut self, edges: &[(u64, Level)], end: u64) -> &[TimedByte] {
        self.arrivals.clear();
        for (cycle, level) in edges {
            self.receiver.edge(*cycle, *level, &mut self.arrivals);
        }
        self.receiver.advance(end, &mut self.arrivals);
        for (_, received) in &self.arrivals {
            match received {
                _ if end <= self.cut_until => {}
                ReceivedByte::Byte(byte) if self.faulty => {
                    self.damaged.clear();
                    self.channel.pass(*byte, &mut self.damaged);
                    self.waiting.extend(&self.damaged);
                }
                other => self.waiting.push_back(*other),
            }
        }
        &self.arrivals
    }

    /// Appends what the host's driver gives out now. A byte with a wrong stop bit is handed over as NUL, and what overran
    /// is dropped.
    pub fn give_out(&mut self, now: u64, to_host: &mut Vec<u8>) {
        if now <= self.held_until {
            return;
        }
        for received in self.waiting.drain(..) {
            match received {
                ReceivedByte::Byte(byte) => to_host.push(byte),
                ReceivedByte::FramingError => to_host.push(0),
                ReceivedByte::Overrun => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{HostPort, HostRate, Level};

    /// The edges of an `x` that begins at `from`, 115,200 bits per second.
    fn letter(from: u64) -> Vec<(u64, Level)> {
        let levels = u16::from(b'x') << 1 | 1 << 9;
        (0..10)
            .map(|bit| {
                let cycle = from + (f64::from(bit) * HostRate::exact(115_200).bit_cycles()) as u64;
                (cycle, Level::of(levels >> bit & 1 == 1))
            })
            .collect()
    }

    #[test]
    fn bytes_come_out_unless_the_cable_is_out_or_slow() {
        let mut port = HostPort::new(HostRate::exact(115_200), 1);
        let mut bytes = Vec::new();
        assert_eq!(port.take(&letter(100), 80_000).len(), 1);
        port.give_out(80_000, &mut bytes);
        assert_eq!(bytes, b"x");
        port.hold_until(160_000);
        port.take(&letter(80_100), 160_000);
        port.give_out(160_000, &mut bytes);
        assert_eq!(bytes, b"x", "still held");
        port.give_out(240_000, &mut bytes);
        assert_eq!(bytes, b"xx");
        port.cut_until(320_000);
        port.take(&letter(240_100), 320_000);
        port.give_out(400_000, &mut bytes);
        assert_eq!(bytes, b"xx", "lost");
    }
}
