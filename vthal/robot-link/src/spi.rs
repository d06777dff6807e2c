//! SPI with the host as master: each transfer takes as many bytes as it brings, and those that say nothing are fill.

use std::collections::VecDeque;

use rvac_protocol::fill::{FILL, FillDecoder, encode};

use crate::clocked::{ClockedHost, TransfersOver};

/// Bytes of a transfer when neither side is known to have something: enough to meet the beginning of a packet.
const PEEK: usize = 16;
/// Bytes of one transfer. A slave with a queue of one byte serves each in time; longer ones would only delay the host's own.
const TRANSFER: usize = 128;

/// The bus: both directions at once.
pub trait SpiBus {
    /// Why it does not work.
    type Error;

    /// Sends these bytes, and puts what came meanwhile in their places.
    ///
    /// # Errors
    /// The bus does not work.
    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error>;
}

/// The host's side of the link.
#[derive(Clone, Debug, Default)]
pub struct SpiHost {
    /// For the robot, in the form of this link.
    to_robot: VecDeque<u8>,
    decoder: FillDecoder,
    /// The last transfer brought data to its end, so that more is likely.
    more: bool,
}

impl SpiHost {
    /// Bytes of one transfer.
    pub const TRANSFER_MAX: usize = TRANSFER;
}

impl ClockedHost for SpiHost {
    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.to_robot.extend(encode(*byte));
        }
    }

    fn waiting(&self) -> usize {
        self.to_robot.len()
    }
}

impl<B: SpiBus> TransfersOver<B> for SpiHost {
    type Error = B::Error;

    fn transfer(&mut self, bus: &mut B, heard: &mut Vec<u8>) -> Result<bool, B::Error> {
        let wanted = self
            .to_robot
            .len()
            .max(if self.more { TRANSFER } else { PEEK })
            .min(TRANSFER);
        let mut bytes = [FILL; TRANSFER];
        let transfer = bytes.get_mut(..wanted).unwrap_or_default();
        for (place, byte) in transfer.iter_mut().zip(self.to_robot.iter()) {
            *place = *byte;
        }
        bus.exchange(transfer)?;
        let taken = self.to_robot.len().min(wanted);
        self.to_robot.drain(..taken);
        let before = heard.len();
        self.more = false;
        for byte in transfer.iter() {
            let said = self.decoder.push(*byte);
            self.more = said.is_some();
            heard.extend(said);
        }
        Ok(taken > 0 || heard.len() > before)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::convert::Infallible;

    use proptest::prelude::*;
    use rvac_protocol::fill::{FILL, FillDecoder, encode};

    use super::{ClockedHost as _, SpiBus, SpiHost, TransfersOver as _};

    /// A slave that says `late` bytes of fill before each byte of its own.
    #[derive(Default)]
    struct Slave {
        says: VecDeque<u8>,
        decoder: FillDecoder,
        heard: Vec<u8>,
        late: usize,
        count: usize,
    }

    impl SpiBus for Slave {
        type Error = Infallible;

        fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
            for byte in bytes {
                self.heard.extend(self.decoder.push(*byte));
                self.count += 1;
                let is_late = self.late > 0 && !self.count.is_multiple_of(self.late + 1);
                *byte = if is_late {
                    FILL
                } else {
                    self.says.pop_front().unwrap_or(FILL)
                };
            }
            Ok(())
        }
    }

    proptest! {
        #[test]
        fn all_bytes_arrive_whatever_lies_between(
            down in proptest::collection::vec(any::<u8>(), 0..400),
            up in proptest::collection::vec(any::<u8>(), 0..400),
            late in 0..4_usize,
        ) {
            let mut slave = Slave { late, ..Slave::default() };
            slave.says.extend(up.iter().flat_map(|byte| encode(*byte)));
            let mut host = SpiHost::default();
            host.send(&down);
            let mut heard = Vec::new();
            let mut quiet = 0;
            while quiet < 3 {
                let Ok(any) = host.transfer(&mut slave, &mut heard);
                quiet = if any { 0 } else { quiet + 1 };
            }
            prop_assert_eq!(&slave.heard, &down);
            prop_assert_eq!(&heard, &up);
        }
    }

    #[test]
    fn a_slave_that_is_not_there_says_nothing() {
        struct Open(u8);
        impl SpiBus for Open {
            type Error = Infallible;
            fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
                bytes.fill(self.0);
                Ok(())
            }
        }
        for level in [0x00, 0xFF] {
            let mut heard = Vec::new();
            let Ok(any) = SpiHost::default().transfer(&mut Open(level), &mut heard);
            assert!(!any && heard.is_empty());
        }
    }
}
