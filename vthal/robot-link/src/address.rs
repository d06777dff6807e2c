//! One line that names a link: `kind:place?key=value&key=value`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::gpio_line::GpioLine;
use crate::i2c::I2cHost;
use crate::spi::SpiHost;
use crate::{Abilities, Clocking, Duplex, Idle};

/// Where names of USB devices stay the same whatever is plugged in before them.
const BY_ID: &str = "/dev/serial/by-id/";

/// A link, completely named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkAddress {
    /// A serial device: `uart:/dev/serial0?baud=230400`.
    Uart(UartAddress),
    /// A USB device that is a serial port by itself: `usb:/dev/serial/by-id/usb-NAME`.
    Usb(PathBuf),
    /// A network: `tcp:robot.local:4000`.
    Tcp(NetworkAddress),
    /// A network, encrypted: `tls:robot.local:4001?ca=/etc/vthal/robot.pem`.
    Tls(SecureAddress),
    /// SPI, the host is master: `spi:/dev/spidev0.0?hz=1000000&attention=gpiochip0:24`.
    Spi(SpiAddress),
    /// I2C, the robot is slave: `i2c:/dev/i2c-1?address=0x2a`.
    I2c(I2cAddress),
}

/// A serial device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UartAddress {
    /// The device.
    pub path: PathBuf,
    /// Bits per second; `None` = what the make of the robot speaks.
    pub baud: Option<u32>,
    /// How many wires there are.
    pub wires: Wires,
}

/// How a UART is wired.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wires {
    /// One wire a direction.
    Two,
    /// One wire for both: what the host sends comes back to it.
    One,
    /// A pair for both (RS-485): a driver has to be switched on to send.
    Pair(Direction),
}

/// What switches the driver of an RS-485 pair on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Direction {
    /// RTS while it is high, which the kernel switches.
    RtsHigh,
    /// RTS while it is low, which the kernel switches.
    RtsLow,
    /// A GPIO line while it is high, which the daemon switches.
    LineHigh(GpioLine),
    /// A GPIO line while it is low, which the daemon switches.
    LineLow(GpioLine),
}

/// A host on the network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetworkAddress {
    /// Name or address.
    pub host: String,
    /// Port.
    pub port: u16,
}

/// A host on the network that proves who it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SecureAddress {
    /// Where.
    pub peer: NetworkAddress,
    /// The certificate that it shows, or that of who has signed it (PEM). No other is believed.
    pub ca: PathBuf,
    /// The name in its certificate, when it is not that of the host.
    pub name: Option<String>,
    /// How the daemon proves itself: its certificate and its key (PEM).
    pub identity: Option<(PathBuf, PathBuf)>,
}

/// An SPI device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpiAddress {
    /// The device.
    pub path: PathBuf,
    /// Clock.
    pub hz: u32,
    /// Mode 0 to 3: bit 1 polarity, bit 0 phase.
    pub mode: u8,
    /// High while the robot has something to say; without it the host asks.
    pub attention: Option<GpioLine>,
}

/// A device on an I2C bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct I2cAddress {
    /// The bus.
    pub path: PathBuf,
    /// Seven bits.
    pub address: u8,
    /// High while the robot has something to say; without it the host asks.
    pub attention: Option<GpioLine>,
}

/// Why a line names no link, and what to write.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AddressError {
    /// There is no kind, or none of ours.
    #[error("{0:?} is no kind of link: write uart:, usb:, tcp:, tls:, spi: or i2c: and where it is")]
    Kind(String),
    /// The kind is named and nothing else.
    #[error("{kind}: says not where: write for example {example}")]
    Place {
        /// The kind.
        kind: &'static str,
        /// A whole one.
        example: &'static str,
    },
    /// The name of a USB device changes when another is plugged in.
    #[error("{0:?} may be another device after the next start: write its name under /dev/serial/by-id")]
    Unlasting(String),
    /// A key that this kind does not have.
    #[error("{kind}: has no {key:?}: it has {known}")]
    Key {
        /// The kind.
        kind: &'static str,
        /// The key.
        key: String,
        /// Those it has.
        known: String,
    },
    /// A key twice.
    #[error("{0:?} is there twice: leave one")]
    Twice(String),
    /// A key that must be there.
    #[error("{kind}: needs {key}=: write for example {example}")]
    Missing {
        /// The kind.
        kind: &'static str,
        /// The key.
        key: &'static str,
        /// A whole one.
        example: &'static str,
    },
    /// A value that cannot be.
    #[error("{key}={value:?} cannot be: write {wanted}")]
    Value {
        /// The key.
        key: &'static str,
        /// Its value.
        value: String,
        /// What is wanted.
        wanted: &'static str,
    },
}

