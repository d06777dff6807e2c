//! Properties of MQTT 5 (chapter 2.2.2), of which a client must know the lengths of all, and the meaning of some.

/// What a broker says of its limits. What it does not say is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Limits {
    /// So many messages may be on their way unacknowledged.
    pub(crate) receive_max: Option<u16>,
    /// The broker cuts the connection after this silence, seconds.
    pub(crate) keep_alive_s: Option<u16>,
    /// The longest packet it takes, bytes.
    pub(crate) packet_bytes_max: Option<u32>,
    /// It keeps messages.
    pub(crate) retains: Option<bool>,
}

/// How a property's value is written.
enum Form {
    Bytes(usize),
    /// Length in two bytes, then so many.
    Text,
    /// Two of them.
    Pair,
    /// Up to four bytes, of which all but the last have the highest bit.
    Variable,
}

fn form_of(identifier: u8) -> Option<Form> {
    Some(match identifier {
        0x01 | 0x17 | 0x19 | 0x24 | 0x25 | 0x28 | 0x29 | 0x2a => Form::Bytes(1),
        0x13 | 0x21 | 0x22 | 0x23 => Form::Bytes(2),
        0x02 | 0x11 | 0x18 | 0x27 => Form::Bytes(4),
        0x0b => Form::Variable,
        0x03 | 0x08 | 0x09 | 0x12 | 0x15 | 0x16 | 0x1a | 0x1c | 0x1f => Form::Text,
        0x26 => Form::Pair,
        _ => return None,
    })
}

/// A number of up to four bytes and the rest; `None` when it is too long or not whole.
pub(super) fn variable(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let mut value = 0;
    for (index, byte) in bytes.iter().take(4).enumerate() {
        value |= usize::from(byte & 0x7f) << (7 * index);
        if byte & 0x80 == 0 {
            return Some((value, bytes.get(index + 1..)?));
        }
    }
    None
}

/// The properties at the beginning of `bytes`, and what follows them.
pub(super) fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = variable(bytes)?;
    rest.split_at_checked(length)
}

/// What properties say of limits; `None` when they are malformed.
pub(super) fn limits(mut bytes: &[u8]) -> Option<Limits> {
    let mut limits = Limits::default();
    while let Some((&identifier, rest)) = bytes.split_first() {
        let length = match form_of(identifier)? {
            Form::Bytes(count) => count,
            Form::Text => text_length(rest)?,
            Form::Pair => {
                let first = text_length(rest)?;
                first + text_length(rest.get(first..)?)?
            }
            Form::Variable => rest.len() - variable(rest)?.1.len(),
        };
        let (value, after) = rest.split_at_checked(length)?;
        match (identifier, value) {
            (0x21, &[high, low]) => limits.receive_max = Some(u16::from_be_bytes([high, low])),
            (0x13, &[high, low]) => limits.keep_alive_s = Some(u16::from_be_bytes([high, low])),
            (0x27, &[a, b, c, d]) => limits.packet_bytes_max = Some(u32::from_be_bytes([a, b, c, d])),
            (0x25, &[yes]) => limits.retains = Some(yes != 0),
            _ => {}
        }
        bytes = after;
    }
    Some(limits)
}

fn text_length(bytes: &[u8]) -> Option<usize> {
    let (head, _) = bytes.split_first_chunk::<2>()?;
    Some(2 + usize::from(u16::from_be_bytes(*head)))
}
