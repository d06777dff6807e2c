//! The receiving half of a UART, one sample per bit.

/// What the receiver's hardware reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReceivedByte {
    /// A byte with a right stop bit.
    Byte(u8),
    /// A byte whose stop bit was wrong; its content is not to be used.
    FramingError,
    /// Bytes were lost in the receiver.
    Overrun,
}

/// A receiver for 8N1: a start bit (low), eight data bits, lowest first, a stop bit (high). After a framing error it waits
/// for a high line before it looks for the next start.
#[derive(Clone, Debug, Default)]
pub struct UartReceiver {
    state: UartState,
    shift: u8,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum UartState {
    #[default]
    Idle,
    Data(u8),
    Stop,
    WaitForHigh,
}

impl UartReceiver {
    /// Whether the receiver waits for a start bit.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.state == UartState::Idle
    }

    /// Takes the level of the line during one bit.
    #[inline]
    pub fn bit(&mut self, high: bool) -> Option<ReceivedByte> {
        match self.state {
            UartState::Idle => {
                if !high {
                    self.state = UartState::Data(0);
                }
                None
            }
            UartState::Data(count) => {
                self.shift = self.shift >> 1 | u8::from(high) << 7;
                self.state = if count == 7 {
                    UartState::Stop
                } else {
                    UartState::Data(count + 1)
                };
                None
            }
            UartState::Stop if high => {
                self.state = UartState::Idle;
                Some(ReceivedByte::Byte(self.shift))
            }
            UartState::Stop => {
                self.state = UartState::WaitForHigh;
                Some(ReceivedByte::FramingError)
            }
            UartState::WaitForHigh => {
                if high {
                    self.state = UartState::Idle;
                }
                None
            }
        }
    }
}

/// The ten levels of one byte on the line, in their order from bit 0 of the result.
#[must_use]
pub(crate) const fn line_bits(byte: u8) -> u16 {
    (byte as u16) << 1 | 1 << 9
}

#[cfg(test)]
mod tests {
    use super::{ReceivedByte, UartReceiver, line_bits};

    fn receive(levels: impl IntoIterator<Item = bool>) -> Vec<ReceivedByte> {
        let mut receiver = UartReceiver::default();
        levels
            .into_iter()
            .filter_map(|level| receiver.bit(level))
            .collect()
    }

    fn levels(byte: u8) -> impl Iterator<Item = bool> {
        (0..10).map(move |bit| line_bits(byte) >> bit & 1 == 1)
    }

    #[test]
    fn every_byte_comes_through_back_to_back() {
        let received = receive((0..=255).flat_map(levels));
        let expected: Vec<_> = (0..=255).map(ReceivedByte::Byte).collect();
        assert_eq!(received, expected);
    }

    #[test]
    fn a_low_stop_bit_is_a_framing_error_and_the_next_byte_is_whole_again() {
        let broken = levels(b'a').take(9).chain([false, true]);
        assert_eq!(
            receive(broken.chain(levels(b'b'))),
            [ReceivedByte::FramingError, ReceivedByte::Byte(b'b')]
        );
    }

    #[test]
    fn a_missed_start_bit_makes_another_byte() {
        let slipped = receive(
            levels(0b1111_0000)
                .enumerate()
                .map(|(index, level)| level || index == 0),
        );
        assert_eq!(slipped, []);
        let slipped = receive(
            levels(0b1111_0000)
                .enumerate()
                .map(|(index, level)| level || index == 0)
                .chain([true; 9]),
        );
        assert_ne!(slipped, [ReceivedByte::Byte(0b1111_0000)]);
        assert_eq!(slipped.len(), 1);
    }
}