/// A kind of link: its keys, and a whole line.
struct Kind {
    name: &'static str,
    keys: &'static [&'static str],
    example: &'static str,
}

const UART: Kind = Kind {
    name: "uart",
    keys: &["baud", "wires", "direction"],
    example: "uart:/dev/serial0",
};
const USB: Kind = Kind {
    name: "usb",
    keys: &[],
    example: "usb:/dev/serial/by-id/usb-NAME",
};
const TCP: Kind = Kind {
    name: "tcp",
    keys: &[],
    example: "tcp:robot.local:4000",
};
const TLS: Kind = Kind {
    name: "tls",
    keys: &["ca", "name", "cert", "key"],
    example: "tls:robot.local:4001?ca=/etc/vthal/robot.pem",
};
const SPI: Kind = Kind {
    name: "spi",
    keys: &["hz", "mode", "attention"],
    example: "spi:/dev/spidev0.0?hz=1000000",
};
const I2C: Kind = Kind {
    name: "i2c",
    keys: &["address", "attention"],
    example: "i2c:/dev/i2c-1?address=0x2a",
};
const KINDS: [&Kind; 6] = [&UART, &USB, &TCP, &TLS, &SPI, &I2C];

impl FromStr for LinkAddress {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        let kind = KINDS
            .into_iter()
            .find(|kind| kind.name == name)
            .ok_or_else(|| AddressError::Kind(name.to_owned()))?;
        let (place, keys) = rest.split_once('?').unwrap_or((rest, ""));
        if place.is_empty() {
            return Err(AddressError::Place {
                kind: kind.name,
                example: kind.example,
            });
        }
        let keys = Keys::read(kind, keys)?;
        match kind.name {
            "uart" => Ok(Self::Uart(uart(place, &keys)?)),
            "usb" if place.starts_with(BY_ID) => Ok(Self::Usb(place.into())),
            "usb" => Err(AddressError::Unlasting(place.to_owned())),
            "tcp" => Ok(Self::Tcp(peer(place)?)),
            "tls" => Ok(Self::Tls(secure(place, &keys)?)),
            "spi" => Ok(Self::Spi(spi(place, &keys)?)),
            _ => Ok(Self::I2c(i2c(place, &keys)?)),
        }
    }
}

impl LinkAddress {
    /// The serial device with two wires at this path.
    #[must_use]
    pub fn serial(path: PathBuf, baud: Option<u32>) -> Self {
        Self::Uart(UartAddress {
            path,
            baud,
            wires: Wires::Two,
        })
    }

    /// What a link of this kind can.
    #[must_use]
    pub const fn abilities(&self) -> Abilities {
        match self {
            Self::Uart(UartAddress {
                wires: Wires::Two, ..
            })
            | Self::Usb(_)
            | Self::Tcp(_)
            | Self::Tls(_) => Abilities::STREAM,
            Self::Uart(_) => Abilities::SHARED_WIRE,
            Self::Spi(_) => Abilities {
                duplex: Duplex::Full,
                clocking: Clocking::Host,
                transfer_max: Some(SpiHost::TRANSFER_MAX),
                idle: Idle::Fill,
            },
            Self::I2c(_) => Abilities {
                duplex: Duplex::Half,
                clocking: Clocking::Host,
                transfer_max: Some(I2cHost::TRANSFER_MAX),
                idle: Idle::Silence,
            },
        }
    }

