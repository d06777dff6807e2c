//! The seal of an image: what the firmware compares its flash with while it runs (S21).
//!
//! Seven words that the linker leaves open: a magic, then length and CRC-32C of three pieces: boot flash, program flash before
//! the seal, program flash behind it. Besides, the word behind the image that the peripheral library offers is filled with
//! the CRC-32C of all program flash before it.

use super::checksum::crc_32c;
use super::elf::{Elf, physical};
use anyhow::{Context, bail};

/// The firmware's variable with the seal.
const SEAL: &str = "IMAGE_SEAL";
/// The peripheral library's word behind the image.
const WORD_BEHIND: &str = "__image_seal";
const MAGIC: u32 = 0x4C41_4553;
const SEAL_BYTES: usize = 28;

const PROGRAM: u32 = 0x1D00_0000;
const PROGRAM_BYTES: usize = 256 * 1024;
const BOOT: u32 = 0x1FC0_0000;
/// Boot flash without the configuration words.
const BOOT_BYTES: usize = 12 * 1024 - 16;

/// The file with its seals filled in; the program is what was read from it.
pub(super) fn sealed(mut file: Vec<u8>, program: &Elf) -> anyhow::Result<Vec<u8>> {
    let seal = program
        .symbols
        .iter()
        .find(|symbol| symbol.name.rsplit("::").next() == Some(SEAL));
    let behind = program.address_of(WORD_BEHIND).map(physical);
    let mut flash = Flash::of(program, PROGRAM, PROGRAM_BYTES);
    if let Some(symbol) = seal {
        if symbol.size as usize != SEAL_BYTES {
            bail!("{SEAL} has {} bytes, but the seal has {SEAL_BYTES}", symbol.size);
        }
        let at = flash
            .place(physical(symbol.address))
            .context("the seal does not lie in program flash")?;
        let end = behind
            .and_then(|address| flash.place(address))
            .unwrap_or(flash.used);
        let boot = Flash::of(program, BOOT, BOOT_BYTES);
        let words = words([
            boot.range(0, boot.used)?,
            flash.range(0, at)?,
            flash.range(at + SEAL_BYTES, end)?,
        ]);
        flash.patch(&mut file, at, &words)?;
    }
    if let Some(at) = behind.and_then(|address| flash.place(address)) {
        let word = crc_32c(flash.range(0, at)?).to_le_bytes();
        flash.patch(&mut file, at, &word)?;
    }
    Ok(file)
}

fn words(pieces: [&[u8]; 3]) -> Vec<u8> {
    let mut words = MAGIC.to_le_bytes().to_vec();
    for piece in pieces {
        words.extend((piece.len() as u32).to_le_bytes());
        words.extend(crc_32c(piece).to_le_bytes());
    }
    words
}

/// A flash memory as the program leaves it: erased where the program has nothing.
struct Flash<'a> {
    program: &'a Elf,
    base: u32,
    bytes: Vec<u8>,
    /// Bytes up to the last one of the program.
    used: usize,
}

impl<'a> Flash<'a> {
    fn of(program: &'a Elf, base: u32, size: usize) -> Self {
        let mut flash = Self {
            program,
            base,
            bytes: vec![0xFF; size],
            used: 0,
        };
        for segment in &program.segments {
            let Some(at) = flash.place(segment.physical) else {
                continue;
            };
            let end = at + segment.bytes.len();
            if let Some(place) = flash.bytes.get_mut(at..end) {
                place.copy_from_slice(&segment.bytes);
                flash.used = flash.used.max(end);
            }
        }
        flash
    }

    fn place(&self, physical: u32) -> Option<usize> {
        let at = physical.checked_sub(self.base)? as usize;
        (at < self.bytes.len()).then_some(at)
    }

    fn range(&self, from: usize, to: usize) -> anyhow::Result<&[u8]> {
        self.bytes
            .get(from..to)
            .with_context(|| format!("a piece of the image from {from} to {to} cannot be sealed"))
    }

    /// Writes bytes here and where they stand in the file.
    fn patch(&mut self, file: &mut [u8], at: usize, new: &[u8]) -> anyhow::Result<()> {
        let address = self.base + at as u32;
        let holder = self.program.segments.iter().find(|segment| {
            let last = address.wrapping_sub(segment.physical) as usize + new.len();
            address >= segment.physical && last <= segment.bytes.len()
        });
        let holder = holder.with_context(|| format!("the seal at {address:#010x} is not in the file"))?;
        let offset = holder.offset + (address - holder.physical) as usize;
        for (place, bytes) in [(at, &mut *self.bytes), (offset, file)] {
            let place = bytes
                .get_mut(place..place + new.len())
                .context("the ELF file is truncated")?;
            place.copy_from_slice(new);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{crc_32c, sealed};
    use crate::firmware::elf::{Elf, Segment, Symbol};

    /// Boot flash of 8 bytes, program flash of 64 with the seal at 16 and the word behind at 60; file offset = 100 later.
    fn program() -> (Vec<u8>, Elf) {
        let file: Vec<u8> = (0..200).collect();
        let segment = |physical, offset: usize, length: usize| Segment {
            physical,
            offset,
            bytes: file[offset..offset + length].to_vec(),
        };
        let symbol = |name: &str, address, size| Symbol {
            name: name.to_owned(),
            address,
            size,
            code: false,
        };
        let elf = Elf {
            segments: vec![segment(0x1FC0_0000, 10, 8), segment(0x1D00_0000, 100, 64)],
            symbols: vec![
                symbol("board::IMAGE_SEAL", 0x9D00_0010, 28),
                symbol("__image_seal", 0x9D00_003C, 4),
            ],
            sections: Vec::new(),
        };
        (file, elf)
    }

    fn word(bytes: &[u8], at: usize) -> u32 {
        u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
    }

    #[test]
    fn each_piece_is_sealed_in_the_file() {
        let (file, elf) = program();
        let new = sealed(file.clone(), &elf).expect("it can be sealed");
        assert_eq!(&new[..116], &file[..116]);
        assert_eq!(&new[144..160], &file[144..160]);
        assert_eq!(word(&new, 116), 0x4C41_4553);
        let pieces: [&[u8]; 3] = [&file[10..18], &file[100..116], &file[144..160]];
        for (index, piece) in pieces.into_iter().enumerate() {
            assert_eq!(word(&new, 120 + 8 * index), piece.len() as u32);
            assert_eq!(word(&new, 124 + 8 * index), crc_32c(piece));
        }
        assert_eq!(word(&new, 160), crc_32c(&new[100..160]));
    }

    #[test]
    fn a_program_without_seals_stays_as_it_is_and_a_wrong_one_is_refused() {
        let (file, mut elf) = program();
        elf.symbols[0].size = 24;
        assert!(sealed(file.clone(), &elf).is_err_and(|error| error.to_string().contains("24 bytes")));
        elf.symbols.clear();
        assert_eq!(sealed(file.clone(), &elf).expect("nothing to do"), file);
    }
}
