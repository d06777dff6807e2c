//! The master: one word an access.

use super::{
    ActiveLevel, AddressLines, BusWord, DataPins, EACH_ACCESS, ON, ParallelPort, READ_HIGH, READ_STROBE,
    WRITE_HIGH, WRITE_STROBE,
};
use crate::gpio::{Output, Pin};
use crate::register::map::{PMADDR, PMAEN, PMCON, PMDIN, PMMODE};
use core::marker::PhantomData;

const BUSY: u32 = 1 << 15;
const SEPARATE: u32 = 2 << 8;
const COMBINED: u32 = 3 << 8;
const INCREMENT_SHIFT: u32 = 11;

/// How an access is told to the other side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strobes {
    /// PMRD for reading and PMWR for writing, each with its level: master mode 2.
    Separate {
        /// That of PMRD.
        read: ActiveLevel,
        /// That of PMWR.
        write: ActiveLevel,
    },
    /// PMRD says the direction, with this level for reading, and PMWR is the strobe of both: master mode 1.
    Combined {
        /// The level of PMRD that says reading.
        read: ActiveLevel,
        /// That of the strobe.
        strobe: ActiveLevel,
    },
}

/// Times of an access in clocks of PBCLK, 12.5 ns at 80 MHz. With a strobe of one clock the others count as one, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitClocks {
    /// From address and data to the strobe: 1 to 4.
    pub setup: u8,
    /// The strobe: 1 to 16.
    pub strobe: u8,
    /// From the strobe of a writing to the end of its data: 1 to 4. For a reading it is one less.
    pub hold: u8,
}

impl WaitClocks {
    /// WAITB, WAITM and WAITE; what is out of range counts as the nearest in it.
    fn bits(self) -> u32 {
        let field = |clocks: u8, most: u8| u32::from(clocks.clamp(1, most)) - 1;
        field(self.setup, 4) << 6 | field(self.strobe, 16) << 2 | field(self.hold, 4)
    }
}

/// What the address does after each access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Increment {
    /// It stays.
    None = 0,
    /// One more.
    Up = 1,
    /// One less.
    Down = 2,
}

/// How a master works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MasterSettings {
    /// The strobes.
    pub strobes: Strobes,
    /// The times.
    pub waits: WaitClocks,
    /// The address.
    pub increment: Increment,
}

/// A master of words of one length, `u8` or `u16`. No access lasts longer than 24 clocks of PBCLK.
#[derive(Debug)]
pub struct ParallelMaster<W, P> {
    port: ParallelPort,
    pins: P,
    word: PhantomData<fn(W)>,
}

/// PMRD and PMWR. While the port is off they have the levels that they were given: those at rest.
type StrobePins = (Pin<'D', 5, Output>, Pin<'D', 4, Output>);

impl ParallelPort {
    /// Starts it as master.
    pub fn into_master<W: BusWord, D: DataPins<W>>(
        self,
        (data, strobes): (D, StrobePins),
        lines: AddressLines,
        settings: MasterSettings,
    ) -> ParallelMaster<W, (D, StrobePins)> {
        let (mode, levels) = match settings.strobes {
            Strobes::Separate { read, write } => (SEPARATE, read.bit(READ_HIGH) | write.bit(WRITE_HIGH)),
            Strobes::Combined { read, strobe } => (COMBINED, read.bit(READ_HIGH) | strobe.bit(WRITE_HIGH)),
        };
        let increment = (settings.increment as u32) << INCREMENT_SHIFT;
        PMCON.write(0);
        PMMODE.write(mode | W::WIDTH | increment | EACH_ACCESS | settings.waits.bits());
        PMADDR.write(0);
        PMAEN.write(lines.pins);
        Self::SOURCE.clear();
        PMCON.write(READ_STROBE | WRITE_STROBE | levels | lines.control);
        PMCON.set(ON);
        ParallelMaster {
            port: self,
            pins: (data, strobes),
            word: PhantomData,
        }
    }
}

impl<W: BusWord, P> ParallelMaster<W, P> {
    /// Whether an access is under way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        PMMODE.has(BUSY)
    }

    fn settle(&self) {
        while self.is_busy() {}
    }

    /// The address of the next access; bits 14 and 15 are the selects, where there are any.
    pub fn set_address(&mut self, address: u16) {
        self.settle();
        PMADDR.write(u32::from(address));
    }

    /// The address of the next access.
    #[must_use]
    pub fn address(&self) -> u16 {
        self.settle();
        PMADDR.read() as u16
    }

    /// Writes a word. It is on the bus when the next access begins, or [`Self::is_busy`] says so.
    pub fn write(&mut self, word: W) {
        self.settle();
        PMDIN.write(word.to_register());
    }

    /// Writes words one after the other.
    pub fn write_all(&mut self, words: &[W]) {
        for word in words {
            self.write(*word);
        }
    }

    /// Reads a word. One access, and not a second one with the taking of the result: the port is off for that moment.
    pub fn read(&mut self) -> W {
        let mut word = [W::default()];
        self.read_all(&mut word);
        let [word] = word;
        word
    }

    /// Reads words one after the other.
    pub fn read_all(&mut self, words: &mut [W]) {
        let Some((last, others)) = words.split_last_mut() else {
            return;
        };
        self.settle();
        // What the register has now is old; reading it starts the first access.
        let _ = PMDIN.read();
        for word in others {
            self.settle();
            *word = W::from_register(PMDIN.read());
        }
        self.settle();
        PMCON.clear(ON);
        *last = W::from_register(PMDIN.read());
        PMCON.set(ON);
    }

    /// Stops it and gives the parts back, except the address lines.
    #[must_use]
    pub fn release(self) -> (ParallelPort, P) {
        self.settle();
        ParallelPort::SOURCE.disable();
        PMCON.write(0);
        PMAEN.write(0);
        (self.port, self.pins)
    }
}

