//! Framed SPI: a pulse on SS before or with the first bit of each word, and a clock that does not stop.

use super::word::SpiWord;
use super::{FRAME_COINCIDES, FRAME_INPUT, Spi};

/// How far a frame is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Frame {
    /// None is under way.
    #[default]
    None,
    /// The pulse came; the first bit comes with the next clock.
    Announced,
    /// Bits are shifted; this side's pulse is still on its pin.
    WithPulse,
    /// Bits are shifted.
    Bits,
}

impl Frame {
    /// Whether a frame master holds its pulse now.
    pub(super) fn is_pulsing(self) -> bool {
        matches!(self, Frame::Announced | Frame::WithPulse)
    }

    pub(super) fn is_under_way(self) -> bool {
        self != Frame::None
    }
}

impl Spi {
    /// The clock's leading edge puts data out.
    pub(super) fn framed_shift(&mut self) {
        self.frame = match self.frame {
            Frame::None => self.announce(),
            Frame::Announced | Frame::WithPulse => Frame::Bits,
            Frame::Bits => Frame::Bits,
        };
        if matches!(self.frame, Frame::Bits | Frame::WithPulse) {
            self.put_next_bit();
        }
    }

    /// A frame master with a word begins a frame.
    fn announce(&mut self) -> Frame {
        if self.has(FRAME_INPUT) || self.waiting.is_none() {
            return Frame::None;
        }
        self.word = Some(self.next_word());
        if self.has(FRAME_COINCIDES) {
            Frame::WithPulse
        } else {
            Frame::Announced
        }
    }

    /// Its trailing edge takes data in.
    pub(super) fn framed_sample(&mut self, input: bool) {
        match self.frame {
            Frame::None if self.has(FRAME_INPUT) && !self.has(FRAME_COINCIDES) && self.is_pulsed() => {
                self.word = Some(self.next_word());
                self.frame = Frame::Announced;
            }
            Frame::Bits | Frame::WithPulse => {
                if let Some(taken) = self.word.as_mut().and_then(|word| word.sample(input)) {
                    self.word = None;
                    self.frame = Frame::None;
                    self.deliver(taken);
                }
            }
            Frame::None | Frame::Announced => {}
        }
    }

    /// The pulse of another side began or ended: with it comes the first bit, if it is to coincide.
    pub(super) fn frame_pulse_changed(&mut self) {
        let begins = self.has(FRAME_INPUT) && self.has(FRAME_COINCIDES) && self.is_pulsed();
        if begins && self.frame == Frame::None {
            self.word = Some(self.next_word());
            // The clock's edge that it comes with may be seen before it or after.
            if self.active {
                self.frame = Frame::Bits;
                self.put_next_bit();
            } else {
                self.frame = Frame::Announced;
            }
        }
    }

    fn put_next_bit(&mut self) {
        let next = self.word.as_mut().and_then(SpiWord::shift);
        self.output = next.unwrap_or(self.output);
    }
}
