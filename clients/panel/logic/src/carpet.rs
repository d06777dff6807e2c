//! The surfaces that the robot has detected, in words.

use crate::figures::area_text;
use crate::words::Words;
use rvac_api::HomeView;

/// How much of the home is carpet, as far as known; nothing without measurements or without a map.
#[must_use]
pub fn carpet_sentence(words: &Words, home: &HomeView) -> Option<String> {
    let texts = &words.home;
    match &home.carpet {
        None if home.cells.is_empty() => None,
        None => Some(texts.carpet_unknown.to_owned()),
        Some(felt) if felt.area_m2 + felt.hard_m2 > 0.0 => {
            let [carpet, hard] = [felt.area_m2, felt.hard_m2].map(|area_m2| area_text(words, area_m2));
            Some(texts.carpet_felt.fill([&carpet, &hard]))
        }
        Some(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::carpet_sentence;
    use crate::words::Language;
    use rvac_api::{CarpetView, HomeView};

    #[test]
    fn what_was_felt_is_shown_and_that_nothing_can_be_felt() {
        let words = Language::English.words();
        let home = |carpet| HomeView {
            cells: vec![1, 4],
            carpet,
            ..HomeView::default()
        };
        let felt = |area_m2, hard_m2| CarpetView {
            area_m2,
            hard_m2,
            ..CarpetView::default()
        };
        assert_eq!(
            carpet_sentence(words, &home(Some(felt(3.3, 20.0)))).as_deref(),
            Some("Carpet detected: 3.3\u{a0}m². Hard floor: 20.0\u{a0}m².")
        );
        assert_eq!(carpet_sentence(words, &home(Some(felt(0.0, 0.0)))), None);
        let blind = carpet_sentence(words, &home(None)).expect("a sentence");
        assert!(blind.contains("does not measure"), "{blind}");
        assert_eq!(carpet_sentence(words, &HomeView::default()), None);
    }
}
