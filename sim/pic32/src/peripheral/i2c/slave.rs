//! The answers of an I2C slave to what it hears on the lines.

use super::{
    DATA, GENERAL_CALL, GENERAL_CALL_SEEN, HOLD_CYCLES, I2c, NOT_ACKNOWLEDGED, OVERRUN, READS, RELEASE,
    STRETCH, STRICT, TEN_BITS, TEN_BITS_MATCHED,
};
use crate::peripheral::rate::Now;

/// What the slave is in the middle of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlavePhase {
    /// Nothing, or a transfer with others.
    Idle,
    /// Bits come in: of an address, the second byte of one, or data.
    In { kind: ByteKind, byte: u8, bits: u8 },
    /// It acknowledges this byte, or does not.
    AcknowledgeIn { kind: ByteKind, byte: u8, taken: bool },
    /// It sends; so many bits were clocked.
    Out { byte: u8, bits: u8 },
    /// The clock is held until there is a byte to send.
    AwaitByte,
    /// The master acknowledges what was sent, or has not.
    AcknowledgeOut { acknowledged: bool },
}

/// What a byte that comes in is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteKind {
    Address,
    SecondAddress,
    Data,
}

impl SlavePhase {
    /// Whether a master reads from this side.
    pub(super) fn is_reading(self) -> bool {
        matches!(
            self,
            SlavePhase::AwaitByte | SlavePhase::Out { .. } | SlavePhase::AcknowledgeOut { .. }
        )
    }
}

impl I2c {
    /// A start (`true`) or a stop is on the lines.
    pub(super) fn hear_condition(&mut self, starts: bool) {
        self.slave_pulls_data = false;
        self.slave_change = None;
        self.holds_clock = false;
        self.phase = if starts && !self.makes_start() {
            SlavePhase::In {
                kind: ByteKind::Address,
                byte: 0,
                bits: 0,
            }
        } else {
            SlavePhase::Idle
        };
    }

    pub(super) fn slave_hears_clock_rise(&mut self) {
        match &mut self.phase {
            SlavePhase::In { byte, bits, .. } => {
                *byte = *byte << 1 | u8::from(self.data_high);
                *bits += 1;
            }
            SlavePhase::AcknowledgeOut { acknowledged } => *acknowledged = !self.data_high,
            SlavePhase::Idle
            | SlavePhase::AcknowledgeIn { .. }
            | SlavePhase::Out { .. }
            | SlavePhase::AwaitByte => {}
        }
    }

    pub(super) fn slave_hears_clock_fall(&mut self, now: Now) {
        match self.phase {
            SlavePhase::In { kind, byte, bits: 8 } => self.judge(kind, byte, now),
            SlavePhase::AcknowledgeIn { kind, byte, taken } => {
                self.change_data(false, now);
                self.end_of_byte_in(kind, byte, taken);
            }
            SlavePhase::Out { byte, bits } => self.put_bit(byte, bits + 1, now),
            SlavePhase::AcknowledgeOut { acknowledged } => {
                self.raise_flag(NOT_ACKNOWLEDGED, !acknowledged);
                self.raise_flag(DATA, true);
                if acknowledged {
                    self.await_byte();
                } else {
                    self.phase = SlavePhase::Idle;
                }
            }
            SlavePhase::Idle | SlavePhase::In { .. } | SlavePhase::AwaitByte => {}
        }
    }

    fn change_data(&mut self, pulls: bool, now: Now) {
        self.slave_change = Some((now.cycle + HOLD_CYCLES, pulls));
    }

    /// Eight bits are there: is it for this side, and is there room for it?
    fn judge(&mut self, kind: ByteKind, byte: u8, now: Now) {
        let is_ours = match kind {
            ByteKind::Address => self.is_our_address(byte),
            ByteKind::SecondAddress => {
                let differs = (byte ^ self.address.to_le_bytes()[0]) & !self.mask.to_le_bytes()[0];
                self.raise_flag(TEN_BITS_MATCHED, differs == 0);
                differs == 0
            }
            ByteKind::Data => true,
        };
        if !is_ours {
            self.phase = SlavePhase::Idle;
            return;
        }
        let taken = self.flags & OVERRUN == 0 && self.deliver(byte);
        self.phase = SlavePhase::AcknowledgeIn { kind, byte, taken };
        self.change_data(taken, now);
    }

    fn is_our_address(&mut self, byte: u8) -> bool {
        let (address, reads) = (u32::from(byte >> 1), byte & 1 != 0);
        if address == 0 && !reads && self.has(GENERAL_CALL) {
            self.flags |= GENERAL_CALL_SEEN;
            return true;
        }
        if self.has(TEN_BITS) {
            // 11110, both high bits of the address, and the direction; reading follows a match in the same transfer.
            let expected = 0x78 | self.address >> 8;
            let is_known = !reads || self.flags & TEN_BITS_MATCHED != 0;
            return address == expected && is_known;
        }
        let is_reserved = !(0x08..0x78).contains(&address);
        let differs = (address ^ self.address) & 0x7F & !self.mask;
        differs == 0 && !(is_reserved && self.has(STRICT))
    }

    /// The ninth clock of a byte that came in is over.
    fn end_of_byte_in(&mut self, kind: ByteKind, byte: u8, taken: bool) {
        if !taken {
            // The master sees that nobody acknowledges, and goes.
            self.phase = SlavePhase::Idle;
            return;
        }
        self.raise_flag(DATA, kind == ByteKind::Data);
        if kind == ByteKind::Address {
            self.raise_flag(READS, byte & 1 != 0);
        }
        if kind == ByteKind::Address && byte & 1 != 0 {
            return self.await_byte();
        }
        let is_first_of_ten =
            kind == ByteKind::Address && self.has(TEN_BITS) && self.flags & GENERAL_CALL_SEEN == 0;
        let kind = if is_first_of_ten {
            ByteKind::SecondAddress
        } else {
            ByteKind::Data
        };
        self.phase = SlavePhase::In {
            kind,
            byte: 0,
            bits: 0,
        };
        self.events.slave = true;
        if self.has(STRETCH) {
            self.hold_clock();
        }
    }

    fn hold_clock(&mut self) {
        self.holds_clock = true;
        self.control &= !RELEASE;
    }

    /// The clock is held until the program has a byte.
    fn await_byte(&mut self) {
        self.phase = SlavePhase::AwaitByte;
        self.transmit = None;
        self.hold_clock();
        self.events.slave = true;
    }

    /// The program sets SCLREL.
    pub(super) fn release_clock(&mut self) {
        if !self.holds_clock {
            return;
        }
        self.holds_clock = false;
        if self.phase == SlavePhase::AwaitByte {
            let byte = self.transmit.unwrap_or(0xFF);
            self.phase = SlavePhase::Out { byte, bits: 0 };
            self.slave_change = None;
            self.slave_pulls_data = byte & 0x80 == 0;
        }
    }

    /// So many bits of a byte were clocked: the next one, or the master's acknowledge.
    fn put_bit(&mut self, byte: u8, bits: u8, now: Now) {
        if bits < 8 {
            self.phase = SlavePhase::Out { byte, bits };
            self.change_data(byte << bits & 0x80 == 0, now);
        } else {
            self.transmit = None;
            self.phase = SlavePhase::AcknowledgeOut { acknowledged: false };
            self.change_data(false, now);
        }
    }
}
