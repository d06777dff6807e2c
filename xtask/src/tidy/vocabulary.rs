//! One vocabulary: retired words do not come back, and within a crate a type's name means one thing.
//!
//! The glossary of the book holds the retired words as a table. An entry in code font is an identifier: it is matched as a whole word
//! with its case, in code and comments alike. Any other entry is a phrase: it is matched without regard to case.

use super::Finding;
use super::files::Files;
use super::rust_text::{code, test_lines};
use anyhow::Context;
use std::collections::BTreeMap;

/// Where the retired words are listed.
const GLOSSARY: &str = "docs/book/src/glossary.md";
/// Title of their part of it.
const TITLE: &str = "## Retired words";
/// Files that name retired words on purpose: the list itself, and figures in the words of their day.
const EXEMPT: [&str; 2] = [GLOSSARY, "docs/book/src/measurements/archive.md"];
/// Kinds of files that are read.
const WRITTEN: [&str; 4] = [".rs", ".md", ".c", ".h"];

/// A word that is not used any more, and what to say instead.
#[derive(Debug, PartialEq, Eq)]
struct Retired {
    word: String,
    is_identifier: bool,
    say: String,
}

/// Looks for retired words.
pub(super) fn retired(files: &Files) -> anyhow::Result<Finding> {
    let glossary = files.text(GLOSSARY).context("the glossary is missing")?;
    let retired = table(glossary);
    anyhow::ensure!(
        !retired.is_empty(),
        "{GLOSSARY} lists no retired words below {TITLE:?}"
    );
    let mut found = Vec::new();
    for (path, text) in files.texts(&WRITTEN).filter(|(path, _)| !EXEMPT.contains(path)) {
        for (number, line) in text.lines().enumerate() {
            for entry in retired.iter().filter(|entry| entry.stands_in(line)) {
                let Retired { word, say, .. } = entry;
                found.push(format!("{path}:{}: {word} is retired, say {say}", number + 1));
            }
        }
    }
    Ok(Finding::Checked(found))
}

/// The first table below the title.
fn table(glossary: &str) -> Vec<Retired> {
    let below = glossary.split_once(TITLE).map_or("", |(_, below)| below);
    let rows = below
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'));
    rows.skip(2).filter_map(Retired::parse).collect()
}

impl Retired {
    fn parse(row: &str) -> Option<Self> {
        let mut cells = row.trim_matches('|').split('|').map(str::trim);
        let (word, say) = (cells.next()?, cells.next()?);
        let bare = word.trim_matches('`');
        let is_identifier = bare != word;
        (!bare.is_empty()).then(|| Self {
            word: if is_identifier {
                bare.to_owned()
            } else {
                bare.to_lowercase()
            },
            is_identifier,
            say: say.to_owned(),
        })
    }

    fn stands_in(&self, line: &str) -> bool {
        if self.is_identifier {
            holds_word(line, &self.word)
        } else {
            holds_word(&line.to_lowercase(), &self.word)
        }
    }
}

/// Whether the word stands in the line by itself, not as a part of a longer word.
fn holds_word(line: &str, word: &str) -> bool {
    let is_part =
        |letter: Option<char>| letter.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    line.match_indices(word).any(|(at, _)| {
        let before = line.get(..at).and_then(|text| text.chars().next_back());
        let after = line.get(at + word.len()..).and_then(|text| text.chars().next());
        !is_part(before) && !is_part(after)
    })
}

/// Looks for type names that a crate declares more than once outside of tests.
pub(super) fn homonyms(files: &Files) -> anyhow::Result<Finding> {
    let crates: Vec<&str> = files
        .all()
        .filter_map(|file| file.path.strip_suffix("/Cargo.toml"))
        .collect();
    let mut places: BTreeMap<(&str, String), Vec<String>> = BTreeMap::new();
    for (path, text) in files.texts(&[".rs"]) {
        let Some(of) = crate_of(&crates, path) else {
            continue;
        };
        // Two in one file are the forms of one type under different features.
        let mut declared = declared(text);
        declared.dedup_by(|(name, _), (before, _)| name == before);
        for (name, line) in declared {
            places
                .entry((of, name))
                .or_default()
                .push(format!("{path}:{line}"));
        }
    }
    let found = places.into_iter().filter(|(_, places)| places.len() > 1);
    Ok(Finding::Checked(
        found
            .map(|((_, name), places)| format!("{name} names {} things: {}", places.len(), places.join(", ")))
            .collect(),
    ))
}

