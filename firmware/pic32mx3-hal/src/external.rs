//! The external interrupt pins INT0 to INT4: RF6, RE8, RE9, RA14, RA15 (section 5 and 19; the parts with USB have INT0 on
//! RD0). They ask for service at one of the two edges, each through a vector of its own.

use crate::gpio::{Input, Pin};
use crate::interrupt::Source;
use crate::register::map::INTCON;

/// Which edge asks for service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// From low to high.
    Rising,
    /// From high to low.
    Falling,
}

/// An input with an external interrupt.
pub trait ExternalPin {
    /// The number: INT0 to INT4.
    const NUMBER: u8;
    /// Its source.
    const SOURCE: Source;

    /// Chooses the edge and forgets a request that came before. The source still has to be enabled.
    fn select_edge(&mut self, edge: Edge) {
        let bit = 1 << Self::NUMBER;
        match edge {
            Edge::Rising => INTCON.set(bit),
            Edge::Falling => INTCON.clear(bit),
        }
        Self::SOURCE.clear();
    }
}

macro_rules! external {
    ($($external:literal $source:ident $port:literal $number:literal;)*) => {
        $(impl ExternalPin for Pin<$port, $number, Input> {
            const NUMBER: u8 = $external;
            const SOURCE: Source = Source::$source;
        })*
    };
}

external! {
    0 External0 'F' 6;
    1 External1 'E' 8;
    2 External2 'E' 9;
    3 External3 'A' 14;
    4 External4 'A' 15;
}
