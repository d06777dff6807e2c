//! The ADC: ten bits, sixteen channels, scans of several in one go (section 13).
//!
//! A scan samples the chosen channels one after the other, lowest number first, then asks for service once and stops
//! (CLRASAM). So all results belong to one moment and none is overwritten while it is read.
//!
//! Full scale 1023 is AVDD.

use crate::gpio::AnalogPin;
use crate::interrupt::Source;
use crate::register::map::{AD1CHS, AD1CON1, AD1CON2, AD1CON3, AD1CSSL, adc_buffer};

const ON: u32 = 1 << 15;
const CLRASAM: u32 = 1 << 4;
const ASAM: u32 = 1 << 2;
/// The end of sampling starts the conversion.
const AUTO_CONVERT: u32 = 7 << 5;
/// Timer 3 ends sampling.
const TIMER_CONVERT: u32 = 2 << 5;
const SCAN: u32 = 1 << 10;
const SMPI_SHIFT: u32 = 2;
const CHANNEL_SHIFT: u32 = 16;
/// Clocks of the ADC in a conversion.
const CONVERSION: u32 = 12;

/// A set of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channels(u16);

impl Channels {
    /// No channel.
    pub const NONE: Self = Self(0);

    /// Channels by bits: bit 2 is AN2.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// These channels and one more, AN0 to AN15.
    #[must_use]
    pub const fn with(self, channel: u8) -> Self {
        Self(self.0 | (1 << (channel & 15)))
    }

    /// These channels and that of a pin.
    #[must_use]
    pub fn with_pin<P: AnalogPin>(self, _pin: &P) -> Self {
        self.with(P::CHANNEL)
    }

    /// How many.
    #[must_use]
    pub const fn len(self) -> u32 {
        self.0.count_ones()
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Index of a channel's result among those of a scan, or `None` when it is not in the set.
    #[must_use]
    pub const fn position(self, channel: u8) -> Option<u8> {
        let bit = 1_u16 << (channel & 15);
        if self.0 & bit == 0 {
            return None;
        }
        Some((self.0 & (bit - 1)).count_ones() as u8)
    }
}

/// How fast it works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// A clock of the ADC (TAD) is 2 x (this + 1) peripheral clocks and at least 65 ns: 2 or more at 80 MHz.
    pub clock_divider: u8,
    /// Clocks for sampling, 1 to 31: the higher the source's resistance, the more.
    pub sample_clocks: u8,
}

impl Timing {
    /// Peripheral clocks that a scan of so many channels lasts.
    #[must_use]
    pub const fn scan_clocks(self, channels: u32) -> u32 {
        let clock = 2 * (self.clock_divider as u32 + 1);
        channels * clock * (self.sample_clocks as u32 + CONVERSION)
    }
}

/// The ADC, off.
#[derive(Debug)]
pub struct Adc(());

impl Adc {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Turns it on. It gives two parts: one starts scans, the other reads them, so that the tick can own the one and the
    /// handler of [`crate::interrupt::vector::ADC`] the other.
    #[must_use]
    pub fn start(self, timing: Timing) -> (Scanner, Results) {
        AD1CON1.write(0);
        AD1CON3.write((u32::from(timing.sample_clocks.clamp(1, 31)) << 8) | u32::from(timing.clock_divider));
        AD1CHS.write(0);
        Source::Adc.clear();
        AD1CON1.write(ON | AUTO_CONVERT | CLRASAM);
        (Scanner(()), Results(()))
    }
}

/// Starts scans.
#[derive(Debug)]
pub struct Scanner(());

impl Scanner {
    /// Starts one scan of these channels. Nothing happens for an empty set, or while a scan is under way: `false`.
    pub fn start(&mut self, channels: Channels) -> bool {
        if channels.is_empty() || self.is_busy() {
            return false;
        }
        // A change of the sequence is taken over while it is off only.
        AD1CON1.clear(ON);
        AD1CSSL.write(u32::from(channels.0));
        AD1CON2.write(SCAN | ((channels.len() - 1) << SMPI_SHIFT));
        self.go();
        true
    }

    /// Starts one conversion of one channel; as [`Self::start`].
    pub fn start_single(&mut self, channel: u8) -> bool {
        if self.is_busy() {
            return false;
        }
        AD1CON1.clear(ON);
        AD1CHS.write(u32::from(channel & 15) << CHANNEL_SHIFT);
        AD1CON2.write(0);
        self.go();
        true
    }

    /// Before sample after sample of one input is converted, each with a request of its own.
    pub(crate) fn prepare_samples(&mut self, input: u8, by_timer: bool) {
        let trigger = if by_timer { TIMER_CONVERT } else { AUTO_CONVERT };
        AD1CON1.write(trigger);
        AD1CHS.write(u32::from(input & 15) << CHANNEL_SHIFT);
        AD1CON2.write(0);
        Source::Adc.clear();
    }

    pub(crate) fn begin_samples(&mut self) {
        AD1CON1.set(ON);
        AD1CON1.set(ASAM);
    }

    /// As [`Adc::start`] leaves it.
    pub(crate) fn end_samples(&mut self) {
        AD1CON1.write(0);
        Source::Adc.clear();
        AD1CON1.write(ON | AUTO_CONVERT | CLRASAM);
    }

    fn go(&mut self) {
        Source::Adc.clear();
        AD1CON1.set(ON);
        AD1CON1.set(ASAM);
    }

    /// Whether a scan is under way: the chip clears the bit that keeps it sampling at the end.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        AD1CON1.has(ASAM)
    }

    /// Converts one channel and waits for it: some microseconds. `None` when a scan is under way, or when the ADC does not
    /// answer within 100,000 reads of its status.
    pub fn read(&mut self, results: &Results, channel: u8) -> Option<u16> {
        const LOOKS_MAX: u32 = 100_000;
        if !self.start_single(channel) {
            return None;
        }
        let done = (0..LOOKS_MAX).any(|_| !self.is_busy());
        Source::Adc.clear();
        done.then(|| results.get(0))
    }
}

/// Reads the results of the last scan.
#[derive(Debug)]
pub struct Results(());

impl Results {
    /// The result at a position of the scan, see [`Channels::position`]: 0 to 1023.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, position: u8) -> u16 {
        adc_buffer(position).read() as u16 & 0x3FF
    }

    /// Copies the results of a scan, lowest channel first, and returns how many: as many as there are channels, places and
    /// buffers (16).
    pub fn copy(&self, channels: Channels, results: &mut [u16]) -> usize {
        let count = results.len().min(channels.len() as usize);
        for (position, result) in (0_u8..).zip(results.iter_mut().take(count)) {
            *result = self.get(position);
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::{Channels, Timing};

    #[test]
    fn results_stand_in_the_order_of_channels() {
        let channels = Channels::NONE.with(12).with(0).with(3);
        let positions = [0, 3, 12].map(|channel| channels.position(channel));
        assert_eq!(positions, [Some(0), Some(1), Some(2)]);
        assert_eq!(channels.position(4), None);
        assert_eq!(channels.len(), 3);
    }

    #[test]
    fn a_scan_lasts_its_samples_and_conversions() {
        // 400 ns clocks: (31 + 12) x 400 ns = 17.2 us = 1376 clocks of 80 MHz for each channel.
        let timing = Timing {
            clock_divider: 15,
            sample_clocks: 31,
        };
        assert_eq!(timing.scan_clocks(10), 13_760);
    }
}
