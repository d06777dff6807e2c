//! Numbers in the names of kept files: they rise by one with each file, so the highest is the newest, whatever a clock says.

/// Highest number that counts: one file a second takes thirty thousand years to get there. A file with a higher number is not ours,
/// and must not use the numbers up.
const NUMBER_MAX: u64 = 999_999_999_999;

/// The number in a name that is nothing but digits before `ending`.
pub(crate) fn number(name: &str, ending: &str) -> Option<u64> {
    let digits = name.strip_suffix(ending)?;
    let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_plain)?;
    (number <= NUMBER_MAX).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn only_numbers_that_leave_room_for_more_count() {
        assert_eq!(number("000042.map", ".map"), Some(42));
        assert_eq!(number("999999999999.map", ".map"), Some(999_999_999_999));
        for name in [
            "1000000000000.map",
            "18446744073709551615.map",
            "+5.map",
            ".map",
            "my copy.map",
            "000042.json",
        ] {
            assert_eq!(number(name, ".map"), None, "{name}");
        }
    }
}