/// The folder of the crate to which the file belongs. Each program in `src/bin` is a crate of its own; tests, examples and benches do
/// not count.
fn crate_of<'a>(crates: &[&'a str], path: &'a str) -> Option<&'a str> {
    let inside = |of: &&&str| {
        path.strip_prefix(**of)
            .is_some_and(|rest| rest.starts_with("/src/"))
    };
    let of = crates.iter().filter(inside).max_by_key(|of| of.len())?;
    let is_test = path.ends_with("tests.rs") || path.contains("/tests/");
    (!is_test).then(|| program_of(path, of).unwrap_or(of))
}

/// The file or folder of the program in `src/bin` to which the file belongs.
fn program_of<'a>(path: &'a str, of: &str) -> Option<&'a str> {
    let bin = of.len() + "/src/bin/".len();
    let name = path
        .get(bin..)
        .filter(|_| path.get(of.len()..bin) == Some("/src/bin/"))?;
    path.get(..bin + name.find('/').unwrap_or(name.len()))
}

/// Types that the file declares at its top level outside of tests, with their lines from 1.
fn declared(text: &str) -> Vec<(String, usize)> {
    let plain = code(text);
    let tests = test_lines(&plain);
    let lines = plain.lines().zip(tests).enumerate();
    lines
        .filter(|(_, (_, is_test))| !is_test)
        .filter_map(|(number, (line, _))| Some((type_name(line)?, number + 1)))
        .collect()
}

fn type_name(line: &str) -> Option<String> {
    let mut words = line.split(' ');
    let mut word = words.next()?;
    if word.starts_with("pub") {
        word = words.next()?;
        // `pub(in path)` is two words.
        if word.ends_with(')') {
            word = words.next()?;
        }
    }
    if !["struct", "enum", "trait", "type", "union"].contains(&word) {
        return None;
    }
    let name = words.next()?;
    let end = name.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
    name.get(..end.unwrap_or(name.len())).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::{Retired, crate_of, declared, table};

    const GLOSSARY: &str = "\
# Glossary\n\n| term | meaning |\n| --- | --- |\n| pose | x |\n\n## Retired words\n\nThey do not come back.\n\n\
| retired | say |\n| --- | --- |\n| `Gadget` | `Device` |\n| Put by | saved |\n\nOthers:\n\n\
| item | retired | say |\n| --- | --- | --- |\n| a | `Plan` | b |\n";

    #[test]
    fn only_the_first_table_below_the_title_is_read() {
        let words: Vec<(String, bool)> = table(GLOSSARY)
            .into_iter()
            .map(
                |Retired {
                     word, is_identifier, ..
                 }| (word, is_identifier),
            )
            .collect();
        assert_eq!(words, [("Gadget".to_owned(), true), ("put by".to_owned(), false)]);
    }

    #[test]
    fn identifiers_are_matched_whole_with_their_case_and_phrases_in_any_case() {
        let retired = table(GLOSSARY);
        let found = |line: &str| retired.iter().filter(|entry| entry.stands_in(line)).count();
        assert_eq!(found("struct Gadget {"), 1);
        assert_eq!(found("let gadget = Gadgets::new()"), 0);
        assert_eq!(found("// Put by, and put by again"), 1);
        assert_eq!(found("// put bystanders"), 0);
    }

    #[test]
    fn types_of_tests_do_not_count() {
        let text = "pub(crate) struct One<T>;\npub enum Two {}\ntype Three = u8;\nfn f() {}\n\
                    #[cfg(test)]\nmod tests {\n    struct Four;\n}\n";
        let names: Vec<String> = declared(text).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["One", "Two", "Three"]);
    }

    #[test]
    fn a_file_belongs_to_the_innermost_crate() {
        let crates = ["vthal", "vthal/core"];
        assert_eq!(crate_of(&crates, "vthal/core/src/lib.rs"), Some("vthal/core"));
        assert_eq!(crate_of(&crates, "vthal/src/main.rs"), Some("vthal"));
        assert_eq!(
            crate_of(&crates, "vthal/src/bin/bench/main.rs"),
            Some("vthal/src/bin/bench")
        );
        assert_eq!(crate_of(&crates, "vthal/tests/all/main.rs"), None);
        assert_eq!(crate_of(&crates, "vthal/src/radio/tests.rs"), None);
    }
}
