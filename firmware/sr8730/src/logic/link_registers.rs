//! The two registers by which a host on I2C reaches the link: how much waits, and the stream.

/// Register of two bytes: how many bytes wait to be read, and for how many there is room.
const LENGTHS: u8 = 0;
/// Register of the stream.
const STREAM: u8 = 1;
/// The largest number of bytes that wait or find room as the host is told; both at 255 would be a bus without a robot.
const LENGTH_MAX: usize = 254;

/// Where the host is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Place {
    /// It has named no register.
    #[default]
    None,
    /// It will name one.
    Named,
    /// How much waits comes next.
    Waiting,
    /// For how much there is room comes next.
    Room,
    /// Both were told.
    PastLengths,
    /// The stream.
    Stream,
}

/// What the host gets for its next byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The number of bytes that wait.
    Waiting,
    /// The number of bytes that find room.
    Room,
    /// The next byte of the stream.
    Stream,
    /// Nothing is there.
    Nothing,
}

/// Which register the host is in.
#[derive(Clone, Debug, Default)]
pub struct LinkRegisters {
    place: Place,
}

impl LinkRegisters {
    /// No register.
    #[must_use]
    pub const fn new() -> Self {
        Self { place: Place::None }
    }

    /// The host begins to write.
    pub const fn begin(&mut self) {
        self.place = Place::Named;
    }

    /// A byte came; gives it if it belongs to the stream.
    pub const fn receive(&mut self, byte: u8) -> Option<u8> {
        match self.place {
            Place::Named => {
                self.place = match byte {
                    LENGTHS => Place::Waiting,
                    STREAM => Place::Stream,
                    _ => Place::None,
                };
                None
            }
            Place::Stream => Some(byte),
            Place::None | Place::Waiting | Place::Room | Place::PastLengths => None,
        }
    }

    /// The host wants a byte.
    pub const fn want(&mut self) -> Wanted {
        match self.place {
            Place::Waiting => {
                self.place = Place::Room;
                Wanted::Waiting
            }
            Place::Room => {
                self.place = Place::PastLengths;
                Wanted::Room
            }
            Place::Stream => Wanted::Stream,
            Place::None | Place::Named | Place::PastLengths => Wanted::Nothing,
        }
    }
}

/// A number of bytes as the host is told it.
#[must_use]
pub fn told(bytes: usize) -> u8 {
    bytes.min(LENGTH_MAX) as u8
}

#[cfg(test)]
mod tests {
    use super::{LinkRegisters, Wanted, told};

    #[test]
    fn lengths_come_once_and_the_stream_for_as_long_as_the_host_reads() {
        let mut registers = LinkRegisters::new();
        assert_eq!(registers.want(), Wanted::Nothing, "no register was named");
        registers.begin();
        assert_eq!(registers.receive(0), None);
        assert_eq!(
            [registers.want(), registers.want(), registers.want()],
            [Wanted::Waiting, Wanted::Room, Wanted::Nothing]
        );
        registers.begin();
        assert_eq!(registers.receive(1), None);
        assert_eq!([registers.want(), registers.want()], [Wanted::Stream; 2]);
    }

    #[test]
    fn only_what_is_written_into_the_stream_belongs_to_it() {
        let mut registers = LinkRegisters::new();
        assert_eq!(registers.receive(1), None, "before a beginning");
        registers.begin();
        assert_eq!([registers.receive(1), registers.receive(0)], [None, Some(0)]);
        assert_eq!(registers.receive(1), Some(1));
        for other in [0, 2, 255] {
            registers.begin();
            assert_eq!(
                [registers.receive(other), registers.receive(9)],
                [None, None],
                "{other}"
            );
        }
    }

    #[test]
    fn no_number_looks_like_a_bus_without_a_robot() {
        assert_eq!([told(0), told(254), told(255), told(9_999)], [0, 254, 254, 254]);
    }
}
