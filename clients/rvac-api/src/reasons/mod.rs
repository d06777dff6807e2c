//! What named reasons mean for the person in front of the robot: one wording for the log, the socket, the command line and the
//! English of the panel.

mod catalogue;

use alloc::borrow::ToOwned as _;
use alloc::format;
use alloc::string::String;

pub(crate) use catalogue::CATALOGUE;

/// What a code means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// What is the matter: one whole sentence.
    pub cause: &'static str,
    /// What to do about it; empty when there is nothing to do.
    pub remedy: &'static str,
}

impl Explanation {
    /// Both.
    #[must_use]
    pub fn text(self) -> String {
        format!("{} {}", self.cause, self.remedy).trim_end().to_owned()
    }

    /// The cause for the end of a longer sentence, without its full stop.
    #[must_use]
    pub fn clause(self) -> String {
        let mut letters = self.cause.trim_end_matches('.').chars();
        let first = letters.next().map(|letter| letter.to_ascii_lowercase());
        first.into_iter().chain(letters).collect()
    }
}

const fn entry(code: &'static str, cause: &'static str, remedy: &'static str) -> (&'static str, Explanation) {
    (code, Explanation { cause, remedy })
}

/// The explanation of a code, if it has one.
#[must_use]
pub fn explain(code: &str) -> Option<Explanation> {
    explanations()
        .find(|(known, _)| *known == code)
        .map(|(_, told)| told)
}

/// What to do about a reason; empty when there is nothing to do, or nothing is known to help.
#[must_use]
pub fn remedy(code: &str) -> &'static str {
    explain(code).map_or("", |told| told.remedy)
}

/// Every code with its explanation.
pub fn explanations() -> impl Iterator<Item = (&'static str, Explanation)> {
    CATALOGUE.iter().copied()
}

#[cfg(test)]
mod tests {
    use super::{explain, explanations, remedy};

    #[test]
    fn every_code_is_explained_once_in_whole_sentences() {
        for (index, (code, told)) in explanations().enumerate() {
            assert!(
                explanations().skip(index + 1).all(|(other, _)| other != code),
                "{code} stands twice"
            );
            assert!(told.cause.ends_with('.'), "{code}");
            assert!(told.remedy.is_empty() || told.remedy.ends_with('.'), "{code}");
        }
    }

    #[test]
    fn a_cause_stands_alone_or_ends_a_sentence() {
        let told = explain("wheel-drop").expect("known");
        assert_eq!(
            told.text(),
            "A wheel hangs in the air. Put the robot flat on the floor."
        );
        assert_eq!(told.clause(), "a wheel hangs in the air");
        assert_eq!(remedy("wheel-drop"), "Put the robot flat on the floor.");
        assert_eq!(explain("finished").expect("known").text(), "The job is done.");
        assert_eq!((explain("flux-capacitor"), remedy("flux-capacitor")), (None, ""));
    }
}
