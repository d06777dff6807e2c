//! The checksums of an image: what the firmware compares its flash with while it runs (S21).
//!
//! The program keeps one or two words behind its image (`image_crc!` of the peripheral library), which the linker leaves
//! all ones: the first gets the CRC-32C of program flash up to these words, the second that of boot flash.

use super::checksum::crc_32c;
use super::elf::{Elf, Segment, physical};
use anyhow::{Context, bail};

const SECTION: &str = ".image_crc";
const PROGRAM: u32 = 0x1D00_0000;
const BOOT: u32 = 0x1FC0_0000;
/// Where the configuration words begin, which are no part of boot flash's check.
const BOOT_END: u32 = 0x1FC0_2FF0;
/// What flash holds where the program has nothing.
const ERASED: u8 = 0xFF;

/// The file with its checksums filled in, and whether it has any. `program` is what was read from the file.
pub(super) fn with_crc(mut file: Vec<u8>, program: &Elf) -> anyhow::Result<(Vec<u8>, bool)> {
    let Some(section) = program
        .sections
        .iter()
        .find(|section| section.name == SECTION && section.size > 0)
    else {
        return Ok((file, false));
    };
    let address = physical(section.address);
    let words = match section.size {
        4 => vec![crc_32c(&content(program, PROGRAM, address))],
        8 => vec![
            crc_32c(&content(program, PROGRAM, address)),
            crc_32c(&content(program, BOOT, BOOT_END)),
        ],
        other => bail!("{SECTION} has {other} bytes; an image has one checksum or two"),
    };
    let holder = program.segments.iter().find(|segment| holds(segment, address));
    let holder = holder.with_context(|| format!("{SECTION} is not in the file"))?;
    let offset = holder.offset + (address - holder.physical) as usize;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let place = file
        .get_mut(offset..offset + bytes.len())
        .context("the ELF file is truncated")?;
    place.copy_from_slice(&bytes);
    Ok((file, true))
}

fn holds(segment: &Segment, address: u32) -> bool {
    address >= segment.physical && ((address - segment.physical) as usize) < segment.bytes.len()
}

/// What flash holds from `base` up to `end`, or up to the last byte of the program before it.
fn content(program: &Elf, base: u32, end: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    for segment in program
        .segments
        .iter()
        .filter(|segment| (base..end).contains(&segment.physical))
    {
        let at = (segment.physical - base) as usize;
        let room = (end - segment.physical) as usize;
        let new = segment.bytes.get(..room).unwrap_or(&segment.bytes);
        bytes.resize(bytes.len().max(at + new.len()), ERASED);
        if let Some(place) = bytes.get_mut(at..at + new.len()) {
            place.copy_from_slice(new);
        }
    }
    // Program flash is checked up to these words, gaps of alignment before it included.
    if base == PROGRAM {
        bytes.resize((end - base) as usize, ERASED);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::{crc_32c, with_crc};
    use crate::firmware::elf::{Elf, Section, Segment};

    /// Boot flash of 8 bytes; program flash of 20 bytes, and after a gap of 4 the checksums.
    fn program(crc_bytes: u32) -> (Vec<u8>, Elf) {
        let file: Vec<u8> = (0..200).collect();
        let segment = |physical, offset: usize, length: usize| Segment {
            physical,
            offset,
            bytes: file[offset..offset + length].to_vec(),
        };
        let elf = Elf {
            segments: vec![
                segment(0x1D00_0000, 100, 20),
                segment(0x1D00_0018, 150, crc_bytes as usize),
                segment(0x1FC0_0000, 10, 8),
                segment(0x1FC0_2FF0, 20, 16),
            ],
            sections: vec![Section {
                name: ".image_crc".to_owned(),
                address: 0x9D00_0018,
                size: crc_bytes,
                executable: false,
                bytes: None,
            }],
            symbols: Vec::new(),
        };
        (file, elf)
    }

    #[test]
    fn program_and_boot_flash_get_their_checksums_in_the_file() {
        let mut flash: Vec<u8> = (100..120).collect();
        flash.extend([0xFF; 4]);
        let boot: Vec<u8> = (10..18).collect();
        for words in [1, 2] {
            let (file, elf) = program(4 * words);
            let (new, has_crc) = with_crc(file.clone(), &elf).expect("there is room");
            let mut wanted = file;
            wanted[150..154].copy_from_slice(&crc_32c(&flash).to_le_bytes());
            if words == 2 {
                wanted[154..158].copy_from_slice(&crc_32c(&boot).to_le_bytes());
            }
            assert!(has_crc && new == wanted);
        }
    }

    #[test]
    fn a_program_without_checksum_words_stays_as_it_is_and_a_strange_one_is_refused() {
        let (file, mut elf) = program(12);
        assert!(with_crc(file.clone(), &elf).is_err_and(|error| error.to_string().contains("12 bytes")));
        elf.sections.clear();
        assert_eq!(
            with_crc(file.clone(), &elf).expect("nothing to do"),
            (file, false)
        );
    }
}
