//! Checks of the texts themselves.

use super::{
    AboutWords, AccessWords, ActionWords, DeviceWords, DriveWords, EvidenceWords, FrameWords, HealthWords,
    HistoryWords, HomeWords, Language, LearntWords, LogWords, MapWords, MixWords, NoticeWords, OfferWords,
    ScheduleWords, SoftwareWords, StateWords, StatusWords, SystemWords, Template, UnitWords,
};

type Texts = [(&'static str, usize, [&'static str; 2])];

const SCREENS: [&Texts; 22] = [
    AboutWords::ALL,
    AccessWords::ALL,
    ActionWords::ALL,
    DeviceWords::ALL,
    DriveWords::ALL,
    EvidenceWords::ALL,
    FrameWords::ALL,
    HealthWords::ALL,
    HistoryWords::ALL,
    HomeWords::ALL,
    LearntWords::ALL,
    LogWords::ALL,
    MapWords::ALL,
    MixWords::ALL,
    NoticeWords::ALL,
    OfferWords::ALL,
    ScheduleWords::ALL,
    SoftwareWords::ALL,
    StateWords::ALL,
    StatusWords::ALL,
    SystemWords::ALL,
    UnitWords::ALL,
];

/// Texts that are the same in both languages: units, forms of lists, and words that Estonian has borrowed.
const SAME: [&str; 21] = [
    "{0} MiB",
    "{0} GiB",
    "{0} km",
    "{0} m",
    "{0} cm",
    "{0} m²",
    "{0} %",
    "± {0}",
    "{0}x",
    "{0}. {1}",
    "{0}, {1} A",
    "{0} V",
    "{0} A",
    "{0} °C",
    "{0} ms",
    "{0} Hz",
    "{0} m/s",
    "{0} kB/s",
    "{0}: {1}.",
    "Robot",
    " (",
];

/// Words that only English has.
const ENGLISH: [&str; 14] = [
    "the", "and", "of", "is", "robot's", "with", "it", "not", "from", "while", "its", "which", "nothing",
    "floor",
];

fn texts() -> impl Iterator<Item = (&'static str, usize, [&'static str; 2])> {
    SCREENS.into_iter().flatten().copied()
}

/// The places of a text, in order.
fn places(text: &str) -> Vec<usize> {
    let mut places: Vec<usize> = text
        .split('{')
        .skip(1)
        .map(|rest| {
            let (place, _) = rest.split_once('}').expect("a place ends");
            place.parse().expect("a place is a number")
        })
        .collect();
    places.sort_unstable();
    places
}

#[test]
fn no_text_is_empty_and_all_have_a_place_for_each_value() {
    for (name, values, both) in texts() {
        for text in both {
            assert!(!text.trim().is_empty(), "{name}");
            assert_eq!(places(text), (0..values).collect::<Vec<_>>(), "{name}: {text}");
        }
    }
}

#[test]
fn estonian_texts_are_translated() {
    for (name, _, [english, estonian]) in texts() {
        assert!(
            english != estonian || SAME.contains(&english),
            "{name} is the same: {english}"
        );
        let word = |word: &str| {
            word.trim_matches(|sign: char| !sign.is_alphabetic())
                .to_lowercase()
        };
        let found = estonian
            .split_whitespace()
            .map(word)
            .find(|word| ENGLISH.contains(&word.as_str()));
        assert_eq!(found, None, "{name} has English in it: {estonian}");
    }
}

#[test]
fn lists_of_days_and_months_are_whole() {
    for language in Language::ALL {
        let unit = &language.words().unit;
        assert_eq!(unit.weekdays.split_whitespace().count(), 7);
        assert_eq!(unit.months.split_whitespace().count(), 12);
    }
}

#[test]
fn values_stand_where_the_text_wants_them() {
    assert_eq!(Template::<2>("{1} of {0}").fill([&7, &"a"]), "a of\u{a0}7");
    assert_eq!(Template::<1>("{0}{9} {").fill([&1.5]), "1.5 {");
    let estonian = Language::Estonian.words();
    assert_eq!(estonian.number(12.345, 1), "12,3");
    assert_eq!(Language::English.words().number(12.345, 1), "12.3");
}

#[test]
fn a_language_is_found_by_its_tag() {
    assert_eq!(Language::of_tag("et-EE"), Some(Language::Estonian));
    assert_eq!(Language::of_tag("EN"), Some(Language::English));
    for other in ["", "de", "eesti", "e"] {
        assert_eq!(Language::of_tag(other), None, "{other}");
    }
}

#[test]
fn a_figure_stays_with_its_unit_and_a_name_with_its_number() {
    let joined = |text: &'static str, values: [&str; 2]| Template::<2>(text).fill([&values[0], &values[1]]);
    for (text, values, wanted) in [
        ("{0} % of {1} m²", ["45", "12,3"], "45\u{a0}% of 12,3\u{a0}m²"),
        ("{0} kB/s, {1} min.", ["7", "3"], "7\u{a0}kB/s, 3\u{a0}min."),
        // Words, figures that are none, and units of something else may stand on two lines.
        ("{0} minutes in {1}", ["7", "3rd"], "7 minutes in 3rd"),
        ("{0} m {1}", ["–", ""], "– m "),
        ("{0} m-long {1}", ["3", "x"], "3 m-long x"),
        ("{0} room {1}", ["the", "12"], "the room\u{a0}12"),
        ("{0} room {1}", ["the", "blue"], "the room blue"),
    ] {
        assert_eq!(joined(text, values), wanted);
    }
    for language in Language::ALL {
        let words = language.words();
        assert_eq!(words.unit.percent.fill([&45]), "45\u{a0}%");
        assert!(!words.home.room.fill([&1]).contains(' '), "{language:?}");
        assert!(!words.home.map.fill([&1]).contains(' '), "{language:?}");
    }
}
