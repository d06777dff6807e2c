//! A time of day as a person types it: on 24 hours, as the page writes it. The browser's own field asks in the hours of the country
//! that it was made for.

/// `07:30` from `7:30`, `7.30`, `0730`, `730` or `7`. `None` for what is no time of day.
#[must_use]
pub fn time_of_day(typed: &str) -> Option<String> {
    let typed = typed.trim();
    let (hours, minutes) = match typed.split_once([':', '.', ' ']) {
        Some((_, minutes)) if minutes.len() != 2 => return None,
        Some(parts) => parts,
        None if !typed.is_ascii() => return None,
        None if typed.len() <= 2 => (typed, "00"),
        None => typed.split_at(typed.len() - 2),
    };
    let number = |digits: &str, below: u8| {
        let is_short = (1..=2).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
        let number: u8 = digits.parse().ok().filter(|_| is_short)?;
        (number < below).then_some(number)
    };
    Some(format!("{:02}:{:02}", number(hours, 24)?, number(minutes, 60)?))
}

#[cfg(test)]
mod tests {
    use super::time_of_day;

    #[test]
    fn short_forms_are_times_on_24_hours() {
        for (typed, meant) in [
            ("07:30", "07:30"),
            ("7:30", "07:30"),
            ("19.05", "19:05"),
            ("21 45", "21:45"),
            (" 0730 ", "07:30"),
            ("730", "07:30"),
            ("7", "07:00"),
            ("00:00", "00:00"),
            ("2359", "23:59"),
        ] {
            assert_eq!(time_of_day(typed).as_deref(), Some(meant), "{typed}");
        }
    }

    #[test]
    fn what_is_no_time_of_day_is_not_guessed() {
        for typed in [
            "", "24:00", "12:60", "7:5", "7:300", "07:30:00", "7:30 PM", "12345", "+7", "7:+5", "½", "aa",
            ":30",
        ] {
            assert_eq!(time_of_day(typed), None, "{typed}");
        }
    }
}
