//! What people may call rooms, zones, floors and schedules: one rule, for whoever asks for a name.

/// Longest name, in characters.
pub const NAME_CHARS_MAX: usize = 40;

/// What is wrong with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameProblem {
    /// It has so many characters, which are too many.
    TooLong {
        /// How many.
        chars: usize,
    },
    /// It holds a sign that nobody sees, or that turns the direction of others: two names would look alike.
    Invisible {
        /// Which.
        sign: char,
    },
    /// It is a number, and would be taken for the number of something else.
    OnlyDigits,
}

/// What is wrong with this name, blanks around it aside. Nothing is wrong with an empty one: it may mean none.
#[must_use]
pub fn name_problem(name: &str) -> Option<NameProblem> {
    let name = name.trim();
    let chars = name.chars().count();
    if let Some(sign) = name.chars().find(|sign| is_invisible(*sign)) {
        return Some(NameProblem::Invisible { sign });
    }
    if chars > NAME_CHARS_MAX {
        return Some(NameProblem::TooLong { chars });
    }
    let is_number = chars > 0 && name.chars().all(char::is_numeric);
    is_number.then_some(NameProblem::OnlyDigits)
}

/// Signs of control, of no width, of direction, and those that only tag others; by the Unicode standard, "Default Ignorable Code
/// Point" and "Bidi Control".
fn is_invisible(sign: char) -> bool {
    sign.is_control()
        || matches!(
            sign,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
            | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fff8}'
            | '\u{e0000}'..='\u{e0fff}'
        )
}

#[cfg(test)]
mod tests {
    use super::{NAME_CHARS_MAX, NameProblem, name_problem};

    #[test]
    fn names_that_people_can_tell_apart() {
        for good in ["Köök", " Kitchen ", "", "Room 6", "厨房", "2nd floor"] {
            assert_eq!(name_problem(good), None, "{good:?}");
        }
        assert_eq!(name_problem(&"W".repeat(NAME_CHARS_MAX)), None);
        assert_eq!(
            name_problem(&"W".repeat(41)),
            Some(NameProblem::TooLong { chars: 41 })
        );
        for number in ["6", " 12 ", "٣"] {
            assert_eq!(name_problem(number), Some(NameProblem::OnlyDigits), "{number:?}");
        }
        for sign in ['\n', '\u{200b}', '\u{202e}', '\u{2066}', '\u{feff}', '\u{ad}'] {
            let name = ["Hall", "way"].join(sign.encode_utf8(&mut [0; 4]));
            assert_eq!(name_problem(&name), Some(NameProblem::Invisible { sign }));
        }
    }
}
