//! Comparators 1 and 2 and their reference voltage (sections 5 and 6 of the peripherals).
//!
//! A comparator is high while its first input is above its second one. It works in Sleep and wakes the processor.
//!
//! `unverified`: the response of 150 to 400 ns, the 10 us after a change of settings, an offset of up to 25 mV. There is no
//! hysteresis.

use crate::gpio::{Analog, Pin};
use crate::interrupt::Source;
use crate::register::map::{CVRCON, comparator_control};

const ON: u32 = 1 << 15;
const INVERTED: u32 = 1 << 13;
const HIGH: u32 = 1 << 8;
const EVENT_SHIFT: u32 = 6;
const REFERENCE_AS_PLUS: u32 = 1 << 4;
const LOW_RANGE: u32 = 1 << 5;
const STEPS: u32 = 15;

/// Comparator `NUMBER`, 1 or 2, off.
#[derive(Debug)]
pub struct Comparator<const NUMBER: u8>(());

/// What can be the first input: the pin CxIN+, or the reference.
pub trait PlusInput<const COMPARATOR: u8> {
    /// CREF.
    #[doc(hidden)]
    const BITS: u32;
}

/// What can be the second input: the pin CxIN-, the pin CxIN+, that of the other comparator, or the internal 1.2 V.
pub trait MinusInput<const COMPARATOR: u8> {
    /// CCH.
    #[doc(hidden)]
    const BITS: u32;
}

/// The voltage of [`VoltageReference`] as first input.
#[derive(Clone, Copy, Debug)]
pub struct Reference;

/// The internal 1.2 V as second input; it is nominal.
#[derive(Clone, Copy, Debug)]
pub struct Internal;

impl<const COMPARATOR: u8> PlusInput<COMPARATOR> for Reference {
    const BITS: u32 = REFERENCE_AS_PLUS;
}

impl<const COMPARATOR: u8> MinusInput<COMPARATOR> for Internal {
    const BITS: u32 = 3;
}

macro_rules! inputs {
    ($($comparator:literal $plus:literal $minus:literal $other:literal;)*) => {
        $(impl PlusInput<$comparator> for Pin<'B', $plus, Analog> {
            const BITS: u32 = 0;
        }
        impl MinusInput<$comparator> for Pin<'B', $minus, Analog> {
            const BITS: u32 = 0;
        }
        impl MinusInput<$comparator> for Pin<'B', $plus, Analog> {
            const BITS: u32 = 1;
        }
        impl MinusInput<$comparator> for Pin<'B', $other, Analog> {
            const BITS: u32 = 2;
        })*
    };
}

// IN+, IN-, and the other one's IN+.
inputs! {
    1 5 4 3;
    2 3 2 5;
}

/// Which changes of the output ask for an interrupt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Event {
    /// None.
    None = 0,
    /// From low to high.
    Rise = 1,
    /// From high to low.
    Fall = 2,
    /// Both.
    Both = 3,
}

/// Whether the output is turned over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// High while the first input is above.
    Plain,
    /// High while the first input is below.
    Inverted,
}

impl<const NUMBER: u8> Comparator<NUMBER> {
    /// Its source of interrupts.
    pub const SOURCE: Source = match NUMBER {
        1 => Source::Comparator1,
        2 => Source::Comparator2,
        _ => panic!("comparators are 1 and 2"),
    };

    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Starts to compare. Wait 10 us and clear [`Self::SOURCE`] before you enable it.
    pub fn start<P: PlusInput<NUMBER>, M: MinusInput<NUMBER>>(
        self,
        inputs: (P, M),
        sense: Sense,
        event: Event,
    ) -> Comparing<NUMBER, (P, M)> {
        let sense = match sense {
            Sense::Plain => 0,
            Sense::Inverted => INVERTED,
        };
        let control = sense | P::BITS | M::BITS | (event as u32) << EVENT_SHIFT;
        comparator_control(NUMBER).write(control);
        comparator_control(NUMBER).set(ON);
        Comparing {
            comparator: self,
            inputs,
        }
    }
}

