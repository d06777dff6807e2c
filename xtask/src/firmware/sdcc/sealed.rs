//! The image as it is flashed: all of the flash, its last four bytes such that the program finds a CRC of 0.

use super::super::checksum::crc_32c;
use super::super::elf::Segment;
use super::super::hex;
use anyhow::{Context, bail};

/// Bytes of the CRC at the end of the flash.
pub(super) const CRC_BYTES: u32 = 4;
/// What the program takes into its CRC before the flash (`PROGRAM_MARK` of `firmware/relax/board/main.c`).
const PREFIX: [u8; 3] = [b'p', 0, 0];
/// A byte that nobody has written.
const ERASED: u8 = 0xFF;

/// The Intel HEX file to flash, from the one of the linker.
pub(super) fn seal(linked: &str, flash_bytes: u32) -> anyhow::Result<String> {
    let program_bytes = flash_bytes.saturating_sub(CRC_BYTES) as usize;
    let mut flash = vec![ERASED; program_bytes];
    for line in linked.lines() {
        let (address, data) = record(line).with_context(|| format!("no Intel HEX: {line}"))?;
        let place = flash.get_mut(address..address + data.len());
        match place {
            Some(place) => place.copy_from_slice(&data),
            None => bail!("the program reaches beyond {program_bytes} bytes: {line}"),
        }
    }
    // A reflected CRC that takes its own state, lowest byte first, becomes 0.
    let state = !crc_32c(&[&PREFIX, flash.as_slice()].concat());
    flash.extend(state.to_le_bytes());
    Ok(hex::text(&[Segment {
        physical: 0,
        offset: 0,
        bytes: flash,
    }]))
}

/// Address and bytes of a record; none for records of other kinds.
fn record(line: &str) -> Option<(usize, Vec<u8>)> {
    let number = |from: usize, to: usize| usize::from_str_radix(line.get(from..to)?, 16).ok();
    let (count, address, kind) = (number(1, 3)?, number(3, 7)?, number(7, 9)?);
    let count = if kind == 0 { count } else { 0 };
    let bytes = (0..count).map(|index| Some(number(9 + 2 * index, 11 + 2 * index)? as u8));
    Some((address, bytes.collect::<Option<_>>()?))
}

#[cfg(test)]
mod tests {
    use super::super::super::checksum::crc_32c;
    use super::{PREFIX, record, seal};

    const FLASH_BYTES: u32 = 32_768;

    #[test]
    fn the_whole_flash_has_a_crc_of_zero() {
        let sealed = seal(":080000007590EF75A07D80FEF4\n:00000001FF\n", FLASH_BYTES).expect("a program");
        let mut flash = Vec::new();
        for line in sealed.lines().filter(|line| line.get(7..9) == Some("00")) {
            let (address, data) = record(line).expect("a record");
            assert_eq!(address, flash.len());
            flash.extend(data);
        }
        assert_eq!(flash.len(), FLASH_BYTES as usize);
        assert_eq!(!crc_32c(&[&PREFIX, flash.as_slice()].concat()), 0);
        flash[1] ^= 1;
        assert_ne!(!crc_32c(&[&PREFIX, flash.as_slice()].concat()), 0);
    }

    #[test]
    fn a_program_over_the_crc_is_refused() {
        assert!(seal(":027FFB000102AA\n", FLASH_BYTES).is_err());
        assert!(seal(":0\n", FLASH_BYTES).is_err());
    }
}
