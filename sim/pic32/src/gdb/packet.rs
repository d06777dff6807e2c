//! Packets: `$text#checksum`, acknowledged by `+` or refused by `-`, and the interrupt byte between them.

/// More bytes than that are in no packet: the session names this size to the debugger.
pub(super) const PACKET_BYTES: usize = 0x2000;
/// What the debugger sends to stop a running program.
const INTERRUPT: u8 = 0x03;

/// What came in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PacketEvent {
    /// A packet whose checksum is right; escapes are still in it.
    Packet(Vec<u8>),
    /// A packet whose checksum is wrong, or that is too long.
    Damaged,
    /// The debugger did not understand the last packet.
    Refused,
    /// Stop the program.
    Interrupt,
}

/// Finds packets in a stream of bytes.
#[derive(Clone, Debug, Default)]
pub(super) struct PacketFramer {
    state: PacketState,
    packet: Vec<u8>,
    sum: u8,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PacketState {
    #[default]
    Between,
    Inside,
    FirstDigit,
    SecondDigit(Option<u8>),
}

impl PacketFramer {
    /// Takes one byte.
    pub(super) fn take(&mut self, byte: u8) -> Option<PacketEvent> {
        match (self.state, byte) {
            (PacketState::Between, b'$') => self.begin(),
            (PacketState::Between, INTERRUPT) => return Some(PacketEvent::Interrupt),
            (PacketState::Between, b'-') => return Some(PacketEvent::Refused),
            (PacketState::Between, _) => {}
            (PacketState::Inside, b'$') => self.begin(),
            (PacketState::Inside, b'#') => self.state = PacketState::FirstDigit,
            (PacketState::Inside, _) => {
                self.sum = self.sum.wrapping_add(byte);
                if self.packet.len() <= PACKET_BYTES {
                    self.packet.push(byte);
                }
            }
            (PacketState::FirstDigit, _) => self.state = PacketState::SecondDigit(digit(byte)),
            (PacketState::SecondDigit(first), _) => return Some(self.end(first, digit(byte))),
        }
        None
    }

    fn begin(&mut self) {
        self.state = PacketState::Inside;
        self.packet.clear();
        self.sum = 0;
    }

    fn end(&mut self, first: Option<u8>, second: Option<u8>) -> PacketEvent {
        self.state = PacketState::Between;
        let stated = first.zip(second).map(|(first, second)| first << 4 | second);
        match stated == Some(self.sum) && self.packet.len() <= PACKET_BYTES {
            true => PacketEvent::Packet(std::mem::take(&mut self.packet)),
            false => PacketEvent::Damaged,
        }
    }
}

/// A packet around a text. What would end or begin a packet is escaped.
pub(super) fn framed(text: &[u8]) -> Vec<u8> {
    let mut packet = vec![b'$'];
    for byte in text {
        match byte {
            b'$' | b'#' | b'}' | b'*' => packet.extend([b'}', byte ^ 0x20]),
            _ => packet.push(*byte),
        }
    }
    let sum = packet
        .iter()
        .skip(1)
        .fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
    packet.extend(format!("#{sum:02x}").bytes());
    packet
}

/// Binary contents of a packet without their escapes.
pub(super) fn unescaped(bytes: &[u8]) -> Vec<u8> {
    let mut plain = Vec::with_capacity(bytes.len());
    let mut rest = bytes.iter();
    while let Some(byte) = rest.next() {
        match byte {
            b'}' => plain.extend(rest.next().map(|escaped| escaped ^ 0x20)),
            _ => plain.push(*byte),
        }
    }
    plain
}

/// Bytes as pairs of hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Bytes from pairs of hexadecimal digits.
pub(super) fn from_hex(text: &[u8]) -> Option<Vec<u8>> {
    let pairs = text.chunks(2);
    pairs
        .map(|pair| match pair {
            [high, low] => Some(digit(*high)? << 4 | digit(*low)?),
            _ => None,
        })
        .collect()
}

/// A number in hexadecimal digits.
pub(super) fn number(text: &[u8]) -> Option<u32> {
    u32::from_str_radix(std::str::from_utf8(text).ok()?, 16).ok()
}

fn digit(letter: u8) -> Option<u8> {
    char::from(letter).to_digit(16).map(|value| value as u8)
}

#[cfg(test)]
mod tests {
    use super::{PACKET_BYTES, PacketEvent, PacketFramer, framed, unescaped};

    fn events(bytes: &[u8]) -> Vec<PacketEvent> {
        let mut framer = PacketFramer::default();
        bytes.iter().filter_map(|byte| framer.take(*byte)).collect()
    }

    #[test]
    fn packets_are_found_between_anything() {
        let packet = |text: &str| PacketEvent::Packet(text.as_bytes().to_vec());
        let cases: [(&[u8], Vec<PacketEvent>); 7] = [
            (b"+$g#67+", vec![packet("g")]),
            (b"$?#3f$g#67", vec![packet("?"), packet("g")]),
            (b"$g#68", vec![PacketEvent::Damaged]),
            (b"$g#6z$?#3F", vec![PacketEvent::Damaged, packet("?")]),
            (b"$half$?#3f", vec![packet("?")]),
            (
                b"\x03$#00-",
                vec![PacketEvent::Interrupt, packet(""), PacketEvent::Refused],
            ),
            (b"noise#67", vec![]),
        ];
        for (bytes, expected) in cases {
            assert_eq!(events(bytes), expected, "{}", bytes.escape_ascii());
        }
    }

    #[test]
    fn a_packet_without_end_takes_no_memory() {
        let mut framer = PacketFramer::default();
        framer.take(b'$');
        for _ in 0..3 * PACKET_BYTES {
            assert_eq!(framer.take(b'a'), None);
        }
        assert!(framer.packet.len() <= PACKET_BYTES + 1);
        let ends: Vec<PacketEvent> = b"#00".iter().filter_map(|byte| framer.take(*byte)).collect();
        assert_eq!(ends, [PacketEvent::Damaged]);
    }

    #[test]
    fn escapes_come_back() {
        let text = b"a$b#c}d*e";
        let packet = framed(text);
        let [PacketEvent::Packet(inside)] = <[PacketEvent; 1]>::try_from(events(&packet)).unwrap() else {
            panic!("{}", packet.escape_ascii());
        };
        assert_eq!(unescaped(&inside), text);
        assert!(!inside.contains(&b'$'));
    }
}
