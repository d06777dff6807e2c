//! What passes on an I2C bus, as a listener at the slave's pins has it.

/// Its own address.
const ADDRESS: u8 = 0x2A;
/// The register of the stream.
const STREAM: u8 = 1;

/// What the byte that passes is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ByteOf {
    /// Nobody's that matters.
    #[default]
    Others,
    /// An address.
    Address,
    /// The number of a register.
    Register,
    /// What the master writes.
    Written,
    /// What the slave sends.
    Sent,
}

/// A byte of the link's stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StreamByte {
    /// The robot heard it.
    Heard(u8),
    /// The robot said it.
    Said(u8),
}

/// The listener.
#[derive(Clone, Debug)]
pub(super) struct BusListener {
    clock: bool,
    data: bool,
    kind: ByteOf,
    byte: u8,
    bits: u32,
    register: u8,
}

impl Default for BusListener {
    fn default() -> Self {
        Self {
            clock: true,
            data: true,
            kind: ByteOf::Others,
            byte: 0,
            bits: 0,
            register: 0,
        }
    }
}

impl BusListener {
    /// Whether clock and data are high, again whenever one may have changed.
    pub(super) fn look(&mut self, (clock, data): (bool, bool)) -> Option<StreamByte> {
        let (clock_before, data_before) = (self.clock, self.data);
        (self.clock, self.data) = (clock, data);
        if clock_before && clock && data != data_before {
            self.kind = if data { ByteOf::Others } else { ByteOf::Address };
            self.bits = 0;
            return None;
        }
        if clock_before || !clock {
            return None;
        }
        self.bits += 1;
        if self.bits <= 8 {
            self.byte = self.byte << 1 | u8::from(data);
            // Said is what has left, whether the master gets to acknowledge it or not.
            let is_said = self.bits == 8 && self.kind == ByteOf::Sent && self.register == STREAM;
            return is_said.then_some(StreamByte::Said(self.byte));
        }
        self.bits = 0;
        self.end(!data)
    }

    /// A byte and its acknowledge are over.
    fn end(&mut self, acknowledged: bool) -> Option<StreamByte> {
        let byte = self.byte;
        match self.kind {
            ByteOf::Address if byte >> 1 == ADDRESS && acknowledged => {
                self.kind = if byte & 1 == 0 {
                    ByteOf::Register
                } else {
                    ByteOf::Sent
                };
                None
            }
            ByteOf::Register if acknowledged => {
                self.register = byte;
                self.kind = ByteOf::Written;
                None
            }
            ByteOf::Written if acknowledged && self.register == STREAM => Some(StreamByte::Heard(byte)),
            ByteOf::Address | ByteOf::Register | ByteOf::Written | ByteOf::Sent if !acknowledged => {
                self.kind = ByteOf::Others;
                None
            }
            ByteOf::Others | ByteOf::Address | ByteOf::Register | ByteOf::Written | ByteOf::Sent => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BusListener, StreamByte};

    /// Levels of a transfer, as clock and data.
    struct Lines(Vec<(bool, bool)>);

    impl Lines {
        fn start(&mut self) {
            self.0
                .extend([(false, true), (true, true), (true, false), (false, false)]);
        }

        fn byte(&mut self, byte: u8, acknowledged: bool) {
            let bits = (0..8).rev().map(|bit| byte >> bit & 1 != 0);
            for level in bits.chain([!acknowledged]) {
                self.0.extend([(false, level), (true, level), (false, level)]);
            }
        }

        fn stop(&mut self) {
            self.0.extend([(false, false), (true, false), (true, true)]);
        }
    }

    #[test]
    fn only_the_stream_of_the_robot_is_told() {
        let mut lines = Lines(Vec::new());
        for (address, register) in [(0x2A, 0), (0x2B, 1), (0x2A, 1)] {
            lines.start();
            lines.byte(address << 1, true);
            lines.byte(register, true);
            lines.byte(7, true);
            lines.byte(8, false);
            lines.stop();
        }
        lines.start();
        lines.byte(0x2A << 1, true);
        lines.byte(1, true);
        lines.start();
        lines.byte(0x2A << 1 | 1, true);
        lines.byte(9, true);
        lines.byte(10, false);
        lines.byte(11, false);
        lines.stop();
        let mut listener = BusListener::default();
        let told: Vec<_> = lines
            .0
            .iter()
            .filter_map(|(clock, data)| listener.look((*clock, *data)))
            .collect();
        let expected = [StreamByte::Heard(7), StreamByte::Said(9), StreamByte::Said(10)];
        assert_eq!(told, expected);
    }
}
