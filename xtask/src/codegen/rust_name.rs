//! Names and numbers of data files as Rust writes them.

/// `wheel-track` becomes `WheelTrack`.
pub(in crate::codegen) fn camel(name: &str) -> String {
    let mut out = String::new();
    for part in name.split('-') {
        let mut letters = part.chars();
        out.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        out.push_str(letters.as_str());
    }
    out
}

/// `wheel-track` becomes `WHEEL_TRACK`.
pub(in crate::codegen) fn constant(name: &str) -> String {
    name.replace(['-', '.'], "_").to_ascii_uppercase()
}

/// `500000` becomes `500_000`.
pub(in crate::codegen) fn number(value: impl Into<i64>) -> String {
    let value: i64 = value.into();
    let digits = value.unsigned_abs().to_string();
    let mut out = String::from(if value < 0 { "-" } else { "" });
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push('_');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{camel, constant, number};

    #[test]
    fn names_and_numbers_take_the_form_of_rust() {
        assert_eq!(camel("button-ladder-1"), "ButtonLadder1");
        assert_eq!(constant("button-ladder-1"), "BUTTON_LADDER_1");
        assert_eq!(
            [0, 7, 1_023, -50_000, 1_000_000_i64].map(number),
            ["0", "7", "1_023", "-50_000", "1_000_000"]
        );
    }
}