    /// The device that has to exist on this machine; a host of the network has none.
    #[must_use]
    pub fn device(&self) -> Option<&Path> {
        match self {
            Self::Uart(UartAddress { path, .. })
            | Self::Usb(path)
            | Self::Spi(SpiAddress { path, .. })
            | Self::I2c(I2cAddress { path, .. }) => Some(path),
            Self::Tcp(_) | Self::Tls(_) => None,
        }
    }
}

/// The keys of a line, each known to its kind and there once.
struct Keys<'a> {
    kind: &'static Kind,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Keys<'a> {
    fn read(kind: &'static Kind, text: &'a str) -> Result<Self, AddressError> {
        let mut pairs: Vec<(&str, &str)> = Vec::new();
        for pair in text.split('&').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
            if !kind.keys.contains(&key) {
                let known = match kind.keys {
                    [] => "none".to_owned(),
                    keys => keys.join(", "),
                };
                return Err(AddressError::Key {
                    kind: kind.name,
                    key: key.to_owned(),
                    known,
                });
            }
            if pairs.iter().any(|(other, _)| *other == key) {
                return Err(AddressError::Twice(key.to_owned()));
            }
            pairs.push((key, value));
        }
        Ok(Self { kind, pairs })
    }

    fn get(&self, key: &str) -> Option<&'a str> {
        self.pairs
            .iter()
            .find(|(name, _)| *name == key)
            .map(|(_, value)| *value)
    }

    fn needed(&self, key: &'static str) -> Result<&'a str, AddressError> {
        self.get(key).ok_or(AddressError::Missing {
            kind: self.kind.name,
            key,
            example: self.kind.example,
        })
    }

    /// The value of a key as `read` understands it.
    fn value<T>(
        &self,
        key: &'static str,
        wanted: &'static str,
        read: impl FnOnce(&'a str) -> Option<T>,
    ) -> Result<Option<T>, AddressError> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        match read(value) {
            Some(read) => Ok(Some(read)),
            None => Err(AddressError::Value {
                key,
                value: value.to_owned(),
                wanted,
            }),
        }
    }

    fn path(&self, key: &'static str) -> Result<Option<PathBuf>, AddressError> {
        self.value(key, "the path of a file", |value| {
            (!value.is_empty()).then(|| PathBuf::from(value))
        })
    }

    fn attention(&self) -> Result<Option<GpioLine>, AddressError> {
        self.value(
            "attention",
            "a chip and a line, such as gpiochip0:24",
            GpioLine::read,
        )
    }
}

/// What switches the driver of a pair.
fn direction(text: &str) -> Option<Direction> {
    match text {
        "rts" => Some(Direction::RtsHigh),
        "rts-low" => Some(Direction::RtsLow),
        line => match line.strip_suffix("-low") {
            Some(line) => GpioLine::read(line).map(Direction::LineLow),
            None => GpioLine::read(line).map(Direction::LineHigh),
        },
    }
}

/// A number in decimal, or in hexadecimal after `0x`.
fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

fn uart(place: &str, keys: &Keys<'_>) -> Result<UartAddress, AddressError> {
    let baud = keys.value("baud", "1200 to 4000000", |text| {
        number(text).filter(|baud| (1_200..=4_000_000).contains(baud))
    })?;
    let is_one = keys.value("wires", "one or two", |text| match text {
        "one" => Some(true),
        "two" => Some(false),
        _ => None,
    })?;
    let wanted = "rts, rts-low, or a GPIO line such as gpiochip0:17 or gpiochip0:17-low";
    let direction = keys.value("direction", wanted, direction)?;
    let wires = match (is_one, direction) {
        (None | Some(false), None) => Wires::Two,
        (Some(true), None) => Wires::One,
        (None, Some(direction)) => Wires::Pair(direction),
        (Some(_), Some(_)) => {
            return Err(AddressError::Value {
                key: "wires",
                value: keys.get("wires").unwrap_or_default().to_owned(),
                wanted: "either wires=one or direction=rts: a pair has its direction, one wire has none",
            });
        }
    };
    Ok(UartAddress {
        path: place.into(),
        baud,
        wires,
    })
}

