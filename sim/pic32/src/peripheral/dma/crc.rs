//! The CRC unit: a shift register of up to 16 bits that one channel feeds.
//!
//! The chip's tables do not tell in which order bits enter; here it is the highest of each byte first, without reflection.

const CONTROL_WRITABLE: u32 = 0x0FC3;
const APPEND: u32 = 1 << 6;
const ENABLED: u32 = 1 << 7;

/// DCRCCON, DCRCDATA, DCRCXOR.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CrcUnit {
    control: u32,
    data: u16,
    taps: u16,
}

impl CrcUnit {
    pub(super) const NEW: CrcUnit = CrcUnit {
        control: 0,
        data: 0,
        taps: 0,
    };

    pub(super) fn read(self, word: u8) -> u32 {
        match word {
            0 => self.control,
            1 => u32::from(self.data),
            _ => u32::from(self.taps),
        }
    }

    pub(super) fn write(&mut self, word: u8, value: u32) {
        match word {
            0 => self.control = value & CONTROL_WRITABLE,
            1 => self.data = low_half(value),
            _ => self.taps = low_half(value),
        }
    }

    fn serves(self, channel: u8) -> bool {
        self.control & ENABLED != 0 && self.control & 3 == u32::from(channel)
    }

    /// Whether this channel only reads, and the result goes to its destination at the end of the block.
    pub(super) fn is_appended_to(self, channel: u8) -> bool {
        self.serves(channel) && self.control & APPEND != 0
    }

    /// A byte that a channel moves.
    pub(super) fn feed(&mut self, channel: u8, byte: u8) {
        if !self.serves(channel) {
            return;
        }
        let length = (self.control >> 8 & 0xF) + 1;
        let (top, mask) = (1_u32 << (length - 1), (1_u32 << length) - 1);
        // The lowest tap is always there.
        let taps = u32::from(self.taps) | 1;
        let crc = (0..8).rev().fold(u32::from(self.data) & mask, |crc, bit| {
            let out = (crc & top != 0) != (byte >> bit & 1 != 0);
            (crc << 1 ^ if out { taps } else { 0 }) & mask
        });
        self.data = low_half(crc);
    }

    /// The result.
    pub(super) fn result(self) -> u16 {
        self.data
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the register has 16 bits")]
const fn low_half(value: u32) -> u16 {
    value as u16
}
