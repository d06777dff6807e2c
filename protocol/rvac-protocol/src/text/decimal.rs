//! Numbers, exactly: JSON spelling to integers and back, without floating point.

use crate::span::Span;

/// A number as JSON spells it: `mantissa * 10^exponent`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decimal {
    negative: bool,
    mantissa: u64,
    exponent: i32,
}

/// Digits that always fit into 64 bits. Further digits are below any resolution of the wire and only count as places.
const DIGITS_MAX: u32 = 18;
/// Far beyond any number of the wire, far below an overflow.
const EXPONENT_MAX: i32 = 10_000;

const POWERS: [u64; 20] = {
    let mut powers = [1; 20];
    let mut index = 1;
    while index < 20 {
        powers[index] = powers[index - 1] * 10;
        index += 1;
    }
    powers
};

impl Decimal {
    /// Reads the number at the beginning of `bytes`; gives it and its length. `None` if JSON has no such number.
    pub(crate) fn read(bytes: &[u8]) -> Option<(Self, usize)> {
        let mut reader = DecimalReader {
            bytes,
            at: 0,
            digits: 0,
            number: Self {
                negative: bytes.first() == Some(&b'-'),
                mantissa: 0,
                exponent: 0,
            },
        };
        reader.at = usize::from(reader.number.negative);
        reader.integer()?;
        if reader.peek() == Some(b'.') {
            reader.at += 1;
            reader.fraction()?;
        }
        if matches!(reader.peek(), Some(b'e' | b'E')) {
            reader.at += 1;
            reader.exponent()?;
        }
        Some((reader.number, reader.at))
    }

    /// The nearest integer in counts of `span` (halves away from zero); `None` if it is out of the span.
    pub(crate) fn within(self, span: Span) -> Option<i64> {
        let magnitude = i64::try_from(self.scaled(i32::from(span.decimals))?).ok()?;
        let value = if self.negative { -magnitude } else { magnitude };
        span.contains(value).then_some(value)
    }

    fn scaled(self, decimals: i32) -> Option<u64> {
        if self.mantissa == 0 {
            return Some(0);
        }
        let exponent = self.exponent + decimals;
        let power = POWERS.get(exponent.unsigned_abs() as usize).copied();
        if exponent >= 0 {
            return self.mantissa.checked_mul(power?);
        }
        let Some(power) = power else {
            return Some(0);
        };
        let quotient = self.mantissa / power;
        let remainder = self.mantissa % power;
        Some(quotient + u64::from(remainder >= power - remainder))
    }
}

struct DecimalReader<'a> {
    bytes: &'a [u8],
    at: usize,
    digits: u32,
    number: Decimal,
}

impl DecimalReader<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn digit(&mut self) -> Option<u8> {
        let digit = self.peek()?.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        self.at += 1;
        Some(digit)
    }

    /// Appends a digit to the mantissa; returns whether it fitted.
    fn take(&mut self, digit: u8) -> bool {
        if self.digits == DIGITS_MAX {
            return false;
        }
        self.number.mantissa = self.number.mantissa * 10 + u64::from(digit);
        self.digits += u32::from(self.number.mantissa != 0);
        true
    }

    fn integer(&mut self) -> Option<()> {
        let first = self.digit()?;
        self.take(first);
        if first == 0 {
            // JSON has no leading zeros.
            return self
                .peek()
                .is_none_or(|next| !next.is_ascii_digit())
                .then_some(());
        }
        while let Some(digit) = self.digit() {
            if !self.take(digit) {
                self.number.exponent += 1;
            }
        }
        Some(())
    }

    fn fraction(&mut self) -> Option<()> {
        let begin = self.at;
        while let Some(digit) = self.digit() {
            if self.take(digit) {
                self.number.exponent -= 1;
            }
        }
        (self.at > begin).then_some(())
    }

    fn exponent(&mut self) -> Option<()> {
        let negative = self.peek() == Some(b'-');
        if negative || self.peek() == Some(b'+') {
            self.at += 1;
        }
        let mut exponent = i32::from(self.digit()?);
        while let Some(digit) = self.digit() {
            exponent = (exponent * 10 + i32::from(digit)).min(EXPONENT_MAX);
        }
        self.number.exponent += if negative { -exponent } else { exponent };
        Some(())
    }
}

