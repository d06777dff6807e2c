//! What joins the board to the Linux board, as the firmware was built for it.

use super::BoardError;
use super::pinout::{Miswiring, Pinout};
use super::wiring::Wiring;
use crate::pins::{Pin, Port, known};

/// What joins the two boards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoardLink {
    /// A serial line.
    #[default]
    Serial,
    /// SPI 1, the chip is slave.
    Spi,
    /// I2C 1, the chip is slave.
    I2c,
}

/// Where a master's wires of SPI end at the chip.
#[derive(Clone, Copy, Debug)]
pub struct SpiPlaces {
    /// SCK.
    pub clock: Pin,
    /// The slave's input.
    pub input: Pin,
    /// The slave's output.
    pub output: Pin,
    /// Low during a transfer.
    pub select: Pin,
    /// High while the robot has something to say.
    pub attention: Pin,
}

/// Where a master's wires of I2C end at the chip.
#[derive(Clone, Copy, Debug)]
pub struct I2cPlaces {
    /// SDA.
    pub data: Pin,
    /// SCL.
    pub clock: Pin,
    /// High while the robot has something to say.
    pub attention: Pin,
}

impl SpiPlaces {
    /// Those of the SR8730.
    pub const SR8730: Self = Self {
        clock: known(Port::F, 6),
        input: known(Port::F, 7),
        output: known(Port::F, 8),
        select: known(Port::C, 13),
        attention: known(Port::B, 7),
    };
}

impl I2cPlaces {
    /// Those of the SR8730.
    pub const SR8730: Self = Self {
        data: known(Port::G, 3),
        clock: known(Port::G, 2),
        attention: known(Port::B, 7),
    };
}

/// The serial line's pins serve the other links.
const SERIAL: [Miswiring; 2] = [
    Miswiring::Swapped("link-receive", "spare-ra0"),
    Miswiring::Swapped("link-transmit", "spare-ra5"),
];
/// What the pins of SPI 1 are for on a board without that link.
const CUT_FOR_SPI: [Miswiring; 2] = [
    Miswiring::Swapped("rear-receiver-left", "spare-rf12"),
    Miswiring::Swapped("gyro-power", "spare-ra2"),
];

impl BoardLink {
    /// The board of the SR8730 with this link: what ends on its pins otherwise is cut off.
    pub(super) fn wiring(self) -> Result<Wiring, BoardError> {
        let cuts: &[&[Miswiring]] = match self {
            Self::Serial => &[],
            Self::Spi => &[&SERIAL, &CUT_FOR_SPI],
            Self::I2c => &[&SERIAL],
        };
        let mut pinout = Pinout::sr8730()?;
        for cut in cuts.iter().copied().flatten() {
            pinout = pinout.miswired(cut);
        }
        Wiring::of(&pinout)
    }
}

#[cfg(test)]
mod tests {
    use super::{BoardLink, I2cPlaces, SpiPlaces};

    #[test]
    fn nothing_else_ends_on_the_pins_of_a_link() {
        let serial = BoardLink::Serial.wiring().unwrap();
        assert_eq!(serial.link_transmit.pin, SpiPlaces::SR8730.attention);
        assert_eq!(serial.beam_receivers[2].pin, SpiPlaces::SR8730.clock);
        let spi = BoardLink::Spi.wiring().unwrap();
        let places = SpiPlaces::SR8730;
        let others = [
            spi.link_transmit.pin,
            spi.link_receive[0].pin,
            spi.beam_receivers[2].pin,
            spi.gyro_power.pin,
        ];
        for place in [
            places.clock,
            places.input,
            places.output,
            places.select,
            places.attention,
        ] {
            assert!(!others.contains(&place), "{place}");
        }
        let i2c = BoardLink::I2c.wiring().unwrap();
        assert_ne!(i2c.link_transmit.pin, I2cPlaces::SR8730.attention);
        assert_eq!(i2c.beam_receivers, serial.beam_receivers);
    }
}
