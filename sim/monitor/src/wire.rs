//! An independent implementation of the wire, written from `protocol/SPEC.md` and not from the firmware's code.
//!
//! It splits the byte stream into packets, checks their CRCs with its own CRC-32C, and reads the few messages that
//! decide whether motors may run. It accepts slightly more than the firmware does (it does not check every key), so
//! that it only reports a firmware that acts on something that was never sent.

const PACKET_MAX: usize = 256;
const CRC_LEN: usize = 9;

/// Splits a byte stream into packets. A forbidden byte, a framing error or too many bytes spoil the packet they are in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Splitter {
    packet: Vec<u8>,
    finished: Vec<u8>,
    spoiled: bool,
}

impl Splitter {
    /// Takes one byte (`None` = the receiver saw a wrong stop bit); at a separator gives the packet, if it is whole.
    pub(crate) fn push(&mut self, byte: Option<u8>) -> Option<&[u8]> {
        match byte {
            Some(0x1F | 0x1E) => return self.cut(),
            Some(byte) if self.takes(byte) => self.packet.push(byte),
            _ => self.spoiled = true,
        }
        None
    }

    /// Whether the next byte begins a packet.
    pub(crate) fn is_between_packets(&self) -> bool {
        self.packet.is_empty()
    }

    fn takes(&self, byte: u8) -> bool {
        let binary = self.packet.first().is_some_and(|first| *first >= 0x80);
        self.packet.len() < PACKET_MAX && (binary || byte >= 0x20)
    }

    fn cut(&mut self) -> Option<&[u8]> {
        core::mem::swap(&mut self.packet, &mut self.finished);
        self.packet.clear();
        let whole = !core::mem::take(&mut self.spoiled);
        (whole && !self.finished.is_empty()).then_some(&self.finished)
    }
}

/// Direction of a packet, as the byte that the CRC covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WireDirection {
    ToRobot,
    FromRobot,
}

impl WireDirection {
    fn byte(self) -> u8 {
        match self {
            Self::ToRobot => b'>',
            Self::FromRobot => b'<',
        }
    }
}

/// Whether the CRC of a text packet fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CrcCheck {
    /// No CRC at all.
    Absent,
    /// A CRC that fits.
    Right,
    /// A CRC that does not fit: nothing in the packet counts.
    Wrong,
}

/// The JSON bytes of a text packet and whether its CRC fits.
pub(crate) fn split_crc(packet: &[u8], direction: WireDirection, session: u16) -> (&[u8], CrcCheck) {
    let Some((json, crc)) = packet
        .len()
        .checked_sub(CRC_LEN)
        .map(|at| packet.split_at(at))
        .filter(|(_, crc)| crc.first() == Some(&b'*'))
    else {
        return (packet, CrcCheck::Absent);
    };
    let given = crc[1..].iter().try_fold(0_u32, |sum, digit| {
        let value = match digit {
            b'0'..=b'9' => digit - b'0',
            b'A'..=b'F' => digit - b'A' + 10,
            _ => return None,
        };
        Some(sum << 4 | u32::from(value))
    });
    let right = given == Some(packet_crc(json, direction, session));
    (json, if right { CrcCheck::Right } else { CrcCheck::Wrong })
}

/// Kind and body of a binary packet, unstuffed; `None` when its CRC is wrong.
pub(crate) fn checked_binary(packet: &[u8], direction: WireDirection, session: u16) -> Option<Vec<u8>> {
    let whole = unstuff(packet)?;
    let (body, crc) = whole.split_last_chunk::<4>()?;
    (u32::from_le_bytes(*crc) == packet_crc(body, direction, session)).then(|| body.to_vec())
}

/// 0x1D precedes a byte whose bit 5 is inverted.
fn unstuff(packet: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = packet.iter();
    let mut whole = Vec::with_capacity(packet.len());
    while let Some(byte) = bytes.next() {
        whole.push(if *byte == 0x1D {
            bytes.next()? ^ 0x20
        } else {
            *byte
        });
    }
    Some(whole)
}

/// The CRC-32C over direction, session, body and its length.
pub(crate) fn packet_crc(body: &[u8], direction: WireDirection, session: u16) -> u32 {
    let length = u16::try_from(body.len()).unwrap_or(u16::MAX);
    let head = [
        direction.byte(),
        session.to_le_bytes()[0],
        session.to_le_bytes()[1],
    ];
    let crc = crc32c(u32::MAX, &head);
    let crc = crc32c(crc, body);
    !crc32c(crc, &length.to_le_bytes())
}

/// Reflected CRC with the Castagnoli polynomial, a bit at a time: slow, short, and unlike the firmware's table.
fn crc32c(crc: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(crc, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0x82F6_3B78 & (crc & 1).wrapping_neg())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{CrcCheck, Splitter, WireDirection, crc32c, packet_crc, split_crc};

    #[test]
    fn the_check_value_of_castagnoli() {
        assert_eq!(!crc32c(u32::MAX, b"123456789"), 0xE306_9283);
    }

    #[test]
    fn garbage_spoils_one_packet_only() {
        let mut splitter = Splitter::default();
        let mut packets = Vec::new();
        for byte in b"ab\x02c\x1f\x1fde\x1ef\x1f\x80\x01\x1f"
            .iter()
            .copied()
            .map(Some)
        {
            if let Some(packet) = splitter.push(byte) {
                packets.push(packet.to_vec());
            }
        }
        assert_eq!(packets, [b"de".to_vec(), b"f".to_vec(), b"\x80\x01".to_vec()]);
    }

    #[test]
    fn a_crc_belongs_to_direction_and_session() {
        let json = br#"{"c":"stop"}"#;
        let packet = [
            json.as_slice(),
            format!("*{:08X}", packet_crc(json, WireDirection::ToRobot, 7)).as_bytes(),
        ]
        .concat();
        assert_eq!(
            split_crc(&packet, WireDirection::ToRobot, 7),
            (json.as_slice(), CrcCheck::Right)
        );
        assert_eq!(split_crc(&packet, WireDirection::ToRobot, 8).1, CrcCheck::Wrong);
        assert_eq!(split_crc(&packet, WireDirection::FromRobot, 7).1, CrcCheck::Wrong);
        assert_eq!(split_crc(json, WireDirection::ToRobot, 7).1, CrcCheck::Absent);
    }
}
