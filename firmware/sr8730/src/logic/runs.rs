//! Queue of the link's sending interrupt: levels and times, one word each, computed in the main loop.
//!
//! A word holds the period of Timer4 in its lower half and, in its upper half, the distance of the register that makes
//! the pin low or high from the port's latch. The interrupt stores one word to each of two registers and is over, forty
//! cycles after it came: the less it does, the less it shifts what is sent and the edges of what is received.

use core::sync::atomic::{AtomicU32, Ordering};

use soft_uart::{Due, Level, Transmitter};

/// Words that wait: 4.4 ms of the densest bytes at 230,400 baud.
pub const RUNS: usize = 1_024;
/// Most runs of one byte.
const RUNS_PER_BYTE: usize = 10;
/// Distances from LATx to the registers that clear and set its bits.
const CLEAR: u32 = 4;
const SET: u32 = 8;

/// Words for the interrupt, which is written in assembly and relies on the order of the fields.
#[derive(Debug)]
#[repr(C)]
pub struct RunRing {
    /// Pushed so far; written by the main program.
    head: AtomicU32,
    /// Taken so far; written by the interrupt.
    tail: AtomicU32,
    /// Not 0 while Timer4 runs; set by the main program, cleared by the interrupt when there is nothing more.
    sending: AtomicU32,
    runs: [AtomicU32; RUNS],
}

/// The word for a level of this many counts.
#[must_use]
pub const fn word(level: Level, counts: u32) -> u32 {
    let register = match level {
        Level::Low => CLEAR,
        Level::High => SET,
    };
    let counts = if counts > 0x1_0000 { 0x1_0000 } else { counts };
    register << 16 | (counts.saturating_sub(1) & 0xFFFF)
}

impl RunRing {
    /// Empty.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            head: AtomicU32::new(0),
            tail: AtomicU32::new(0),
            sending: AtomicU32::new(0),
            runs: [const { AtomicU32::new(0) }; RUNS],
        }
    }

    /// Adds the runs of as many of `bytes` as are sure to fit, and returns the number of bytes. Called by the main
    /// program only.
    pub fn push(&self, transmitter: &mut Transmitter, bytes: &[u8]) -> usize {
        let mut head = self.head.load(Ordering::Relaxed);
        let waiting = head.wrapping_sub(self.tail.load(Ordering::Acquire)) as usize;
        let room = RUNS.saturating_sub(waiting) / RUNS_PER_BYTE;
        let mut taken = 0;
        for byte in bytes.iter().take(room) {
            let mut next = Some(*byte);
            loop {
                transmitter.prepare(|| next.take());
                let Due::Run { level, counts } = transmitter.due() else {
                    break;
                };
                if let Some(place) = self.runs.get(head as usize % RUNS) {
                    place.store(word(level, counts), Ordering::Relaxed);
                }
                head = head.wrapping_add(1);
            }
            taken += 1;
        }
        self.head.store(head, Ordering::Release);
        taken
    }

    /// Whether nothing waits and nothing is being sent.
    #[must_use]
    pub fn is_quiet(&self) -> bool {
        self.is_empty() && self.sending.load(Ordering::Relaxed) == 0
    }

    /// Whether nothing waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.head.load(Ordering::Relaxed) == self.tail.load(Ordering::Acquire)
    }

    /// If something waits and Timer4 does not run, notes that it runs; the caller must then start it. Called with
    /// interrupts off.
    #[must_use]
    pub fn must_start(&self) -> bool {
        let must = !self.is_empty() && self.sending.load(Ordering::Relaxed) == 0;
        if must {
            self.sending.store(1, Ordering::Relaxed);
        }
        must
    }

    /// The oldest word, as the interrupt takes it.
    #[must_use]
    pub fn take(&self) -> Option<u32> {
        let tail = self.tail.load(Ordering::Relaxed);
        if self.head.load(Ordering::Acquire) == tail {
            self.sending.store(0, Ordering::Relaxed);
            return None;
        }
        self.tail.store(tail.wrapping_add(1), Ordering::Release);
        self.runs
            .get(tail as usize % RUNS)
            .map(|run| run.load(Ordering::Relaxed))
    }
}

impl Default for RunRing {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{RUNS, RunRing, word};
    use soft_uart::{Baud, BitTime, Decoder, Edge, Level, Received, Transmitter};
    use std::vec::Vec;

    const HZ: u32 = 40_000_000;

    fn transmitter(baud: Baud) -> Transmitter {
        Transmitter::new(BitTime::new(baud, HZ))
    }

    /// What a receiver of this rate hears of all words in the ring.
    fn heard(ring: &RunRing, baud: Baud) -> Vec<Received> {
        let mut decoder = Decoder::new(BitTime::new(baud, HZ));
        let mut received = Vec::new();
        let mut sink = |event| received.push(event);
        let (mut at, mut before) = (1_000, Level::High);
        while let Some(word) = ring.take() {
            let level = if word >> 16 == 4 { Level::Low } else { Level::High };
            if level != before {
                decoder.edge(Edge { at, level }, &mut sink);
                before = level;
            }
            at += (word & 0xFFFF) + 1;
        }
        decoder.poll(at, &mut sink);
        received
    }

    #[test]
    fn every_byte_arrives_at_every_rate() {
        for baud in Baud::ALL {
            let ring = RunRing::new();
            let mut transmitter = transmitter(baud);
            let mut sent = Vec::new();
            let mut received = Vec::new();
            for byte in 0..=255_u8 {
                assert_eq!(ring.push(&mut transmitter, &[byte]), 1);
                sent.push(Received::Byte(byte));
                if byte % 64 == 63 {
                    received.extend(heard(&ring, baud));
                }
            }
            assert_eq!(received, sent, "{baud:?}");
        }
    }

    #[test]
    fn only_whole_bytes_that_fit_are_taken() {
        let ring = RunRing::new();
        let mut transmitter = transmitter(Baud::B230400);
        // U has the most runs, ten.
        assert_eq!(ring.push(&mut transmitter, &[b'U'; 200]), RUNS / 10);
        assert_eq!(ring.push(&mut transmitter, b"U"), 0);
        for _ in 0..8 {
            assert!(ring.take().is_some());
        }
        assert_eq!(ring.push(&mut transmitter, b"UU"), 1);
        let expected = std::vec![Received::Byte(b'U'); 102];
        let received = heard(&ring, Baud::B230400);
        assert_eq!(
            received[1..],
            expected[..101],
            "the first one has lost its beginning"
        );
    }

    #[test]
    fn the_timer_is_started_once_for_each_time_it_stops() {
        let ring = RunRing::new();
        let mut transmitter = transmitter(Baud::B9600);
        assert!(!ring.must_start());
        ring.push(&mut transmitter, b"a");
        assert!(ring.must_start());
        assert!(!ring.must_start());
        while ring.take().is_some() {}
        assert!(ring.is_quiet());
        ring.push(&mut transmitter, b"b");
        assert!(ring.must_start());
    }

    #[test]
    fn the_slowest_run_fits_into_sixteen_bits() {
        let ring = RunRing::new();
        ring.push(&mut transmitter(Baud::B9600), &[0]);
        let longest = core::iter::from_fn(|| ring.take())
            .map(|word| word & 0xFFFF)
            .max();
        assert_eq!(longest, Some(9 * HZ / 9_600 - 1));
        assert_eq!(word(Level::Low, 70_000), 0x0004_FFFF);
    }
}
