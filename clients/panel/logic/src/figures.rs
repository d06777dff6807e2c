//! Figures as people read them.

use crate::words::Words;

/// `4:05` or `1:04:05`.
#[must_use]
pub fn clock_text(seconds: f64) -> String {
    let whole = seconds.max(0.0) as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

/// Square metres with one decimal.
#[must_use]
pub fn area_text(words: &Words, area_m2: f64) -> String {
    words.unit.square_metres.fill([&words.number(area_m2, 1)])
}

/// Metres, or kilometres from 1000 m on.
#[must_use]
pub fn distance_text(words: &Words, metres: f64) -> String {
    if metres >= 1000.0 {
        words.unit.kilometres.fill([&words.number(metres / 1000.0, 2)])
    } else {
        words.unit.metres.fill([&words.number(metres, 0)])
    }
}

/// Percent without decimals; 100 only when it is whole.
#[must_use]
pub fn percent_text(words: &Words, share: f64) -> String {
    let percent = share.clamp(0.0, 1.0) * 100.0;
    let shown = if percent < 100.0 {
        percent.min(99.0)
    } else {
        percent
    };
    words.unit.percent.fill([&words.number(shown, 0)])
}

/// A round length whose bar is at most 120 pixels wide at `scale` pixels per metre: its name and its width in pixels.
#[must_use]
pub fn scale_bar(words: &Words, scale: f64) -> (String, f64) {
    const LENGTHS_M: [f64; 10] = [50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05];
    let length = LENGTHS_M
        .into_iter()
        .find(|length| length * scale <= 120.0)
        .unwrap_or(0.05);
    let name = if length >= 1.0 {
        words.unit.metres.fill([&words.number(length, 0)])
    } else {
        words.unit.centimetres.fill([&words.number(length * 100.0, 0)])
    };
    (name, length * scale)
}

#[cfg(test)]
mod tests {
    use super::{area_text, clock_text, distance_text, percent_text, scale_bar};
    use crate::words::{Language, Words};

    const ENGLISH: &Words = Language::English.words();

    #[test]
    fn figures_read_well() {
        assert_eq!(clock_text(0.9), "0:00");
        assert_eq!(clock_text(245.0), "4:05");
        assert_eq!(clock_text(3845.0), "1:04:05");
        assert_eq!(area_text(ENGLISH, 12.34), "12.3\u{a0}m²");
        assert_eq!(distance_text(ENGLISH, 999.4), "999\u{a0}m");
        assert_eq!(distance_text(ENGLISH, 1234.0), "1.23\u{a0}km");
        assert_eq!(distance_text(Language::Estonian.words(), 1234.0), "1,23\u{a0}km");
        assert_eq!(percent_text(ENGLISH, 0.996), "99\u{a0}%");
        assert_eq!(percent_text(ENGLISH, 1.0), "100\u{a0}%");
    }

    #[test]
    fn the_scale_bar_is_round_and_fits() {
        assert_eq!(scale_bar(ENGLISH, 100.0), ("1\u{a0}m".to_owned(), 100.0));
        assert_eq!(scale_bar(ENGLISH, 130.0), ("50\u{a0}cm".to_owned(), 65.0));
        for scale in [2.0, 7.0, 33.0, 400.0, 1000.0] {
            let (_, width) = scale_bar(ENGLISH, scale);
            assert!((40.0..=120.0).contains(&width), "{scale} {width}");
        }
    }
}
