//! The CRC of a packet: CRC-32C over direction, session number, packet and its length.
//!
//! The *digest* is the running sum while bytes come by; the *CRC* is its final value. Two things are summed that do not
//! travel: a byte for the direction, so an echo of our own output never passes for the peer's, and the session
//! number, so a packet of an older session does not pass either. The length at the end catches splices whose halves
//! happen to agree in the register.

/// Castagnoli's polynomial, bit-reflected.
const POLYNOMIAL: u32 = 0x82F6_3B78;

/// Bytes that one step of [`Digest::extend`] takes. A 64-bit host spends 8 KiB on tables for speed; a microcontroller
/// spends 1 KiB and goes byte by byte.
const STRIDE: usize = if cfg!(target_pointer_width = "64") { 8 } else { 1 };

/// Row k is the effect of a byte that k further bytes follow.
static TABLES: [[u32; 256]; STRIDE] = tables();

const fn tables() -> [[u32; 256]; STRIDE] {
    let mut tables = [[0; 256]; STRIDE];
    let mut byte = 0;
    while byte < 256 {
        let mut register = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            register = (register >> 1) ^ (POLYNOMIAL * (register & 1));
            bit += 1;
        }
        tables[0][byte] = register;
        byte += 1;
    }
    let mut row = 1;
    while row < STRIDE {
        let mut byte = 0;
        while byte < 256 {
            let previous = tables[row - 1][byte];
            tables[row][byte] = (previous >> 8) ^ tables[0][(previous & 0xFF) as usize];
            byte += 1;
        }
        row += 1;
    }
    tables
}

/// Direction of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Commands.
    HostToRobot,
    /// Reports.
    RobotToHost,
}

impl Direction {
    /// The byte that stands for the direction in the digest.
    #[must_use]
    pub const fn byte(self) -> u8 {
        match self {
            Self::HostToRobot => b'>',
            Self::RobotToHost => b'<',
        }
    }
}

/// The running sum over one packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest {
    register: u32,
    length: u16,
}

impl Digest {
    /// Starts a packet of `direction` in the session with number `session` (0 = none).
    #[must_use]
    pub fn start(direction: Direction, session: u16) -> Self {
        let mut digest = Self {
            register: u32::MAX,
            length: 0,
        };
        let [low, high] = session.to_le_bytes();
        digest.register = step(digest.register, direction.byte());
        digest.register = step(digest.register, low);
        digest.register = step(digest.register, high);
        digest
    }

    /// Takes one byte of the packet.
    #[inline]
    pub fn push(&mut self, byte: u8) {
        self.register = step(self.register, byte);
        self.length = self.length.wrapping_add(1);
    }

    /// Takes several bytes of the packet.
    #[inline]
    pub fn extend(&mut self, bytes: &[u8]) {
        let (strides, rest) = bytes.as_chunks::<STRIDE>();
        for stride in strides {
            self.register = step_stride(self.register, *stride);
        }
        for byte in rest {
            self.register = step(self.register, *byte);
        }
        // A packet has at most 256 bytes: a longer one is refused before its CRC is computed.
        self.length = self.length.wrapping_add(bytes.len() as u16);
    }

    /// The CRC of what was taken.
    #[must_use]
    #[inline]
    pub fn crc(self) -> u32 {
        let [low, high] = self.length.to_le_bytes();
        !step(step(self.register, low), high)
    }
}

/// The CRC of a whole packet: its JSON text, or kind and unstuffed body of its binary form.
#[must_use]
pub fn packet_crc(direction: Direction, session: u16, packet: &[u8]) -> u32 {
    let mut digest = Digest::start(direction, session);
    digest.extend(packet);
    digest.crc()
}

/// CRC-32C of bytes that are no packet (an image in flash, a record), piece by piece: starts with `u32::MAX` and
/// continues with the result of the last piece. The complement of the result is the CRC.
#[must_use]
pub fn crc32c(register: u32, bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .fold(register, |register, byte| step(register, *byte))
}

