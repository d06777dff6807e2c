//! How the kernel lays out the samples of a sensor's buffer (Documentation/iio/iio_devbuf.rst of Linux).

/// Byte order of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Little,
    Big,
}

/// Type of one element as its `_type` file gives it, for example `be:s16/16>>0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ScanType {
    order: Order,
    signed: bool,
    bits: u32,
    storage_bytes: usize,
    shift: u32,
}

impl ScanType {
    /// Reads the text of a `_type` file; `None` when it is none, or repeats its element (`X2`), which rates never do.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let (order, rest) = text.trim().split_once(':')?;
        let order = match order {
            "le" => Order::Little,
            "be" => Order::Big,
            _ => return None,
        };
        let signed = match rest.chars().next()? {
            's' => true,
            'u' => false,
            _ => return None,
        };
        let (bits, rest) = rest.get(1..)?.split_once('/')?;
        let (storage, shift) = rest.split_once(">>")?;
        let (bits, storage, shift): (u32, u32, u32) =
            (bits.parse().ok()?, storage.parse().ok()?, shift.parse().ok()?);
        let fits = matches!(storage, 8 | 16 | 32 | 64) && bits > 0 && bits.checked_add(shift)? <= storage;
        fits.then_some(Self {
            order,
            signed,
            bits,
            storage_bytes: storage as usize / 8,
            shift,
        })
    }

    /// The value in the first bytes of `bytes`; `None` when there are too few.
    fn read(self, bytes: &[u8]) -> Option<i64> {
        let stored = bytes.get(..self.storage_bytes)?;
        let join = |word: u64, byte: &u8| (word << 8) | u64::from(*byte);
        let word = match self.order {
            Order::Big => stored.iter().fold(0, join),
            Order::Little => stored.iter().rev().fold(0, join),
        };
        // Moved to the top and back down, so that the sign is carried along and what lies above the value is lost.
        let top = (word >> self.shift) << (64 - self.bits);
        Some(if self.signed {
            (top as i64) >> (64 - self.bits)
        } else {
            (top >> (64 - self.bits)) as i64
        })
    }
}

/// Where rate and time lie in one record. Elements lie in the order of their indices, each aligned to its own size, and
/// the record is aligned to its largest element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    rate: (usize, ScanType),
    time: Option<(usize, ScanType)>,
    record_bytes: usize,
}

impl Layout {
    /// The layout of a buffer in which only the rate and perhaps the time are enabled; the time comes last.
    pub(super) fn new(rate: ScanType, time: Option<ScanType>) -> Self {
        let time_size = time.map_or(1, |time| time.storage_bytes);
        let time = time.map(|time| (rate.storage_bytes.next_multiple_of(time_size), time));
        let end = time.map_or(rate.storage_bytes, |(offset, time)| offset + time.storage_bytes);
        Self {
            rate: (0, rate),
            time,
            record_bytes: end.next_multiple_of(rate.storage_bytes.max(time_size)),
        }
    }

    /// Size of a record.
    pub(super) const fn record_bytes(&self) -> usize {
        self.record_bytes
    }

    /// Raw rate and time in nanoseconds (if the buffer has it) of one record.
    pub(super) fn read(&self, record: &[u8]) -> Option<(i64, Option<i64>)> {
        let element = |(offset, kind): (usize, ScanType)| kind.read(record.get(offset..)?);
        let rate = element(self.rate)?;
        Some((rate, self.time.and_then(element)))
    }
}

#[cfg(test)]
mod tests {
    use super::{Layout, ScanType};

    fn kind(text: &str) -> ScanType {
        ScanType::parse(text).expect("a type of the kernel")
    }

    #[test]
    fn elements_are_read_as_the_kernel_stores_them() {
        for (text, bytes, value) in [
            ("be:s16/16>>0", &[0xFF, 0xFE][..], -2),
            ("le:s16/16>>0", &[0xFE, 0xFF], -2),
            ("le:u16/16>>0", &[0xFE, 0xFF], 0xFFFE),
            ("le:s12/16>>4", &[0xF0, 0xFF], -1),
            ("be:s12/16>>4", &[0x7F, 0xF5], 0x7FF),
            ("le:s24/32>>8", &[0x55, 0, 0, 0x80], -0x80_0000),
            ("le:s64/64>>0", &[1, 0, 0, 0, 0, 0, 0, 0], 1),
        ] {
            assert_eq!(kind(text).read(bytes), Some(value), "{text}");
        }
        assert_eq!(kind("le:s32/32>>0").read(&[0; 3]), None);
    }

    #[test]
    fn what_is_no_type_is_refused() {
        for text in [
            "",
            "le",
            "xe:s16/16>>0",
            "le:f32/32>>0",
            "le:s16/16",
            "le:s17/16>>0",
            "le:s16/16>>1",
            "le:s0/16>>0",
            "le:s16/16X2>>0",
            "le:s16/24>>0",
        ] {
            assert_eq!(ScanType::parse(text), None, "{text}");
        }
    }

    #[test]
    fn the_time_is_aligned_to_its_own_size() {
        let layout = Layout::new(kind("be:s16/16>>0"), Some(kind("le:s64/64>>0")));
        assert_eq!(layout.record_bytes(), 16);
        let mut record = [0xAA; 16];
        record[..2].copy_from_slice(&(-300_i16).to_be_bytes());
        record[8..].copy_from_slice(&1_000_000_i64.to_le_bytes());
        assert_eq!(layout.read(&record), Some((-300, Some(1_000_000))));
        assert_eq!(layout.read(&record[..15]), Some((-300, None)));
        let bare = Layout::new(kind("be:s16/16>>0"), None);
        assert_eq!(bare.record_bytes(), 2);
    }
}