/// Host and port; an IPv6 address stands in brackets.
fn peer(place: &str) -> Result<NetworkAddress, AddressError> {
    let wrong = || AddressError::Value {
        key: "host:port",
        value: place.to_owned(),
        wanted: "a host and a port, such as robot.local:4000 or [fd00::1]:4000",
    };
    let (host, port) = place.rsplit_once(':').ok_or_else(wrong)?;
    let inner = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
    let host = match inner {
        Some(address) => address,
        None if host.contains(':') => return Err(wrong()),
        None => host,
    };
    match port.parse() {
        Ok(port) if port > 0 && !host.is_empty() => Ok(NetworkAddress {
            host: host.to_owned(),
            port,
        }),
        _ => Err(wrong()),
    }
}

fn secure(place: &str, keys: &Keys<'_>) -> Result<SecureAddress, AddressError> {
    keys.needed("ca")?;
    let identity = match (keys.path("cert")?, keys.path("key")?) {
        (Some(cert), Some(key)) => Some((cert, key)),
        (None, None) => None,
        (Some(_), None) => return Err(keys.needed("key").err().unwrap_or_else(missing_identity)),
        (None, Some(_)) => return Err(keys.needed("cert").err().unwrap_or_else(missing_identity)),
    };
    Ok(SecureAddress {
        peer: peer(place)?,
        ca: keys.path("ca")?.unwrap_or_default(),
        name: keys.value("name", "a name", |name| {
            (!name.is_empty()).then(|| name.to_owned())
        })?,
        identity,
    })
}

fn missing_identity() -> AddressError {
    AddressError::Missing {
        kind: TLS.name,
        key: "cert= and key",
        example: TLS.example,
    }
}

fn spi(place: &str, keys: &Keys<'_>) -> Result<SpiAddress, AddressError> {
    Ok(SpiAddress {
        path: place.into(),
        hz: keys
            .value("hz", "10000 to 20000000", |text| {
                number(text).filter(|hz| (10_000..=20_000_000).contains(hz))
            })?
            .unwrap_or(1_000_000),
        mode: keys
            .value("mode", "0, 1, 2 or 3", |text| {
                number(text)
                    .filter(|mode| *mode <= 3)
                    .and_then(|mode| u8::try_from(mode).ok())
            })?
            .unwrap_or(0),
        attention: keys.attention()?,
    })
}

