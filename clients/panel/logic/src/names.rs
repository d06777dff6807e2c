//! What is wrong with a name, at the field where it is typed.

use rvac_api::{NAME_CHARS_MAX, NameProblem, name_problem};

use crate::words::Words;

/// As a sentence with what to do; nothing of a good name.
#[must_use]
pub fn name_problem_text(words: &Words, name: &str) -> Option<String> {
    let texts = &words.home;
    name_problem(name).map(|problem| match problem {
        NameProblem::TooLong { chars } => texts.name_long.fill([&chars, &NAME_CHARS_MAX]),
        NameProblem::Invisible { .. } => texts.name_invisible.to_owned(),
        NameProblem::OnlyDigits => texts.name_digits.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::name_problem_text;
    use crate::words::Language;

    #[test]
    fn each_problem_has_a_sentence_in_each_language() {
        for language in Language::ALL {
            let words = language.words();
            for bad in ["W".repeat(60), "a\u{202e}b".to_owned(), "6".to_owned()] {
                assert!(name_problem_text(words, &bad).is_some(), "{bad:?}");
            }
            assert_eq!(name_problem_text(words, "Köök"), None);
        }
        let long = name_problem_text(Language::English.words(), &"W".repeat(41));
        assert_eq!(long.as_deref(), Some("41 characters: at most 40."));
    }
}
