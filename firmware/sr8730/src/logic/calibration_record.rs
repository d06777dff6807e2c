//! The calibration record at the end of program flash: the values that an owner has measured on this robot.
//!
//! Little endian: magic u32, version u16, count u16, `count` values i32 (the most negative one means unknown), and the
//! CRC-32C of all before it. A damaged record, or one for another list of values, is ignored completely: half a
//! calibration is worse than none.

use rvac_protocol::crc::crc32c;

/// First word.
pub const MAGIC: u32 = 0x4C41_4352;
/// Layout of the record.
pub const VERSION: u16 = 1;
/// Marks a value that is not measured.
pub const UNKNOWN: i32 = i32::MIN;

const HEADER_BYTES: usize = 8;

/// Why a record is not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordFault {
    /// There is none: flash is erased there.
    Absent,
    /// It is no record, or one of another version.
    Foreign,
    /// It holds this number of values, but this firmware expects another one.
    Count(u16),
    /// Its check value is wrong.
    Damaged,
}

/// Reads a record with `N` values, whose ranges are `ranges`. A value outside of its range counts as unknown.
///
/// # Errors
/// Why the record cannot be used.
pub fn read<const N: usize>(
    record: &[u8],
    ranges: &[(i32, i32); N],
) -> Result<[Option<i32>; N], RecordFault> {
    let header = record.first_chunk::<HEADER_BYTES>().ok_or(RecordFault::Foreign)?;
    let [a, b, c, d, version @ .., count_low, count_high] = *header;
    match u32::from_le_bytes([a, b, c, d]) {
        MAGIC => {}
        u32::MAX => return Err(RecordFault::Absent),
        _ => return Err(RecordFault::Foreign),
    }
    if u16::from_le_bytes(version) != VERSION {
        return Err(RecordFault::Foreign);
    }
    let count = u16::from_le_bytes([count_low, count_high]);
    if usize::from(count) != N {
        return Err(RecordFault::Count(count));
    }
    let (body, rest) = record
        .split_at_checked(HEADER_BYTES + 4 * N)
        .ok_or(RecordFault::Damaged)?;
    let check = rest.first_chunk::<4>().ok_or(RecordFault::Damaged)?;
    if !crc32c(u32::MAX, body) != u32::from_le_bytes(*check) {
        return Err(RecordFault::Damaged);
    }
    let mut values = [None; N];
    let words = body.get(HEADER_BYTES..).unwrap_or_default().as_chunks::<4>().0;
    for ((value, word), (least, most)) in values.iter_mut().zip(words).zip(ranges) {
        let found = i32::from_le_bytes(*word);
        *value = (*least..=*most).contains(&found).then_some(found);
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::{MAGIC, RecordFault, UNKNOWN, VERSION, read};
    use rvac_protocol::crc::crc32c;
    use std::vec::Vec;

    const RANGES: [(i32, i32); 3] = [(0, 10), (-5, 5), (1, 1_000)];

    fn record(values: &[i32]) -> Vec<u8> {
        let count = u16::try_from(values.len()).unwrap();
        let mut bytes: Vec<u8> = MAGIC
            .to_le_bytes()
            .into_iter()
            .chain(VERSION.to_le_bytes())
            .collect();
        bytes.extend(count.to_le_bytes());
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let check = !crc32c(u32::MAX, &bytes);
        bytes.extend(check.to_le_bytes());
        bytes.resize(4_096, 0xFF);
        bytes
    }

    #[test]
    fn values_out_of_range_and_unknown_ones_are_none() {
        assert_eq!(
            read(&record(&[10, -5, 1_000]), &RANGES),
            Ok([Some(10), Some(-5), Some(1_000)])
        );
        assert_eq!(read(&record(&[11, UNKNOWN, 0]), &RANGES), Ok([None, None, None]));
    }

    #[test]
    fn no_record_and_foreign_records_are_told_apart() {
        assert_eq!(read(&[0xFF; 4_096], &RANGES), Err(RecordFault::Absent));
        assert_eq!(read(&[0; 4_096], &RANGES), Err(RecordFault::Foreign));
        assert_eq!(read(&[], &RANGES), Err(RecordFault::Foreign));
        assert_eq!(read(&record(&[1, 2]), &RANGES), Err(RecordFault::Count(2)));
        let mut newer = record(&[1, 2, 3]);
        newer[4] = 2;
        assert_eq!(read(&newer, &RANGES), Err(RecordFault::Foreign));
    }

    #[test]
    fn every_flipped_bit_is_noticed() {
        let whole = record(&[1, 2, 3]);
        for bit in 0..8 * (8 + 4 * 3 + 4) {
            let mut damaged = whole.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(read(&damaged, &RANGES).is_err(), "bit {bit}");
        }
        assert_eq!(read(&whole[..20], &RANGES), Err(RecordFault::Damaged));
    }
}
