//! Which interrupt's handler is called, and when.
//!
//! A request that comes up in one cycle is seen in the next one, and the call begins after the instruction that ends
//! with that cycle: so says the 8052's documentation, and so it is done here. uCsim calls a cycle earlier and charges one
//! cycle for the call instead of two. An instruction that writes an enable or a priority, and RETI, are followed by one
//! more instruction before any call.

/// Number of interrupts.
pub(crate) const SOURCES: usize = 8;

/// What asks for an interrupt, in the order in which equal ones are served.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// P3.2.
    External0,
    /// Overflow of timer 0.
    Timer0,
    /// P3.3.
    External1,
    /// Overflow of timer 1.
    Timer1,
    /// A byte was received or sent.
    Serial,
    /// Overflow of timer 2, or its trigger.
    Timer2,
    /// P4.3.
    External2,
    /// P4.2.
    External3,
}

impl Source {
    /// All in their order.
    pub const ALL: [Source; SOURCES] = [
        Source::External0,
        Source::Timer0,
        Source::External1,
        Source::Timer1,
        Source::Serial,
        Source::Timer2,
        Source::External2,
        Source::External3,
    ];

    /// Where its handler begins.
    #[must_use]
    pub const fn vector(self) -> u16 {
        3 + 8 * self as u16
    }

