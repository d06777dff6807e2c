//! One direction of the serial cable, paced in virtual time.

use std::collections::VecDeque;

use rvac_channel::{Channel, FaultRates, ReceivedByte};

/// Bits of a byte on the line: start, eight, stop.
const FRAME_BITS: u32 = 10;
const MS_PER_S: u32 = 1000;
/// Capacity of the sender's driver; while it is full the sender must keep its bytes.
const QUEUE_MAX: usize = 4096;

/// A line that carries `baud / 10` bytes a second and damages them as its rates say.
#[derive(Clone, Debug)]
pub struct SerialLine {
    queue: VecDeque<u8>,
    baud: u32,
    /// Bits that the line could have carried and has not, times 1000 so that a millisecond is a whole number.
    credit: u32,
    /// The line carries nothing for this long; bytes wait.
    held_ms: u32,
    /// The cable is out for this long; bytes are lost.
    cut_ms: u32,
    channel: Channel,
    faulty: bool,
    received: Vec<ReceivedByte>,
}

impl SerialLine {
    /// A line without faults; the damage of later ones follows from `seed`.
    #[must_use]
    pub fn new(baud: u32, seed: u64) -> Self {
        Self {
            queue: VecDeque::new(),
            baud,
            credit: 0,
            held_ms: 0,
            cut_ms: 0,
            channel: Channel::new(seed, FaultRates::NONE),
            faulty: false,
            received: Vec::new(),
        }
    }

    /// Sets the rates of faults from now on.
    pub fn set_rates(&mut self, rates: FaultRates) {
        self.channel.set_rates(rates);
        self.faulty = rates != FaultRates::NONE;
    }

    /// Everything on the line waits for `ms`, then comes as fast as the line carries it.
    pub fn hold(&mut self, ms: u32) {
        self.held_ms = self.held_ms.max(ms);
    }

    /// Everything that is sent within the next `ms` is lost.
    pub fn cut(&mut self, ms: u32) {
        self.cut_ms = self.cut_ms.max(ms);
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn room(&self) -> usize {
        QUEUE_MAX - self.queue.len()
    }

    /// Hands bytes to the sender's driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.room());
        self.queue.extend(&bytes[..taken]);
        taken
    }

    /// Clears the sender's driver: the sender died or its terminal was closed.
    pub fn flush(&mut self) {
        self.queue.clear();
    }

    /// Advances one millisecond and returns the frames that the receiver's hardware reports in it.
    pub fn pass_ms(&mut self) -> &[ReceivedByte] {
        self.received.clear();
        self.cut_ms = self.cut_ms.saturating_sub(1);
        if self.held_ms > 0 {
            self.held_ms -= 1;
            return &self.received;
        }
        if self.queue.is_empty() && !self.faulty {
            self.credit = 0;
            return &self.received;
        }
        self.credit += self.baud;
        while self.credit >= FRAME_BITS * MS_PER_S {
            self.credit -= FRAME_BITS * MS_PER_S;
            self.carry_one();
        }
        &self.received
    }

    fn carry_one(&mut self) {
        match self.queue.pop_front() {
            Some(_) if self.cut_ms > 0 => {}
            Some(byte) if self.faulty => self.channel.pass(byte, &mut self.received),
            Some(byte) => self.received.push(ReceivedByte::Byte(byte)),
            None if self.faulty => self.channel.idle(&mut self.received),
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SerialLine;
    use rvac_channel::{FaultRates, ReceivedByte};

    fn arrivals(line: &mut SerialLine, ms: usize) -> Vec<usize> {
        (0..ms).map(|_| line.pass_ms().len()).collect()
    }

    #[test]
    fn bytes_take_their_time() {
        let mut line = SerialLine::new(38_400, 1);
        assert_eq!(line.send(&[b'x'; 20]), 20);
        assert_eq!(arrivals(&mut line, 7), [3, 4, 4, 4, 4, 1, 0]);
    }

    #[test]
    fn a_held_line_delivers_later_and_a_cut_one_never() {
        let mut line = SerialLine::new(100_000, 1);
        line.hold(3);
        line.send(b"abcde");
        assert_eq!(arrivals(&mut line, 5), [0, 0, 0, 5, 0]);
        line.cut(2);
        line.send(&[b'x'; 15]);
        assert_eq!(arrivals(&mut line, 3), [0, 5, 0]);
    }

    #[test]
    fn the_sender_keeps_what_does_not_fit() {
        let mut line = SerialLine::new(9_600, 1);
        assert_eq!(line.send(&[b'x'; 5000]), 4096);
        assert_eq!(line.room(), 0);
        line.flush();
        assert_eq!(line.room(), 4096);
    }

    #[test]
    fn rates_damage_the_bytes() {
        let mut line = SerialLine::new(230_400, 9);
        line.set_rates(FaultRates {
            lost_byte: 0.5,
            ..FaultRates::NONE
        });
        line.send(&[b'x'; 1000]);
        let arrived: usize = (0..100)
            .map(|_| {
                line.pass_ms()
                    .iter()
                    .filter(|byte| **byte == ReceivedByte::Byte(b'x'))
                    .count()
            })
            .sum();
        assert!((400..600).contains(&arrived), "{arrived} of 1000 arrived");
    }
}
