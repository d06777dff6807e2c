//! Numbers from outside in sentences for people: whatever was sent, the sentence stays readable.

/// From here on digits say nothing any more.
const LONG: f64 = 1e7;
/// Smaller numbers are not written out either.
const TINY: f64 = 1e-6;

/// The number as a person writes it: `0.25`, `-2`, `1e300`.
#[must_use]
pub fn short_number(number: f64) -> String {
    let size = number.abs();
    if size.is_finite() && size != 0.0 && !(TINY..LONG).contains(&size) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::short_number;

    #[test]
    fn no_number_takes_hundreds_of_digits() {
        let words = [0.25, -2.0, 0.0, 9_999_999.0, 1e300, -1e-300, f64::MAX, f64::NAN].map(short_number);
        assert_eq!(
            words,
            [
                "0.25",
                "-2",
                "0",
                "9999999",
                "1e300",
                "-1e-300",
                "1.7976931348623157e308",
                "NaN"
            ]
        );
    }
}
