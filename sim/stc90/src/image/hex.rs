//! Intel HEX.

use super::{HexFault, Image, ImageError};

/// Reads all records.
pub(super) fn read(text: &str) -> Result<Image, ImageError> {
    let mut image = Image::erased();
    let mut state = HexState::default();
    let mut last = 0;
    for (index, line) in text.lines().enumerate() {
        let line_number = index + 1;
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        last = line_number;
        let at = |fault| ImageError::Hex {
            line: line_number,
            fault,
        };
        let record = HexRecord::parse(line).map_err(at)?;
        state.take(&record, &mut image, line_number)?;
    }
    if !state.is_ended {
        return Err(ImageError::Hex {
            line: last,
            fault: HexFault::NoEnd,
        });
    }
    if !state.has_data {
        return Err(ImageError::Empty);
    }
    Ok(image)
}

/// One line.
#[derive(Debug)]
struct HexRecord {
    kind: u8,
    address: u16,
    data: Vec<u8>,
}

impl HexRecord {
    fn parse(line: &str) -> Result<Self, HexFault> {
        let digits = line.strip_prefix(':').ok_or(HexFault::NoColon)?;
        let bytes = bytes_of(digits).ok_or(HexFault::NoHex)?;
        let [says, high, low, kind, rest @ ..] = bytes.as_slice() else {
            return Err(HexFault::Length { says: 0, has: 0 });
        };
        let Some((_, data)) = rest.split_last() else {
            return Err(HexFault::Length {
                says: usize::from(*says),
                has: 0,
            });
        };
        if data.len() != usize::from(*says) {
            return Err(HexFault::Length {
                says: usize::from(*says),
                has: data.len(),
            });
        }
        if bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte)) != 0 {
            return Err(HexFault::Checksum);
        }
        Ok(Self {
            kind: *kind,
            address: u16::from_be_bytes([*high, *low]),
            data: data.to_vec(),
        })
    }
}

fn bytes_of(digits: &str) -> Option<Vec<u8>> {
    let pairs = digits.as_bytes().chunks(2);
    pairs
        .map(|pair| match pair {
            [high, low] => Some(digit(*high)? << 4 | digit(*low)?),
            _ => None,
        })
        .collect()
}

fn digit(letter: u8) -> Option<u8> {
    char::from(letter).to_digit(16).map(|value| value as u8)
}

#[derive(Debug, Default)]
struct HexState {
    base: u32,
    has_data: bool,
    is_ended: bool,
}

impl HexState {
    fn take(&mut self, record: &HexRecord, image: &mut Image, line: usize) -> Result<(), ImageError> {
        let at = |fault| ImageError::Hex { line, fault };
        if self.is_ended {
            return Err(at(HexFault::AfterEnd));
        }
        let upper = || match record.data.as_slice() {
            [high, low] => Ok(u32::from(u16::from_be_bytes([*high, *low]))),
            data => Err(at(HexFault::Length {
                says: 2,
                has: data.len(),
            })),
        };
        match record.kind {
            0 => {
                let address = self.base.wrapping_add(u32::from(record.address));
                if !image.write(address, &record.data) {
                    let length = record.data.len();
                    return Err(ImageError::OutsideFlash {
                        line,
                        address,
                        length,
                    });
                }
                self.has_data |= !record.data.is_empty();
            }
            1 => self.is_ended = true,
            2 => self.base = upper()? << 4,
            4 => self.base = upper()? << 16,
            // Where to begin: this chip begins at its reset vector.
            3 | 5 => {}
            kind => return Err(at(HexFault::Record(kind))),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{HexFault, Image, ImageError};

    const END: &str = ":00000001FF\n";

    #[test]
    fn data_lands_where_the_records_say() {
        let text = format!(
            ":0400100001020304E2\r\n:020000021000EC\n:02000000090AEB\n:020000020000FC\n:027FFE00050676\n{END}"
        );
        let refused = ImageError::OutsideFlash {
            line: 3,
            address: 0x1_0000,
            length: 2,
        };
        assert_eq!(Image::from_hex(&text), Err(refused));
        let image = Image::from_hex(&text.replace(":02000000090AEB\n", "\n")).unwrap();
        assert_eq!(image.flash()[0x0F..0x15], [0xFF, 1, 2, 3, 4, 0xFF]);
        assert_eq!(image.flash()[0x7FFD..], [0xFF, 5, 6]);
    }

    #[test]
    fn each_fault_is_told_with_its_line() {
        let hex = |line, fault| Err(ImageError::Hex { line, fault });
        let cases = [
            ("0400100001020304E2", hex(1, HexFault::NoColon)),
            (":04001000010203", hex(1, HexFault::Length { says: 4, has: 2 })),
            (":0400100001020304E3", hex(1, HexFault::Checksum)),
            (":04001000010203zz", hex(1, HexFault::NoHex)),
            (":0400100001020304E", hex(1, HexFault::NoHex)),
            (":04001000\u{e4}", hex(1, HexFault::NoHex)),
            (":00000009F7", hex(1, HexFault::Record(9))),
            (":010000041DDE", hex(1, HexFault::Length { says: 2, has: 1 })),
            (":00000001FF\n\n:00000001FF", hex(3, HexFault::AfterEnd)),
            (":020000040000FA", hex(1, HexFault::NoEnd)),
            (":", hex(1, HexFault::Length { says: 0, has: 0 })),
            ("", hex(0, HexFault::NoEnd)),
            (END, Err(ImageError::Empty)),
            (
                "\n:047FFE000102030475",
                Err(ImageError::OutsideFlash {
                    line: 2,
                    address: 0x7FFE,
                    length: 4,
                }),
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(Image::from_hex(text), expected, "{text}");
        }
    }
}
