//! CRC-32C, by which flash and records are checked.

/// The check value of some bytes.
pub(super) fn crc_32c(bytes: &[u8]) -> u32 {
    const POLYNOMIAL: u32 = 0x82F6_3B78;
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (POLYNOMIAL & 0_u32.wrapping_sub(crc & 1))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::crc_32c;

    #[test]
    fn the_check_value_is_the_published_one() {
        assert_eq!(crc_32c(b"123456789"), 0xE306_9283);
    }
}
