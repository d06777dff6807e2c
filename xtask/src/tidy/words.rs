//! Words of unfinished work.

use super::Finding;
use super::files::Files;
use super::rust_text::code;

/// Kinds of files that people write.
const WRITTEN: [&str; 14] = [
    ".rs",
    ".toml",
    ".md",
    ".sh",
    ".c",
    ".h",
    ".raku",
    ".rakutest",
    ".css",
    ".html",
    ".js",
    ".json",
    ".service",
    ".ci/run",
];

/// Words that may stand nowhere. Put together here so that this file does not hold them.
const NOTES: [&str; 3] = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];

/// Macros that may not stand in code.
const MACROS: [&str; 3] = [
    concat!("to", "do!"),
    concat!("unimpl", "emented!"),
    concat!("db", "g!"),
];

/// Looks for them.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for (path, text) in files.texts(&WRITTEN) {
        find(&mut found, path, text, &NOTES);
        if path.ends_with(".rs") {
            find(&mut found, path, &code(text), &MACROS);
        }
    }
    Ok(Finding::Checked(found))
}

fn find(found: &mut Vec<String>, path: &str, text: &str, words: &[&str]) {
    for (number, line) in text.lines().enumerate() {
        for word in words.iter().filter(|word| holds(line, word)) {
            found.push(format!(
                "{path}:{}: {word}: finish it, or write an issue and take the note out",
                number + 1
            ));
        }
    }
}

/// Whether the word stands there by itself.
fn holds(line: &str, word: &str) -> bool {
    let part_of_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    line.match_indices(word).any(|(at, _)| {
        let before = line.get(..at).and_then(|text| text.chars().next_back());
        let after = line.get(at + word.len()..).and_then(|text| text.chars().next());
        let stands_after = word.ends_with('!') || !after.is_some_and(part_of_word);
        stands_after && !before.is_some_and(part_of_word)
    })
}

#[cfg(test)]
mod tests {
    use super::{NOTES, holds};

    #[test]
    fn only_whole_words_count() {
        assert!(holds(&format!("// {}: later", NOTES[0]), NOTES[0]));
        assert!(!holds(&format!("{}S of others", NOTES[0]), NOTES[0]));
    }
}
