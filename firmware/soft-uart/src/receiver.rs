//! A decoder that finds the rate of the other side, and finds it again.

use crate::baud::{Baud, BitTime};
use crate::decoder::{Decoder, Received};
use crate::edge::Edge;
use crate::meter::RateMeter;

/// What a framing error or a break adds to the doubt, and what a good byte takes away.
const DOUBT_ERROR: u8 = 3;
const DOUBT_BYTE: u8 = 1;
/// From here on the rate is doubtful: four errors with hardly a good byte between them.
const DOUBTFUL: u8 = 12;
/// From here on another rate that was seen is taken: two errors with at most two good bytes between them.
const DOUBT_SWITCH: u8 = 4;
const DOUBT_MAX: u8 = 24;
/// Good bytes after which another rate that was seen is forgotten.
const CANDIDATE_BYTES: u8 = 32;

/// How much the receiver believes in its rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateTrust {
    /// No rate is known; nothing but `U` is understood.
    Listening,
    /// Bytes arrive well.
    Locked(Baud),
    /// Many bytes lately had no stop bit. They are still decoded, because a rate that worked is never given up for noise.
    Doubtful(Baud),
}

/// Bytes from edges, at a rate that is measured or given.
///
/// It listens for `U` all the time. The rate of a `U` is taken at once
/// * when no rate is known,
/// * when it is faster than the present one: nine pulses in a row that are all shorter than a bit cannot be data,
/// * when it is slower, and bytes without stop bit came lately.
///
/// A slower `U` without such bytes is only remembered, since data may look like it, and is taken when they come. After a
/// change the rate before is remembered in the same way, so that noise cannot lead away for good.
#[derive(Clone, Debug)]
pub struct Receiver {
    counts_per_second: u32,
    meter: RateMeter,
    current: Option<(Baud, Decoder)>,
    candidate: Option<Candidate>,
    doubt: u8,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    baud: Baud,
    good_bytes: u8,
}

impl Receiver {
    /// A receiver that does not know the rate. Edges are stamped with a counter of so many counts a second.
    #[must_use]
    pub fn automatic(counts_per_second: u32) -> Self {
        Self {
            counts_per_second,
            meter: RateMeter::new(counts_per_second),
            current: None,
            candidate: None,
            doubt: 0,
        }
    }

    /// A receiver that begins with a rate, and still follows a `U`.
    #[must_use]
    pub fn starting_at(baud: Baud, counts_per_second: u32) -> Self {
        let mut receiver = Self::automatic(counts_per_second);
        receiver.switch(baud);
        receiver
    }

    /// The rate at which the other side speaks, and should be spoken to. Look again after each [`Self::edge`] and
    /// [`Self::poll`].
    #[must_use]
    pub fn rate(&self) -> Option<Baud> {
        self.current.as_ref().map(|(baud, _)| *baud)
    }

    /// How much that rate is believed.
    #[must_use]
    pub fn trust(&self) -> RateTrust {
        match self.rate() {
            None => RateTrust::Listening,
            Some(baud) if self.doubt >= DOUBTFUL => RateTrust::Doubtful(baud),
            Some(baud) => RateTrust::Locked(baud),
        }
    }

    /// Takes the next edge. A byte that ends before it goes to `sink`. The `U` from which a rate is learnt does not.
    #[inline(always)]
    pub fn edge(&mut self, edge: Edge, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_edge(edge) {
            sink(received);
        }
    }

    /// Tells the time, after every edge before `now` was given; see [`Decoder::poll`].
    #[inline(always)]
    pub fn poll(&mut self, now: u32, sink: &mut impl FnMut(Received)) {
        if let Some(received) = self.take_time(now) {
            sink(received);
        }
    }

    /// Tells that edges were lost. It says nothing about the rate.
    #[inline(always)]
    pub fn overrun(&mut self, sink: &mut impl FnMut(Received)) {
        self.forget();
        sink(Received::Overrun);
    }

    // What follows is compiled here, with this crate's optimisation, and not in the program that calls it.

    fn take_edge(&mut self, edge: Edge) -> Option<Received> {
        let received = match &mut self.current {
            Some((_, decoder)) => decoder.take_edge(edge),
            None => None,
        };
        if received.is_some() {
            self.judge(received);
        }
        if let Some(baud) = self.meter.edge(edge) {
            self.consider(baud);
        }
        received
    }

    fn take_time(&mut self, now: u32) -> Option<Received> {
        let received = match &mut self.current {
            Some((_, decoder)) => decoder.take_time(now),
            None => None,
        };
        self.judge(received);
        received
    }

    fn forget(&mut self) {
        self.meter.restart();
        if let Some((_, decoder)) = &mut self.current {
            decoder.forget();
        }
    }

    fn judge(&mut self, received: Option<Received>) {
        match received {
            None | Some(Received::Overrun) => {}
            Some(Received::Byte(_)) => {
                self.doubt = self.doubt.saturating_sub(DOUBT_BYTE);
                self.candidate = self.candidate.and_then(Candidate::after_good_byte);
            }
            // At a sixth of the rate or less, a low bit or two is a break.
            Some(Received::FramingError | Received::Break) => {
                self.doubt = (self.doubt + DOUBT_ERROR).min(DOUBT_MAX);
                if let Some(candidate) = self.candidate
                    && self.doubt >= DOUBT_SWITCH
                {
                    self.switch(candidate.baud);
                }
            }
        }
    }

    #[cold]
    fn consider(&mut self, baud: Baud) {
        let Some(present) = self.rate() else {
            self.switch(baud);
            return;
        };
        if baud == present {
            return;
        }
        if baud > present || self.doubt > 0 {
            self.switch(baud);
        } else {
            self.candidate = Some(Candidate { baud, good_bytes: 0 });
        }
    }

    fn switch(&mut self, baud: Baud) {
        self.candidate = self.rate().map(|baud| Candidate { baud, good_bytes: 0 });
        self.current = Some((baud, Decoder::new(BitTime::new(baud, self.counts_per_second))));
        self.doubt = 0;
    }
}

impl Candidate {
    fn after_good_byte(self) -> Option<Self> {
        let good_bytes = self.good_bytes + 1;
        (good_bytes < CANDIDATE_BYTES).then_some(Self { good_bytes, ..self })
    }
}
