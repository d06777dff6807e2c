//! Cycles of four clocks on two wires, and the scans that are made of them.

use crate::error::IcspError;
use crate::pins::{IcspPins, LineLevel};

/// How often a transfer is repeated while the core has not asked for it, at least.
const POLLS_MIN: u32 = 40;
/// And for how long: a page of flash needs up to 40 ms.
const WAIT_US_MAX: u64 = 300_000;

/// The wires of the chip's test access port, which programming mode opens.
#[derive(Debug)]
pub struct TestPort<'a, P> {
    pub(crate) pins: &'a mut P,
}

impl<'a, P: IcspPins> TestPort<'a, P> {
    /// The port behind these wires, untouched.
    pub fn new(pins: &'a mut P) -> Self {
        Self { pins }
    }

    fn clock(&mut self) -> Result<(), IcspError<P::Error>> {
        self.pins.set_clock(LineLevel::High).map_err(IcspError::Pins)?;
        self.pins.set_clock(LineLevel::Low).map_err(IcspError::Pins)
    }

    fn put(&mut self, high: bool) -> Result<(), IcspError<P::Error>> {
        self.pins
            .drive_data(LineLevel::of(high))
            .map_err(IcspError::Pins)?;
        self.clock()
    }

    /// A bit of the key, which is sent before cycles of four clocks begin.
    pub(crate) fn key_bit(&mut self, high: bool) -> Result<(), IcspError<P::Error>> {
        self.put(high)
    }

    /// One cycle of TCK; gives TDO after it. The chip drives the data line from the end of the third clock to the end of the
    /// fourth.
    ///
    /// # Errors
    /// When a line cannot be set or read.
    pub fn cycle(&mut self, [tdi, tms]: [bool; 2]) -> Result<bool, IcspError<P::Error>> {
        self.put(tdi)?;
        self.put(tms)?;
        self.pins.release_data().map_err(IcspError::Pins)?;
        self.clock()?;
        self.pins.set_clock(LineLevel::High).map_err(IcspError::Pins)?;
        let tdo = self.pins.read_data().map_err(IcspError::Pins)?;
        self.pins.set_clock(LineLevel::Low).map_err(IcspError::Pins)?;
        Ok(tdo.is_high())
    }

    fn modes(&mut self, levels: &[u8]) -> Result<bool, IcspError<P::Error>> {
        let mut tdo = false;
        for level in levels {
            tdo = self.cycle([false, *level == 1])?;
        }
        Ok(tdo)
    }

    /// Through Test-Logic-Reset to Run-Test/Idle.
    pub(crate) fn reset(&mut self) -> Result<(), IcspError<P::Error>> {
        self.modes(&[1, 1, 1, 1, 1, 0]).map(|_| ())
    }

    /// Five cycles that end in Test-Logic-Reset: before programming mode is left.
    pub(crate) fn rest(&mut self) -> Result<(), IcspError<P::Error>> {
        self.modes(&[1, 1, 1, 1, 1]).map(|_| ())
    }

    /// Selects an instruction of five bits.
    pub(crate) fn instruction(&mut self, instruction: u8) -> Result<(), IcspError<P::Error>> {
        self.modes(&[1, 1, 0, 0])?;
        for bit in 0..5 {
            self.cycle([instruction >> bit & 1 == 1, bit == 4])?;
        }
        self.modes(&[1, 0]).map(|_| ())
    }

    /// Shifts `length` bits out of and into the selected register, least significant first. The first bit comes with the cycle that
    /// enters the shift.
    fn shift(&mut self, bits: u64, length: u32) -> Result<u64, IcspError<P::Error>> {
        let mut found = u64::from(self.modes(&[1, 0, 0])?);
        for bit in 0..length {
            let tdo = self.cycle([bits >> bit & 1 == 1, bit + 1 == length])?;
            if bit + 1 < length {
                found |= u64::from(tdo) << (bit + 1);
            }
        }
        self.modes(&[1, 0])?;
        Ok(found)
    }

    pub(crate) fn byte(&mut self, byte: u8) -> Result<u8, IcspError<P::Error>> {
        Ok(self.shift(u64::from(byte), 8)? as u8)
    }

    pub(crate) fn word(&mut self, word: u32) -> Result<u32, IcspError<P::Error>> {
        Ok(self.shift(u64::from(word), 32)? as u32)
    }

    /// Gives a word to the core and takes one from it, as soon as it asks. `None` when it does not.
    pub(crate) fn fast(&mut self, word: u32) -> Result<Option<u32>, IcspError<P::Error>> {
        let begun = self.pins.now_us();
        let mut polls = 0;
        loop {
            let is_late = self.pins.now_us().saturating_sub(begun) > WAIT_US_MAX;
            let found = self.shift(u64::from(word) << 1, 33)?;
            if found & 1 == 1 {
                return Ok(Some((found >> 1) as u32));
            }
            polls += 1;
            // A host that slept may be late at the first look: it looks again.
            if is_late && polls >= POLLS_MIN {
                return Ok(None);
            }
        }
    }
}
