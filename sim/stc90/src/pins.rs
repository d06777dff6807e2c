//! The pins of the ports as the program names them: "P1.3" is bit 3 of port 1.
//!
//! All ports are *quasi-bidirectional*: a latch at 0 pulls its pin low, and a latch at 1 holds it high so weakly that
//! anything else can pull it low. Port 0 has no pull-up of its own, so the board's must be there. The level of a pin is
//! low when the chip or the circuit pulls it low.

use std::fmt;
use std::str::FromStr;

/// How many ports there are: P0 to P3, and P4, of which the 40-pin package has none that is free.
pub const PORTS: usize = 5;

/// What a voltmeter would see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Level {
    /// Ground.
    Low,
    /// The supply.
    High,
}

impl Level {
    /// High for true.
    #[must_use]
    pub const fn of(is_high: bool) -> Self {
        if is_high { Level::High } else { Level::Low }
    }

    /// Whether it is high.
    #[must_use]
    pub const fn is_high(self) -> bool {
        matches!(self, Level::High)
    }
}

/// A pin of one of the ports.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pin {
    port: u8,
    bit: u8,
}

impl Pin {
    /// The pin with this port, 0 to 4, and bit, 0 to 7.
    #[must_use]
    pub const fn new(port: u8, bit: u8) -> Option<Self> {
        if (port as usize) < PORTS && bit < 8 {
            Some(Self { port, bit })
        } else {
            None
        }
    }

    /// A pin of the tables in this crate.
    pub(crate) const fn known(port: u8, bit: u8) -> Self {
        Self { port, bit }
    }

    /// Number of its port, 0 to 4.
    #[must_use]
    pub const fn port(self) -> usize {
        self.port as usize
    }

    /// Its bit in the port as a mask.
    #[must_use]
    pub const fn mask(self) -> u8 {
        1 << self.bit
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "P{}.{}", self.port, self.bit)
    }
}

impl fmt::Debug for Pin {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// A text that names no pin of this part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no pin: a pin is named like P1.3, with port 0 to 4 and bit 0 to 7")]
pub struct UnknownPin(pub String);

impl FromStr for Pin {
    type Err = UnknownPin;

    fn from_str(text: &str) -> Result<Self, UnknownPin> {
        let pin = match text.as_bytes() {
            [b'P', port @ b'0'..=b'9', b'.', bit @ b'0'..=b'9'] => Pin::new(port - b'0', bit - b'0'),
            _ => None,
        };
        pin.ok_or_else(|| UnknownPin(text.to_owned()))
    }
}

/// Levels of all ports, a byte each, bit 0 the lowest; a one is a high level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels(pub [u8; PORTS]);

impl Levels {
    /// All high: ports after a reset, and inputs that nothing pulls low.
    pub const HIGH: Self = Self([0xFF; PORTS]);

    /// The level of one pin.
    #[must_use]
    pub fn level(&self, pin: Pin) -> Level {
        Level::of(self.0[pin.port()] & pin.mask() != 0)
    }

    /// Sets the level of one pin.
    pub fn set(&mut self, pin: Pin, level: Level) {
        let port = &mut self.0[pin.port()];
        match level {
            Level::High => *port |= pin.mask(),
            Level::Low => *port &= !pin.mask(),
        }
    }
}

/// Inputs that depend on what the chip does to one of its pins, as sensors do that see by a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SwitchedInputs {
    /// The chip's pin.
    pub by: Pin,
    /// What the circuit does to the inputs while the chip pulls that pin low.
    pub low: Levels,
    /// And while it lets it go.
    pub high: Levels,
}

/// A pin changes its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Machine cycle since power-on.
    pub cycle: u64,
    /// Which pin.
    pub pin: Pin,
    /// To which level.
    pub level: Level,
}

#[cfg(test)]
mod tests {
    use super::{Level, Levels, Pin, UnknownPin};

    #[test]
    fn names_are_read_and_written_alike() {
        for port in 0..5 {
            for bit in 0..8 {
                let name = format!("P{port}.{bit}");
                let pin: Pin = name.parse().unwrap();
                assert_eq!((pin.port(), pin.mask()), (port, 1 << bit));
                assert_eq!(pin.to_string(), name);
            }
        }
        for text in ["", "P", "P1", "P5.0", "P1.8", "P1.10", "p1.1", "P1,1", "P1.1 "] {
            assert_eq!(text.parse::<Pin>(), Err(UnknownPin(text.to_owned())));
        }
    }

    #[test]
    fn one_pin_changes_alone() {
        let pin: Pin = "P3.5".parse().unwrap();
        let mut levels = Levels::HIGH;
        levels.set(pin, Level::Low);
        assert_eq!(levels.0, [0xFF, 0xFF, 0xFF, 0xDF, 0xFF]);
        assert_eq!(levels.level(pin), Level::Low);
        levels.set(pin, Level::High);
        assert_eq!(levels, Levels::HIGH);
    }
}
