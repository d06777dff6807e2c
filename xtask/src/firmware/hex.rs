//! Intel HEX, as programmers for PIC32 read it: physical addresses, 16 bytes a line.

use super::elf::Segment;
use std::fmt::Write;

const DATA: u8 = 0;
const END: u8 = 1;
const UPPER_ADDRESS: u8 = 4;
const LINE: usize = 16;

/// The text of a file with these segments.
pub(super) fn text(segments: &[Segment]) -> String {
    let mut text = String::new();
    let mut upper = None;
    for segment in segments {
        let mut address = segment.physical;
        let mut rest = segment.bytes.as_slice();
        while !rest.is_empty() {
            if upper != Some(address >> 16) {
                upper = Some(address >> 16);
                record(
                    &mut text,
                    0,
                    UPPER_ADDRESS,
                    &((address >> 16) as u16).to_be_bytes(),
                );
            }
            // A line neither crosses a multiple of its length nor the 64 KiB that its address can tell.
            let room = LINE - address as usize % LINE;
            let (line, after) = rest.split_at(room.min(rest.len()));
            record(&mut text, address as u16, DATA, line);
            address = address.wrapping_add(line.len() as u32);
            rest = after;
        }
    }
    record(&mut text, 0, END, &[]);
    text
}

fn record(text: &mut String, address: u16, kind: u8, bytes: &[u8]) {
    let mut line = vec![bytes.len() as u8];
    line.extend(address.to_be_bytes());
    line.push(kind);
    line.extend(bytes);
    let sum = line.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
    line.push(sum.wrapping_neg());
    text.push(':');
    for byte in line {
        // A string takes everything.
        write!(text, "{byte:02X}").ok();
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::{Segment, text};

    #[test]
    fn lines_are_those_of_the_format() {
        let segments = [
            Segment {
                physical: 0x1D00_FFFE,
                offset: 0,
                bytes: vec![1, 2, 3],
            },
            Segment {
                physical: 0x1FC0_2FF0,
                offset: 0,
                bytes: vec![0xFF; 16],
            },
        ];
        let wanted = "\
:020000041D00DD
:02FFFE000102FE
:020000041D01DC
:0100000003FC
:020000041FC01B
:102FF000FFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFE1
:00000001FF
";
        assert_eq!(text(&segments), wanted);
    }
}
