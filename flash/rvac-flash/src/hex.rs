//! Intel HEX: bytes and where they belong.

/// Why a file is not what it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HexError {
    /// A line is no record.
    #[error("line {0} is no record of an Intel HEX file")]
    Record(usize),
    /// Its sum is wrong.
    #[error("line {0} has a wrong checksum: the file is damaged")]
    Sum(usize),
    /// There is no record of the end.
    #[error("the file has no end record: it is cut off")]
    NoEnd,
    /// There is no data.
    #[error("the file has no data")]
    Empty,
}

/// Bytes from an address on.
pub type Piece = (u32, Vec<u8>);

/// Reads all data records.
///
/// # Errors
/// The first line that is wrong.
pub fn parse(text: &str) -> Result<Vec<Piece>, HexError> {
    let mut pieces = Vec::new();
    let mut base = 0_u32;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        let bytes = line
            .strip_prefix(':')
            .and_then(bytes_of)
            .ok_or(HexError::Record(number))?;
        let [length, high, low, kind, rest @ ..] = bytes.as_slice() else {
            return Err(HexError::Record(number));
        };
        let Some((_, data)) = rest
            .split_last()
            .filter(|(_, data)| data.len() == usize::from(*length))
        else {
            return Err(HexError::Record(number));
        };
        if bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte)) != 0 {
            return Err(HexError::Sum(number));
        }
        let address = u32::from(u16::from_be_bytes([*high, *low]));
        match (kind, data) {
            (0, data) => pieces.push((base.wrapping_add(address), data.to_vec())),
            (1, _) if pieces.is_empty() => return Err(HexError::Empty),
            (1, _) => return Ok(pieces),
            (2, [high, low]) => base = u32::from(u16::from_be_bytes([*high, *low])) << 4,
            (4, [high, low]) => base = u32::from(u16::from_be_bytes([*high, *low])) << 16,
            // Where to begin: these chips begin at their reset vector.
            (3 | 5, _) => {}
            _ => return Err(HexError::Record(number)),
        }
    }
    Err(HexError::NoEnd)
}

fn bytes_of(digits: &str) -> Option<Vec<u8>> {
    let nibble = |letter: u8| char::from(letter).to_digit(16).map(|value| value as u8);
    let pairs = digits.as_bytes().chunks(2).map(|pair| match pair {
        [high, low] => Some(nibble(*high)? << 4 | nibble(*low)?),
        _ => None,
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::{HexError, parse};

    const END: &str = ":00000001FF\n";

    #[test]
    fn data_lands_where_the_records_say() {
        let text = format!(":020000041D00DD\n:0400100001020304E2\r\n{END}");
        assert_eq!(parse(&text), Ok(vec![(0x1D00_0010, vec![1, 2, 3, 4])]));
    }

    #[test]
    fn each_fault_is_named_with_its_line() {
        let cases = [
            ("0400100001020304E2", HexError::Record(1)),
            (":04001000010203", HexError::Record(1)),
            (":0400100001020304E3", HexError::Sum(1)),
            (":04001000010203zz", HexError::Record(1)),
            ("\n:00000009F7", HexError::Record(2)),
            (":0400100001020304E2", HexError::NoEnd),
            ("", HexError::NoEnd),
            (END, HexError::Empty),
            (":", HexError::Record(1)),
        ];
        for (text, expected) in cases {
            assert_eq!(parse(text), Err(expected), "{text}");
        }
    }
}
