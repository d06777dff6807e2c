//! A name by which browsers may call the server, as a person gives it.

/// Longest label, and longest name (RFC 1035).
const LABEL_MAX: usize = 63;
const NAME_MAX: usize = 253;

/// Reads a name such as `robot.local`. Certificates hold names in ASCII only.
///
/// # Errors
/// A sentence that says what to write instead.
pub(crate) fn parse(text: &str) -> Result<String, String> {
    let name = text.trim_end_matches('.').to_ascii_lowercase();
    if !name.is_ascii() {
        return Err(format!(
            "{text:?} has letters that a certificate cannot hold: give it as browsers send it, beginning with xn--"
        ));
    }
    let is_label = |label: &str| {
        let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-';
        (1..=LABEL_MAX).contains(&label.len())
            && label.chars().all(plain)
            && !label.starts_with('-')
            && !label.ends_with('-')
    };
    if name.len() > NAME_MAX || !name.split('.').all(is_label) {
        return Err(format!(
            "{text:?} is no name of a computer: letters, digits and hyphens with dots between, without port or https://"
        ));
    }
    Ok(name)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn names_are_read_as_browsers_send_them() {
        assert_eq!(parse("Robot.Local."), Ok("robot.local".to_owned()));
        assert_eq!(parse("xn--rbot-5qa.local"), Ok("xn--rbot-5qa.local".to_owned()));
        let long = format!("{}.local", "a".repeat(64));
        for bad in [
            "röbot.local",
            "",
            ".",
            "a..b",
            "-a",
            "a-",
            "a b",
            "https://a",
            "a:80",
            "[::1]",
            &long,
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
