//! The ADC by DMA: one channel, sample after sample.

use super::transfer::{Driver, LengthError, Plan, Side, Start, Transfer, sealed};
use super::uart::register;
use super::{Channel, WriteBuffer};
use crate::adc::{Results, Scanner};
use crate::interrupt::Source;
use crate::register::map::adc_buffer;

/// What ends the sampling of each result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleTrigger {
    /// The sampling time of [`crate::adc::Timing`]: one result follows the other.
    Continuous,
    /// Each end of a period of timer 3, which is to run. The period must be longer than a conversion.
    Timer3,
}

/// The ADC while a channel takes its results.
#[derive(Debug)]
pub struct Sampler {
    /// Starts scans.
    pub scanner: Scanner,
    /// Reads their results.
    pub results: Results,
}

impl sealed::Sealed for Sampler {}
impl Driver for Sampler {
    fn has_failed(&self) -> bool {
        false
    }

    fn end(&mut self) {
        self.scanner.end_samples();
    }
}

impl Scanner {
    /// Puts sample after sample of one input, AN0 to AN15, into a buffer: 0 to 1023 each, 64 of them at most. A scan that is under
    /// way is broken off.
    ///
    /// # Errors
    /// [`LengthError`] when the buffer is empty or has more than 256 bytes.
    pub fn sample_by_dma<const NUMBER: u8, B: WriteBuffer<Element = u32>>(
        self,
        results: Results,
        (channel, buffer): (Channel<NUMBER>, B),
        (input, trigger): (u8, SampleTrigger),
    ) -> Result<Transfer<NUMBER, Sampler, B>, LengthError<(Channel<NUMBER>, Sampler, B)>> {
        let mut sampler = Sampler {
            scanner: self,
            results,
        };
        let lent = buffer.lend();
        if let Err(error) = LengthError::check(lent.bytes(), ()) {
            // SAFETY: lent above, and no channel was started.
            let buffer = unsafe { B::reclaim(lent) };
            return Err(LengthError {
                bytes: error.bytes,
                parts: (channel, sampler, buffer),
            });
        }
        Source::Adc.disable();
        sampler
            .scanner
            .prepare_samples(input, trigger == SampleTrigger::Timer3);
        let width = size_of::<u32>();
        let plan = Plan {
            source: register(adc_buffer(0), width),
            destination: Side::of(&lent),
            cell_bytes: width,
            start: Start::Each(Source::Adc),
            until: None,
            repeats: false,
        };
        let mut transfer = Transfer::begin((channel, sampler), lent, &plan);
        transfer.driver_mut().scanner.begin_samples();
        Ok(transfer)
    }
}

#[cfg(test)]
mod tests {
    use super::SampleTrigger;
    use crate::adc::{Adc, Timing};
    use crate::dma::tests::{alone, end_block};
    use crate::dma::{Channel, StaticBuffer};
    use crate::register::map::{
        AD1CHS, AD1CON1, AD1CON2, dma_cell_size, dma_destination_size, dma_event, dma_source, dma_source_size,
    };

    #[test]
    fn each_result_of_one_input_is_a_cell() {
        static SAMPLES: StaticBuffer<u32, 64> = StaticBuffer::new([0; 64]);
        let _alone = alone();
        let timing = Timing {
            clock_divider: 15,
            sample_clocks: 31,
        };
        let mut samples = SAMPLES.take().expect("the first time");
        let mut channel = Channel::<2>::new();
        let (mut scanner, mut results) = Adc::new().start(timing);
        for (trigger, code) in [(SampleTrigger::Continuous, 7), (SampleTrigger::Timer3, 2)] {
            let sampling = scanner
                .sample_by_dma(results, (channel, samples), (5, trigger))
                .expect("256 bytes");
            assert_eq!(
                AD1CON1.read(),
                1 << 15 | code << 5 | 1 << 2,
                "on, automatic, going on"
            );
            assert_eq!((AD1CON2.read(), AD1CHS.read()), (0, 5 << 16));
            assert_eq!(dma_source(2).read(), 0x1F80_9070);
            let sizes = [dma_source_size(2), dma_destination_size(2), dma_cell_size(2)];
            assert_eq!(sizes.map(|size| size.read()), [4, 0, 4]);
            assert_eq!(dma_event(2).read(), 33 << 8 | 1 << 4);
            end_block(2, 1 << 3);
            let finished = sampling.wait();
            assert_eq!(finished.moved, 64);
            assert_eq!(AD1CON1.read(), 1 << 15 | 7 << 5 | 1 << 4, "as scans want it");
            (channel, samples) = (finished.channel, finished.buffer);
            (scanner, results) = (finished.driver.scanner, finished.driver.results);
        }
    }
}