fn i2c(place: &str, keys: &Keys<'_>) -> Result<I2cAddress, AddressError> {
    keys.needed("address")?;
    Ok(I2cAddress {
        path: place.into(),
        address: keys
            .value("address", "an address of seven bits, 0x08 to 0x77", |text| {
                number(text)
                    .filter(|address| (0x08..=0x77).contains(address))
                    .and_then(|address| u8::try_from(address).ok())
            })?
            .unwrap_or_default(),
        attention: keys.attention()?,
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::{Direction, GpioLine, LinkAddress, UartAddress, Wires};
    use crate::{Clocking, Duplex};

    fn read(text: &str) -> LinkAddress {
        text.parse().expect("a link")
    }

    #[test]
    fn each_kind_is_read() {
        assert_eq!(
            read("uart:/dev/serial0"),
            LinkAddress::serial("/dev/serial0".into(), None)
        );
        assert_eq!(
            read("uart:/dev/ttyS1?baud=115200&direction=rts-low"),
            LinkAddress::Uart(UartAddress {
                path: "/dev/ttyS1".into(),
                baud: Some(115_200),
                wires: Wires::Pair(Direction::RtsLow),
            })
        );
        let driver = GpioLine {
            chip: "/dev/gpiochip1".into(),
            line: 17,
        };
        for (text, direction) in [
            ("gpiochip1:17", Direction::LineHigh(driver.clone())),
            ("/dev/gpiochip1:17-low", Direction::LineLow(driver)),
        ] {
            let LinkAddress::Uart(uart) = read(&format!("uart:/dev/ttyS1?direction={text}")) else {
                panic!("not a UART");
            };
            assert_eq!(uart.wires, Wires::Pair(direction));
        }
        assert_eq!(read("uart:/dev/ttyS1?wires=one").abilities().duplex, Duplex::Half);
        assert_eq!(
            read("usb:/dev/serial/by-id/usb-x").device(),
            Some(PathBuf::from("/dev/serial/by-id/usb-x").as_path())
        );
        let LinkAddress::Tcp(peer) = read("tcp:[fd00::1]:4000") else {
            panic!("not TCP");
        };
        assert_eq!((peer.host.as_str(), peer.port), ("fd00::1", 4000));
        let LinkAddress::Tls(secure) = read("tls:robot.local:4001?ca=/r.pem&cert=/c.pem&key=/k.pem") else {
            panic!("not TLS");
        };
        assert_eq!(secure.identity, Some(("/c.pem".into(), "/k.pem".into())));
        let LinkAddress::Spi(spi) = read("spi:/dev/spidev0.0?hz=1000000&attention=gpiochip0:24") else {
            panic!("not SPI");
        };
        assert_eq!((spi.hz, spi.mode), (1_000_000, 0));
        let attention = GpioLine {
            chip: "/dev/gpiochip0".into(),
            line: 24,
        };
        assert_eq!(spi.attention, Some(attention));
        let i2c = read("i2c:/dev/i2c-1?address=0x2a");
        assert_eq!(i2c.abilities().clocking, Clocking::Host);
        assert_eq!(
            i2c.abilities().to_string(),
            "one direction at a time, clocked by the host, at most 128 bytes a transfer"
        );
    }

    #[test]
    fn what_names_no_link_is_refused_with_what_to_write() {
        for (text, refusal) in [
            (
                "/dev/ttyUSB0",
                "\"/dev/ttyUSB0\" is no kind of link: write uart:, usb:, tcp:, tls:, spi: or i2c: and where it is",
            ),
            (
                "serial:/dev/ttyUSB0",
                "\"serial\" is no kind of link: write uart:, usb:, tcp:, tls:, spi: or i2c: and where it is",
            ),
            (
                "spi:",
                "spi: says not where: write for example spi:/dev/spidev0.0?hz=1000000",
            ),
            (
                "usb:/dev/ttyACM0",
                "\"/dev/ttyACM0\" may be another device after the next start: write its name under /dev/serial/by-id",
            ),
            ("tcp:h:1?baud=9600", "tcp: has no \"baud\": it has none"),
            (
                "uart:/dev/a?speed=9600",
                "uart: has no \"speed\": it has baud, wires, direction",
            ),
            (
                "uart:/dev/a?baud=9600&baud=9600",
                "\"baud\" is there twice: leave one",
            ),
            (
                "uart:/dev/a?baud=fast",
                "baud=\"fast\" cannot be: write 1200 to 4000000",
            ),
            (
                "uart:/dev/a?wires=one&direction=rts",
                "wires=\"one\" cannot be: write either wires=one or direction=rts: a pair has its direction, one wire has none",
            ),
            (
                "uart:/dev/a?direction=17",
                "direction=\"17\" cannot be: write rts, rts-low, or a GPIO line such as gpiochip0:17 or gpiochip0:17-low",
            ),
            (
                "tcp:robot",
                "host:port=\"robot\" cannot be: write a host and a port, such as robot.local:4000 or [fd00::1]:4000",
            ),
            (
                "tls:robot:1",
                "tls: needs ca=: write for example tls:robot.local:4001?ca=/etc/vthal/robot.pem",
            ),
            (
                "tls:robot:1?ca=/a&cert=/b",
                "tls: needs key=: write for example tls:robot.local:4001?ca=/etc/vthal/robot.pem",
            ),
            (
                "i2c:/dev/i2c-1",
                "i2c: needs address=: write for example i2c:/dev/i2c-1?address=0x2a",
            ),
            (
                "i2c:/dev/i2c-1?address=0x80",
                "address=\"0x80\" cannot be: write an address of seven bits, 0x08 to 0x77",
            ),
            (
                "spi:/dev/spidev0.0?attention=24",
                "attention=\"24\" cannot be: write a chip and a line, such as gpiochip0:24",
            ),
        ] {
            let error = text.parse::<LinkAddress>().expect_err("no link");
            assert_eq!(error.to_string(), refusal);
        }
    }
}