/// Most characters of a number: a sign, twenty digits, a point, and a zero before it.
const SPELLING_MAX: usize = 24;

/// The spelling of a number. It grows from the last character to the first, in the order in which division yields
/// digits.
pub(crate) struct Spelling {
    bytes: [u8; SPELLING_MAX],
    begin: usize,
}

impl Spelling {
    pub(crate) fn as_bytes(&self) -> &[u8] {
        self.bytes.get(self.begin..).unwrap_or_default()
    }

    /// Prepends `byte`. There is room for every number.
    fn prepend(&mut self, byte: u8) {
        let slot = self.bytes.get_mut(..self.begin).and_then(<[u8]>::last_mut);
        if let Some(slot) = slot {
            *slot = byte;
            self.begin -= 1;
        }
    }
}

/// Spells `value` counts with `decimals` places: the shortest exact spelling.
pub(crate) fn spell(value: i64, decimals: u8) -> Spelling {
    let mut spelling = Spelling {
        bytes: [0; SPELLING_MAX],
        begin: SPELLING_MAX,
    };
    let mut rest = value.unsigned_abs();
    let mut places = decimals;
    while places > 0 && rest.is_multiple_of(10) {
        rest /= 10;
        places -= 1;
    }
    for _ in 0..places {
        spelling.prepend(b'0' + (rest % 10) as u8);
        rest /= 10;
    }
    if places > 0 {
        spelling.prepend(b'.');
    }
    spelling.prepend(b'0' + (rest % 10) as u8);
    rest /= 10;
    while rest > 0 {
        spelling.prepend(b'0' + (rest % 10) as u8);
        rest /= 10;
    }
    if value < 0 {
        spelling.prepend(b'-');
    }
    spelling
}

#[cfg(test)]
mod tests {
    use super::{Decimal, spell};
    use crate::span;

    #[track_caller]
    fn check(spelling: &str, decimals: u8, expected: Option<i64>) {
        let span = span::Span {
            decimals,
            min: i64::MIN,
            max: i64::MAX,
        };
        let read = Decimal::read(spelling.as_bytes())
            .filter(|(_, length)| *length == spelling.len())
            .and_then(|(number, _)| number.within(span));
        assert_eq!(read, expected, "{spelling}");
    }

    #[test]
    fn exact_and_rounded() {
        check("0", 6, Some(0));
        check("-0", 6, Some(0));
        check("0.2", 6, Some(200_000));
        check("0.30000000000000004", 6, Some(300_000));
        check("0.0000005", 6, Some(1));
        check("0.00000049999999999999999999999", 6, Some(0));
        check("-1.5", 0, Some(-2));
        check("2.5E-1", 2, Some(25));
        check("1e3", 3, Some(1_000_000));
        check("1e-999999999999", 6, Some(0));
        check("123456789012345678901234567890e-20", 0, Some(1_234_567_890));
        check("0.000000000000000000000000000001e30", 0, Some(1));
    }

    #[test]
    fn what_is_no_number_or_too_large() {
        for spelling in [
            "", "-", "+1", ".5", "1.", "01", "1e", "1e+", "nan", "NaN", "Infinity", "0x10", "1_0", "--1",
        ] {
            check(spelling, 0, None);
        }
        check("1e999", 0, None);
        check("99999999999999999999", 0, None);
        assert_eq!(
            Decimal::read(b"2.000001").and_then(|(number, _)| number.within(span::SPEED)),
            None
        );
    }

    #[test]
    fn spelling_is_short_and_exact() {
        for (value, decimals, spelling) in [
            (0, 6, "0"),
            (200_000, 6, "0.2"),
            (-1, 6, "-0.000001"),
            (1_000_000, 6, "1"),
            (-2_147_483_648, 6, "-2147.483648"),
            (4_294_967_295, 0, "4294967295"),
            (-120, 0, "-120"),
            (i64::MIN, 9, "-9223372036.854775808"),
        ] {
            assert_eq!(spell(value, decimals).as_bytes(), spelling.as_bytes());
        }
    }
}
