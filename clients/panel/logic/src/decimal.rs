//! Decimal numbers in text. The standard library reads any number to the last bit, and brings tables of 10 kB for it, which every first
//! visit would load; what people type and what the page keeps has a few digits.

/// Digits that are taken exactly; further ones only count for the place of the point. 10^18 fits into 64 bits.
const DIGITS_MAX: u32 = 18;
/// The largest power of ten that a floating point number holds exactly.
const EXACT_POWER_MAX: i32 = 22;

/// A finite number as people and browsers write it: `-0.25`, `.5`, `3`, `1e-3`. Up to fifteen digits it is the nearest one that there is.
#[must_use]
pub fn read_decimal(text: &str) -> Option<f64> {
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i16>().ok()?),
        None => (text, 0),
    };
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    if whole.is_empty() && part.is_empty() {
        return None;
    }
    let mut kept: u64 = 0;
    let mut count = 0;
    let mut power = i32::from(exponent);
    for (digit, is_part) in whole
        .chars()
        .map(|digit| (digit, false))
        .chain(part.chars().map(|digit| (digit, true)))
    {
        let digit = digit.to_digit(10)?;
        if count < DIGITS_MAX {
            kept = kept * 10 + u64::from(digit);
            count += u32::from(kept > 0);
            power -= i32::from(is_part);
        } else {
            power += i32::from(!is_part);
        }
    }
    let number = scaled(kept as f64, power);
    number.is_finite().then_some(sign * number)
}

/// The number times ten to this power. One step is exact to the last bit; more are not needed for what anybody types.
fn scaled(mut number: f64, mut power: i32) -> f64 {
    while power > 0 && number != 0.0 && number.is_finite() {
        let step = power.min(EXACT_POWER_MAX);
        number *= 10.0_f64.powi(step);
        power -= step;
    }
    while power < 0 && number != 0.0 {
        let step = (-power).min(EXACT_POWER_MAX);
        number /= 10.0_f64.powi(step);
        power += step;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::read_decimal;

    #[test]
    fn numbers_as_people_write_them_are_those_of_the_standard_library() {
        for text in [
            "0",
            "-0",
            "3",
            "+3",
            "007",
            ".5",
            "5.",
            "-0.25",
            "0.1",
            "1.005",
            "2.675",
            "59.94",
            "1e3",
            "1E-3",
            "-12.5e+2",
            "123456789.125",
            "0.000001",
            "9007199254740991",
            "0.30000000000000004",
            "1e22",
            "1e-22",
            "0e9999",
        ] {
            let wanted: f64 = text.parse().unwrap();
            let got = read_decimal(text).unwrap_or(f64::NAN);
            assert_eq!(got.to_bits(), wanted.to_bits(), "{text}: {got}");
        }
        for hundredths in -20_000..20_000 {
            let text = format!("{:.2}", f64::from(hundredths) / 100.0);
            assert_eq!(read_decimal(&text), text.parse().ok(), "{text}");
        }
    }

    #[test]
    fn more_digits_than_a_number_has_end_near_it() {
        for text in [
            "3.14159265358979323846264338327950288",
            "123456789012345678901234567890",
            "0.00000000000000000000000000000012345",
        ] {
            let wanted: f64 = text.parse().unwrap();
            let got = read_decimal(text).unwrap();
            assert!((got / wanted - 1.0).abs() < 1e-15, "{text}: {got}");
        }
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        for text in [
            "", "-", ".", "e3", "1e", "1.2.3", "1,5", "nan", "inf", "0x10", "--1", " 1", "1 ", "1e9999",
            "1e99999", "٣",
        ] {
            assert_eq!(read_decimal(text), None, "{text:?}");
        }
    }
}
