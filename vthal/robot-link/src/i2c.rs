//! I2C with the robot as slave. A register says how much waits and how much there is room for, so that nothing has to be filled.

use std::collections::VecDeque;

use crate::clocked::{ClockedHost, TransfersOver};

/// Register of two bytes: how many wait to be read, and for how many there is room; 255 stands for as many or more.
const LENGTHS: u8 = 0;
/// Register of the stream: what is written goes to the robot, what is read comes from it.
const STREAM: u8 = 1;
/// Bytes of one transfer: at 100 kHz 12 ms.
const TRANSFER: usize = 128;

/// The bus, with the slave chosen.
pub trait I2cBus {
    /// Why it does not work.
    type Error;

    /// Writes the number of a register, then reads it after a repeated start.
    ///
    /// # Errors
    /// The slave does not answer, or the bus does not work.
    fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), Self::Error>;

    /// Writes the number of a register and these bytes, in one transfer.
    ///
    /// # Errors
    /// The slave does not take them, or the bus does not work.
    fn write(&mut self, register: u8, bytes: &[u8]) -> Result<(), Self::Error>;
}

/// The host's side of the link.
#[derive(Clone, Debug, Default)]
pub struct I2cHost {
    to_robot: VecDeque<u8>,
}

impl I2cHost {
    /// Bytes of one transfer.
    pub const TRANSFER_MAX: usize = TRANSFER;
}

impl ClockedHost for I2cHost {
    fn send(&mut self, bytes: &[u8]) {
        self.to_robot.extend(bytes);
    }

    fn waiting(&self) -> usize {
        self.to_robot.len()
    }
}

impl<B: I2cBus> TransfersOver<B> for I2cHost {
    type Error = B::Error;

    /// Asks how much there is, fetches it, and brings what there is room for.
    fn transfer(&mut self, bus: &mut B, heard: &mut Vec<u8>) -> Result<bool, B::Error> {
        let mut lengths = [0; 2];
        bus.read(LENGTHS, &mut lengths)?;
        let [waiting, room] = lengths.map(|length| usize::from(length).min(TRANSFER));
        // A bus without a slave reads as ones: both registers at once are never at their end.
        let is_floating = lengths == [0xFF, 0xFF];
        if is_floating {
            return Ok(false);
        }
        if waiting > 0 {
            let mut bytes = [0; TRANSFER];
            let read = bytes.get_mut(..waiting).unwrap_or_default();
            bus.read(STREAM, read)?;
            heard.extend_from_slice(read);
        }
        let count = self.to_robot.len().min(room);
        if count > 0 {
            let bytes: Vec<u8> = self.to_robot.iter().take(count).copied().collect();
            bus.write(STREAM, &bytes)?;
            self.to_robot.drain(..count);
        }
        Ok(waiting > 0 || count > 0)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::convert::Infallible;

    use super::{ClockedHost as _, I2cBus, I2cHost, LENGTHS, STREAM, TransfersOver as _};

    #[derive(Default)]
    struct Slave {
        says: VecDeque<u8>,
        heard: Vec<u8>,
        room: usize,
    }

    impl I2cBus for Slave {
        type Error = Infallible;

        fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), Infallible> {
            match register {
                LENGTHS => bytes.copy_from_slice(&[self.says.len().min(255) as u8, self.room.min(254) as u8]),
                STREAM => bytes.fill_with(|| self.says.pop_front().expect("announced")),
                other => panic!("no register {other}"),
            }
            Ok(())
        }

        fn write(&mut self, register: u8, bytes: &[u8]) -> Result<(), Infallible> {
            assert_eq!(register, STREAM);
            assert!(bytes.len() <= self.room, "more than there is room for");
            self.heard.extend_from_slice(bytes);
            Ok(())
        }
    }

    #[test]
    fn what_waits_is_fetched_and_what_has_room_is_brought() {
        let said: Vec<u8> = (0..=255).cycle().take(700).collect();
        let mut slave = Slave {
            says: said.iter().copied().collect(),
            heard: Vec::new(),
            room: 10,
        };
        let mut host = I2cHost::default();
        host.send(&said);
        let mut heard = Vec::new();
        while host.transfer(&mut slave, &mut heard) == Ok(true) {}
        assert_eq!(heard, said);
        assert_eq!(slave.heard, said);
        assert_eq!(host.waiting(), 0);
    }

    #[test]
    fn a_bus_without_a_slave_says_nothing() {
        struct Pulled;
        impl I2cBus for Pulled {
            type Error = Infallible;
            fn read(&mut self, _: u8, bytes: &mut [u8]) -> Result<(), Infallible> {
                bytes.fill(0xFF);
                Ok(())
            }
            fn write(&mut self, _: u8, _: &[u8]) -> Result<(), Infallible> {
                panic!("nobody takes it");
            }
        }
        let mut host = I2cHost::default();
        host.send(b"x");
        let mut heard = Vec::new();
        assert_eq!(host.transfer(&mut Pulled, &mut heard), Ok(false));
        assert!(heard.is_empty());
    }
}
