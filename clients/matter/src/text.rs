//! Texts of the length that Matter allows.

/// The longest text of an error or of an answer, bytes; by the cluster specifications.
pub(crate) const DETAILS_BYTES_MAX: usize = 64;
/// The longest text of an answer of the cluster ServiceArea, bytes.
pub(crate) const AREA_TEXT_BYTES_MAX: usize = 256;
/// The longest name of an area, bytes.
pub(crate) const NAME_BYTES_MAX: usize = 128;

/// Put where a text was cut.
const CUT: &str = "...";

/// The text, or as many of its first words as fit.
pub(crate) fn cut(text: &str, bytes_max: usize) -> String {
    if text.len() <= bytes_max {
        return text.to_owned();
    }
    let room = bytes_max.saturating_sub(CUT.len());
    let ends = text.char_indices().map(|(at, _)| at).filter(|at| *at <= room);
    let fits = ends.last().and_then(|end| text.get(..end)).unwrap_or_default();
    let whole_words = fits.rsplit_once(' ').map_or(fits, |(words, _)| words);
    format!("{}{CUT}", whole_words.trim_end_matches(['.', ',', ' ']))
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn a_text_is_cut_between_words_and_never_within_a_letter() {
        assert_eq!(cut("The job is done.", 16), "The job is done.");
        assert_eq!(cut("The job is done.", 15), "The job is...");
        assert_eq!(cut("ÖÖÖÖÖÖ", 7), "ÖÖ...");
        for bytes_max in 0..40 {
            assert!(cut("Lift it, and put it flat on the floor.", bytes_max).len() <= bytes_max.max(3));
        }
    }
}
