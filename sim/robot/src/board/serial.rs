//! The board's serial port, between the wire and the firmware.

use std::collections::VecDeque;

use cordlib::board::{Link, Received};

/// Bytes the receive queue holds, as on a microcontroller whose interrupt handler fills a ring.
const RECEIVE_QUEUE: usize = 256;
/// Bytes the transmit queue holds.
const TRANSMIT_QUEUE: usize = 512;

/// Receive and transmit queues.
#[derive(Clone, Debug, Default)]
pub struct SerialPort {
    received: VecDeque<Received>,
    overrun: bool,
    transmit: VecDeque<u8>,
    fresh: usize,
}

impl SerialPort {
    /// Takes one frame from the wire.
    pub(crate) fn arrive(&mut self, frame: Received) {
        if self.received.len() < RECEIVE_QUEUE {
            self.received.push_back(frame);
        } else {
            self.overrun = true;
        }
    }

    /// The next byte for the wire.
    pub(crate) fn depart(&mut self) -> Option<u8> {
        let byte = self.transmit.pop_front();
        self.fresh = self.fresh.min(self.transmit.len());
        byte
    }

    /// The bytes that the firmware has sent since the last call and that have not left yet.
    pub(crate) fn said(&mut self) -> impl Iterator<Item = u8> + '_ {
        let from = self.transmit.len() - core::mem::take(&mut self.fresh);
        self.transmit.range(from..).copied()
    }
}

impl Link for SerialPort {
    fn receive(&mut self) -> Option<Received> {
        if let Some(frame) = self.received.pop_front() {
            return Some(frame);
        }
        core::mem::take(&mut self.overrun).then_some(Received::Overrun)
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(TRANSMIT_QUEUE - self.transmit.len());
        self.transmit.extend(&bytes[..taken]);
        self.fresh += taken;
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::{RECEIVE_QUEUE, SerialPort, TRANSMIT_QUEUE};
    use cordlib::board::{Link, Received};

    #[test]
    fn a_full_receive_queue_tells_that_bytes_were_lost() {
        let mut port = SerialPort::default();
        for _ in 0..=RECEIVE_QUEUE {
            port.arrive(Received::Byte(b'x'));
        }
        let frames: Vec<_> = core::iter::from_fn(|| port.receive()).collect();
        assert_eq!(frames.len(), RECEIVE_QUEUE + 1);
        assert_eq!(frames.last(), Some(&Received::Overrun));
    }

    #[test]
    fn transmit_takes_what_fits_and_is_overheard_once() {
        let mut port = SerialPort::default();
        assert_eq!(port.transmit(b"ab"), 2);
        assert_eq!(port.said().collect::<Vec<_>>(), b"ab");
        assert_eq!(port.transmit(&[b'c'; TRANSMIT_QUEUE]), TRANSMIT_QUEUE - 2);
        assert_eq!(port.said().count(), TRANSMIT_QUEUE - 2);
        assert_eq!(port.said().count(), 0);
        assert_eq!(port.depart(), Some(b'a'));
    }
}