    /// Its number, as SDCC counts.
    #[must_use]
    pub const fn number(self) -> usize {
        self as usize
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// IE: all of them.
const EA: u8 = 0x80;
/// XICON: enables of the external interrupts 2 and 3.
const EX2: u8 = 0x04;
const EX3: u8 = 0x40;
/// XICON: lower bits of their priority.
const PX2: u8 = 0x08;
const PX3: u8 = 0x80;
/// XICON: bits that are neither flag nor kind of an input.
const XICON_BITS: u8 = EX2 | EX3 | PX2 | PX3;

/// Enables, priorities and what is being served.
#[derive(Clone, Debug)]
pub(super) struct Interrupts {
    pub(super) enables: u8,
    pub(super) priority_low: u8,
    pub(super) priority_high: u8,
    extra: u8,
    /// Bit for each source that asks.
    requests: u8,
    /// When it began to ask.
    since: [u64; SOURCES],
    /// Bit for each of the four levels that is being served.
    served: u8,
    /// One more instruction comes before any call.
    is_held: bool,
}

impl Interrupts {
    pub(super) fn new() -> Self {
        Self {
            enables: 0,
            priority_low: 0,
            priority_high: 0,
            extra: 0,
            requests: 0,
            since: [0; SOURCES],
            served: 0,
            is_held: false,
        }
    }

    /// XICON without its inputs.
    pub(super) fn extra(&self) -> u8 {
        self.extra
    }

    pub(super) fn set_extra(&mut self, xicon: u8) {
        self.extra = xicon & XICON_BITS;
    }

    /// Takes over which sources ask at `cycle`.
    pub(super) fn update(&mut self, requests: u8, cycle: u64) {
        for source in Source::ALL {
            if requests & !self.requests & source.bit() != 0 {
                // Timer 2 sets its flag so early in the cycle that it is still seen in it.
                let head_start = u64::from(source == Source::Timer2);
                self.since[source.number()] = cycle.saturating_sub(head_start);
            }
        }
        self.requests = requests;
    }

    /// Bit for each source that is enabled.
    fn enabled(&self) -> u8 {
        if self.enables & EA == 0 {
            return 0;
        }
        let extra_2 = if self.extra & EX2 != 0 {
            Source::External2.bit()
        } else {
            0
        };
        let extra_3 = if self.extra & EX3 != 0 {
            Source::External3.bit()
        } else {
            0
        };
        self.enables & 0x3F | extra_2 | extra_3
    }

    /// Whether a source is enabled.
    pub(super) fn is_enabled(&self, source: Source) -> bool {
        self.enabled() & source.bit() != 0
    }

    /// Priority level, 0 to 3.
    fn level(&self, source: Source) -> u8 {
        let low = match source {
            Source::External2 => self.extra & PX2 != 0,
            Source::External3 => self.extra & PX3 != 0,
            _ => self.priority_low & source.bit() != 0,
        };
        let high = self.priority_high & source.bit() != 0;
        u8::from(high) << 1 | u8::from(low)
    }

    /// The source whose turn it is by priority and order, if nothing that is being served forbids it.
    fn best(&self, wanted: u8) -> Option<Source> {
        let mut best: Option<Source> = None;
        for source in Source::ALL {
            let beats = best.is_none_or(|other| self.level(source) > self.level(other));
            if wanted & source.bit() != 0 && beats {
                best = Some(source);
            }
        }
        best.filter(|source| self.served >> self.level(*source) == 0)
    }

    /// The earliest cycle in which a call can begin; none when there is nothing to call.
    pub(super) fn next(&self) -> u64 {
        let wanted = self.requests & self.enabled();
        if wanted == 0 {
            return u64::MAX;
        }
        let mut next = u64::MAX;
        for source in Source::ALL {
            let is_free = self.served >> self.level(source) == 0;
            if wanted & source.bit() != 0 && is_free {
                next = next.min(self.since[source.number()] + 1);
            }
        }
        next
    }

    /// Takes the interrupt whose handler is to be called at the end of an instruction at `cycle`.
    pub(super) fn take(&mut self, cycle: u64) -> Option<Source> {
        let seen = |source: &Source| self.since[source.number()] < cycle;
        let seen = Source::ALL
            .iter()
            .filter(|source| seen(source))
            .fold(0, |seen, source| seen | source.bit());
        let source = self.best(self.requests & self.enabled() & seen)?;
        self.served |= 1 << self.level(source);
        Some(source)
    }

    /// RETI.
    pub(super) fn end(&mut self) {
        let highest = self.served.checked_ilog2();
        self.served &= !highest.map_or(0, |level| 1 << level);
        self.is_held = true;
    }

    /// An enable or a priority was written.
    pub(super) fn hold(&mut self) {
        self.is_held = true;
    }

    /// Whether one more instruction comes first; asks only once.
    pub(super) fn take_hold(&mut self) -> bool {
        std::mem::take(&mut self.is_held)
    }

    /// Whether it will say so.
    pub(super) fn is_held(&self) -> bool {
        self.is_held
    }
}

#[cfg(test)]
mod tests {
    use super::{Interrupts, Source};

    /// All enabled, and these ask since cycle 0.
    fn asking(sources: &[Source]) -> Interrupts {
        let mut interrupts = Interrupts::new();
        interrupts.enables = 0xBF;
        interrupts.set_extra(0x44);
        let requests = sources.iter().fold(0, |all, source| all | source.bit());
        interrupts.update(requests, 0);
        interrupts
    }

    #[test]
    fn equal_ones_are_served_in_their_order() {
        let mut interrupts = asking(&Source::ALL);
        assert_eq!(interrupts.take(1), Some(Source::External0));
        interrupts.update(0xFE, 1);
        assert_eq!(interrupts.take(2), None);
        interrupts.end();
        assert_eq!(interrupts.take(3), Some(Source::Timer0));
    }

    #[test]
    fn each_of_four_levels_interrupts_the_ones_below() {
        let mut interrupts = asking(&[Source::External0]);
        interrupts.priority_low = Source::Timer0.bit() | Source::Timer1.bit();
        interrupts.priority_high = Source::External1.bit() | Source::Timer1.bit();
        for source in [
            Source::External0,
            Source::Timer0,
            Source::External1,
            Source::Timer1,
        ] {
            interrupts.update(0x3F, 0);
            let lower = source.bit() | (source.bit() - 1);
            interrupts.update(lower, 0);
            assert_eq!(interrupts.take(9), Some(source));
            assert_eq!(interrupts.take(9), None);
        }
        interrupts.update(Source::Timer2.bit(), 10);
        for _ in 0..3 {
            interrupts.end();
            assert_eq!(interrupts.take(20), None);
        }
        interrupts.end();
        assert_eq!(interrupts.take(20), Some(Source::Timer2));
    }

    #[test]
    fn the_extra_ones_have_their_priority_elsewhere() {
        let mut interrupts = asking(&[Source::External0, Source::External2, Source::External3]);
        interrupts.set_extra(0x44 | 0x80);
        assert_eq!(interrupts.take(1), Some(Source::External3));
        interrupts.priority_high = 0x40;
        assert_eq!(interrupts.take(2), Some(Source::External2));
        assert_eq!(Source::External3.vector(), 0x3B);
    }

    #[test]
    fn a_request_is_seen_a_cycle_later() {
        let mut interrupts = asking(&[]);
        interrupts.update(Source::Serial.bit(), 100);
        assert_eq!(interrupts.next(), 101);
        assert_eq!(interrupts.take(100), None);
        assert_eq!(interrupts.take(101), Some(Source::Serial));
        let mut interrupts = asking(&[]);
        interrupts.update(Source::Timer2.bit(), 100);
        assert_eq!(interrupts.take(100), Some(Source::Timer2));
    }
}