#[cfg(test)]
mod tests {
    use super::{Increment, MasterSettings, Strobes, WaitClocks};
    use crate::gpio::{Level, Pins};
    use crate::parallel_port::tests::{alone, data_8, data_16};
    use crate::parallel_port::{ActiveLevel, AddressLines, ParallelPort};
    use crate::register::map::{PMADDR, PMAEN, PMCON, PMDIN, PMMODE};

    #[test]
    fn waits_are_one_less_in_their_fields() {
        for (setup, strobe, hold, bits) in [
            (1, 1, 1, 0),
            (4, 16, 4, 3 << 6 | 15 << 2 | 3),
            (2, 8, 3, 1 << 6 | 7 << 2 | 2),
            (0, 0, 0, 0),
            (9, 99, 9, 3 << 6 | 15 << 2 | 3),
        ] {
            assert_eq!(WaitClocks { setup, strobe, hold }.bits(), bits);
        }
    }

    #[test]
    fn a_master_sets_its_bits_and_moves_words() {
        let _alone = alone();
        let mut pins = Pins::new();
        let (data, rest) = data_8(pins);
        pins = rest;
        let strobes = (
            pins.rd5.into_output(Level::High),
            pins.rd4.into_output(Level::High),
        );
        let lines = AddressLines::none()
            .with(pins.rb15.into_output(Level::Low))
            .with(pins.rb10.into_output(Level::Low))
            .with_select_2(pins.rd10.into_output(Level::High), ActiveLevel::Low)
            .with_select_1(pins.rd11.into_output(Level::Low), ActiveLevel::High);
        let waits = WaitClocks {
            setup: 2,
            strobe: 3,
            hold: 1,
        };
        let strobe_levels = Strobes::Separate {
            read: ActiveLevel::Low,
            write: ActiveLevel::High,
        };
        let settings = MasterSettings {
            strobes: strobe_levels,
            waits,
            increment: Increment::Up,
        };
        let mut master = ParallelPort::new().into_master::<u8, _>((data, strobes), lines, settings);
        assert_eq!(PMMODE.read(), 1 << 13 | 1 << 11 | 2 << 8 | 1 << 6 | 2 << 2);
        assert_eq!(PMCON.read(), 1 << 15 | 1 << 9 | 1 << 8 | 2 << 6 | 1 << 3 | 1 << 1);
        assert_eq!(PMAEN.read(), 3 << 14 | 1 << 13 | 1);
        master.set_address(0xC005);
        assert_eq!((PMADDR.read(), master.address()), (0xC005, 0xC005));
        master.write_all(&[1, 2, 0x5A]);
        assert_eq!(PMDIN.read(), 0x5A);
        assert_eq!(master.read(), 0x5A);
        let mut words = [0; 3];
        master.read_all(&mut words);
        assert_eq!(words, [0x5A; 3]);
        assert_eq!(PMCON.read() & 1 << 15, 1 << 15, "on again");
        PMMODE.set(1 << 15);
        assert!(master.is_busy());
        PMMODE.clear(1 << 15);
        let (_, (_, strobes)) = master.release();
        assert_eq!((PMCON.read(), PMAEN.read()), (0, 0));

        let (data, _) = data_16(Pins::new());
        let settings = MasterSettings {
            strobes: Strobes::Combined {
                read: ActiveLevel::High,
                strobe: ActiveLevel::Low,
            },
            increment: Increment::Down,
            ..settings
        };
        let lines =
            AddressLines::none().with_select_2(Pins::new().rd10.into_output(Level::High), ActiveLevel::High);
        let mut master = ParallelPort::new().into_master::<u16, _>((data, strobes), lines, settings);
        assert_eq!(
            PMMODE.read(),
            1 << 13 | 2 << 11 | 1 << 10 | 3 << 8 | 1 << 6 | 2 << 2
        );
        assert_eq!(PMCON.read(), 1 << 15 | 1 << 9 | 1 << 8 | 1 << 6 | 1 << 4 | 1);
        assert_eq!(PMAEN.read(), 1 << 15);
        master.write(0xBEEF);
        assert_eq!(master.read(), 0xBEEF);
        let _ = master.release();
    }
}