/// A comparator that works.
#[derive(Debug)]
pub struct Comparing<const NUMBER: u8, I> {
    comparator: Comparator<NUMBER>,
    inputs: I,
}

impl<const NUMBER: u8, I> Comparing<NUMBER, I> {
    /// Its output.
    #[must_use]
    pub fn is_high(&self) -> bool {
        comparator_control(NUMBER).has(HIGH)
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (Comparator<NUMBER>, I) {
        comparator_control(NUMBER).write(0);
        (self.comparator, self.inputs)
    }
}

/// The range of the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// From 0 to 15/24 of the supply.
    Low,
    /// From 8/32 to 23/32 of the supply, in finer steps.
    High,
}

/// The reference voltage of the comparators, made of the supply.
#[derive(Debug)]
pub struct VoltageReference(());

impl VoltageReference {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Turns it on at a step, 0 to 15; higher ones count as 15. It settles within 10 us.
    pub fn set(&mut self, range: Range, step: u8) {
        let range = match range {
            Range::Low => LOW_RANGE,
            Range::High => 0,
        };
        CVRCON.write(ON | range | u32::from(step).min(STEPS));
    }

    /// Turns it off, which saves the current of its resistors.
    pub fn stop(&mut self) {
        CVRCON.write(0);
    }

    /// What a step is, in millivolts of a supply in millivolts.
    #[must_use]
    pub const fn millivolts(range: Range, step: u8, supply_mv: u32) -> u32 {
        let step = if step > 15 { 15 } else { step as u32 };
        match range {
            Range::Low => supply_mv * step / 24,
            Range::High => supply_mv / 4 + supply_mv * step / 32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Comparator, Event, Internal, Range, Reference, Sense, VoltageReference};
    use crate::gpio::Pins;
    use crate::register::map::{CVRCON, comparator_control};

    #[test]
    fn comparators_set_their_bits() {
        let pins = Pins::new();
        let (rb3, rb4, rb5) = (
            pins.rb3.into_analog(),
            pins.rb4.into_analog(),
            pins.rb5.into_analog(),
        );
        let first = Comparator::<1>::new().start((rb5, rb4), Sense::Plain, Event::Both);
        assert_eq!(comparator_control(1).read(), 1 << 15 | 3 << 6);
        comparator_control(1).set(1 << 8);
        assert!(first.is_high());
        let (first, (rb5, _)) = first.release();
        assert_eq!(comparator_control(1).read(), 0);
        let first = first.start((Reference, rb3), Sense::Inverted, Event::Rise);
        assert_eq!(
            comparator_control(1).read(),
            1 << 15 | 1 << 13 | 1 << 6 | 1 << 4 | 2
        );
        let (first, (_, rb3)) = first.release();
        let _first = first.start((Reference, rb5), Sense::Plain, Event::Fall);
        assert_eq!(comparator_control(1).read(), 1 << 15 | 2 << 6 | 1 << 4 | 1);
        let second = Comparator::<2>::new().start((rb3, Internal), Sense::Plain, Event::None);
        assert_eq!(comparator_control(2).read(), 1 << 15 | 3);
        assert!(!second.is_high());
    }

    /// The table of section 6 for 3.3 V.
    #[test]
    fn steps_are_those_of_the_table() {
        for (range, step, millivolts) in [
            (Range::Low, 0, 0),
            (Range::Low, 1, 137),
            (Range::Low, 15, 2_062),
            (Range::High, 0, 825),
            (Range::High, 1, 928),
            (Range::High, 15, 2_371),
            (Range::High, 99, 2_371),
        ] {
            assert_eq!(VoltageReference::millivolts(range, step, 3_300), millivolts);
        }
        let mut reference = VoltageReference::new();
        reference.set(Range::Low, 9);
        assert_eq!(CVRCON.read(), 1 << 15 | 1 << 5 | 9);
        reference.set(Range::High, 200);
        assert_eq!(CVRCON.read(), 1 << 15 | 15);
        reference.stop();
        assert_eq!(CVRCON.read(), 0);
    }
}