#[inline]
fn step(register: u32, byte: u8) -> u32 {
    (register >> 8) ^ table(0, (register as u8) ^ byte)
}

#[inline]
fn step_stride<const BYTES: usize>(register: u32, stride: [u8; BYTES]) -> u32 {
    let register_bytes = register.to_le_bytes();
    let mut next = if BYTES < 4 { register >> (8 * BYTES) } else { 0 };
    for (index, byte) in stride.into_iter().enumerate() {
        let mixed = byte ^ register_bytes.get(index).copied().unwrap_or(0);
        next ^= table(BYTES - 1 - index, mixed);
    }
    next
}

#[inline]
fn table(row: usize, byte: u8) -> u32 {
    // Rows run from 0 to STRIDE - 1 by construction; the compiler sees it and drops the check.
    TABLES.get(row).map_or(0, |row| row[usize::from(byte)])
}

/// Spells a CRC as eight upper-case hexadecimal digits.
#[must_use]
pub fn to_hex(crc: u32) -> [u8; 8] {
    core::array::from_fn(|index| match (crc >> (28 - 4 * index)) as u8 & 0xF {
        digit @ 0..=9 => b'0' + digit,
        digit => b'A' + digit - 10,
    })
}

/// Reads eight upper-case hexadecimal digits; `None` for anything else.
#[must_use]
#[inline]
pub fn from_hex(digits: [u8; 8]) -> Option<u32> {
    let mut crc = 0;
    for digit in digits {
        let value = match digit {
            b'0'..=b'9' => digit - b'0',
            b'A'..=b'F' => digit - b'A' + 10,
            _ => return None,
        };
        crc = crc << 4 | u32::from(value);
    }
    Some(crc)
}

#[cfg(test)]
mod tests {
    use super::{Digest, Direction, STRIDE, from_hex, packet_crc, step, step_stride, to_hex};

    #[test]
    fn check_value_of_the_catalogue() {
        let register = b"123456789"
            .iter()
            .fold(u32::MAX, |register, byte| step(register, *byte));
        assert_eq!(!register, 0xE306_9283);
    }

    #[test]
    fn strides_and_single_bytes_agree() {
        let bytes: [u8; 200] = core::array::from_fn(|index| (index * 37 + 11) as u8);
        for length in 0..bytes.len() {
            let mut one_by_one = Digest::start(Direction::HostToRobot, 0x1234);
            for byte in &bytes[..length] {
                one_by_one.push(*byte);
            }
            assert_eq!(
                one_by_one.crc(),
                packet_crc(Direction::HostToRobot, 0x1234, &bytes[..length])
            );
        }
    }

    #[test]
    fn strides_of_any_width_agree() {
        let bytes = [0x12, 0x34, 0x56, 0x78];
        let expected = bytes
            .iter()
            .fold(0xDEAD_BEEF, |register, byte| step(register, *byte));
        let ones = bytes
            .iter()
            .fold(0xDEAD_BEEF, |register, byte| step_stride(register, [*byte]));
        assert_eq!(ones, expected);
        if STRIDE >= 4 {
            assert_eq!(step_stride(0xDEAD_BEEF, bytes), expected);
        }
    }

    #[test]
    fn direction_session_and_length_change_the_crc() {
        let packet = br#"{"c":"info"}"#;
        let here = packet_crc(Direction::HostToRobot, 7, packet);
        assert_ne!(here, packet_crc(Direction::RobotToHost, 7, packet));
        assert_ne!(here, packet_crc(Direction::HostToRobot, 8, packet));
        assert_ne!(
            packet_crc(Direction::HostToRobot, 0, b""),
            packet_crc(Direction::HostToRobot, 0, b"\0")
        );
    }

    #[test]
    fn hexadecimal_is_upper_case_only() {
        assert_eq!(&to_hex(0x05B1_D6FA), b"05B1D6FA");
        assert_eq!(from_hex(*b"05B1D6FA"), Some(0x05B1_D6FA));
        assert_eq!(from_hex(*b"05b1D6FA"), None);
        assert_eq!(from_hex(*b"05B1D6F "), None);
    }
}
