//! The CRC unit.
//!
//! `unverified`: that each byte enters with its highest bit first, and that nothing is reflected. Try your polynomial with a known vector first.

use super::transfer::{Driver, LengthError, Plan, Side, Start, Transfer, sealed};
use super::{Channel, ReadBuffer};
use crate::register::map::{DCRCCON, DCRCDATA, DCRCXOR};
use core::sync::atomic::AtomicU8;

const ENABLED: u32 = 1 << 7;
const LENGTH_SHIFT: u32 = 8;

/// Where the bytes go that are only to be summed up.
static NOWHERE: AtomicU8 = AtomicU8::new(0);

/// The CRC unit.
#[derive(Debug)]
pub struct CrcUnit(());

/// A kind of CRC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrcSettings {
    /// Its taps without the highest: 0x1021 for that of XMODEM. The chip takes the lowest one for set.
    pub polynomial: u16,
    /// Bits of the result, 1 to 16.
    pub bits: u8,
    /// What it begins with.
    pub initial: u16,
}

/// Settings that the unit cannot have: its results have 1 to 16 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrcError {
    /// Bits that were asked for.
    pub bits: u8,
}

impl CrcUnit {
    pub(super) const fn new() -> Self {
        Self(())
    }

    /// Begins a message.
    ///
    /// # Errors
    /// [`CrcError`]
    pub fn begin(&mut self, settings: CrcSettings) -> Result<(), CrcError> {
        let CrcSettings {
            polynomial,
            bits,
            initial,
        } = settings;
        if !(1..=16).contains(&bits) {
            return Err(CrcError { bits });
        }
        DCRCCON.write(0);
        DCRCDATA.write(u32::from(initial));
        DCRCXOR.write(u32::from(polynomial));
        DCRCCON.write((u32::from(bits) - 1) << LENGTH_SHIFT);
        Ok(())
    }

    /// The result of all that was fed since [`Self::begin`].
    #[must_use]
    pub fn result(&self) -> u16 {
        DCRCDATA.read() as u16
    }
}

impl sealed::Sealed for CrcUnit {}
impl Driver for CrcUnit {
    fn has_failed(&self) -> bool {
        false
    }

    fn end(&mut self) {
        DCRCCON.clear(ENABLED | 3);
    }
}

impl<const NUMBER: u8> Channel<NUMBER> {
    /// Feeds the CRC unit with memory, in RAM or flash.
    ///
    /// # Errors
    /// [`LengthError`] when it is empty or longer than 256 bytes.
    pub fn feed_crc<R: ReadBuffer>(
        self,
        unit: CrcUnit,
        data: R,
    ) -> Result<Transfer<NUMBER, CrcUnit, R>, LengthError<(Self, CrcUnit, R)>> {
        let lent = data.lend();
        let checked = LengthError::check(lent.bytes(), (self, unit, lent));
        let (channel, unit, lent) = checked.map_err(|error| {
            let (channel, unit, lent) = error.parts;
            LengthError {
                bytes: error.bytes,
                // SAFETY: lent above, and no channel was started.
                parts: (channel, unit, unsafe { R::reclaim(lent) }),
            }
        })?;
        let nowhere = NOWHERE.as_ptr().expose_provenance() as u32 & 0x1FFF_FFFF;
        let plan = Plan {
            source: Side::of(&lent),
            destination: Side {
                address: nowhere,
                bytes: 1,
            },
            cell_bytes: lent.bytes(),
            start: Start::Program,
            until: None,
            repeats: false,
        };
        DCRCCON.set(ENABLED | u32::from(NUMBER));
        Ok(Transfer::begin((channel, unit), lent, &plan))
    }
}

#[cfg(test)]
mod tests {
    use super::{CrcError, CrcSettings, CrcUnit};
    use crate::dma::Channel;
    use crate::dma::tests::{alone, end_block};
    use crate::register::map::{DCRCCON, DCRCDATA, DCRCXOR, dma_destination_size, dma_source_size};

    #[test]
    fn the_unit_sets_its_bits_and_listens_to_the_channel_that_feeds_it() {
        let _alone = alone();
        let mut unit = CrcUnit::new();
        let settings = CrcSettings {
            polynomial: 0x1021,
            bits: 16,
            initial: 0xFFFF,
        };
        for bits in [0, 17] {
            assert_eq!(
                unit.begin(CrcSettings { bits, ..settings }),
                Err(CrcError { bits })
            );
        }
        assert_eq!(unit.begin(settings), Ok(()));
        assert_eq!(
            [DCRCCON, DCRCDATA, DCRCXOR].map(|register| register.read()),
            [0xF00, 0xFFFF, 0x1021]
        );
        let feeding = Channel::<3>::new().feed_crc(unit, b"123456789").expect("9 bytes");
        assert_eq!(DCRCCON.read(), 0xF83);
        assert_eq!(
            (dma_source_size(3).read(), dma_destination_size(3).read()),
            (9, 1)
        );
        DCRCDATA.write(0x29B1);
        end_block(3, 1 << 3);
        let finished = feeding.wait();
        assert_eq!((finished.moved, finished.driver.result()), (9, 0x29B1));
        assert_eq!(
            DCRCCON.read(),
            0xF00,
            "it listens to nobody, and keeps its length"
        );
        let error = finished.channel.feed_crc(finished.driver, [0_u8; 0].as_slice());
        assert_eq!(error.expect_err("nothing to feed").bytes, 0);
    }
}
