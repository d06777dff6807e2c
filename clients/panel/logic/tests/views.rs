//! The views of the panel hold no text that a person would read: all of it is in the catalogue, in every language.

#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

use std::fs;
use std::path::{Path, PathBuf};

/// Literals that resemble words and are none, or are the same in every language.
const ALLOWED: [&str; 16] = [
    "Notification",
    "rvac doctor",
    "ArrowDown",
    "ArrowLeft",
    "ArrowRight",
    "ArrowUp",
    "DeviceOrientationEvent",
    "End",
    "Enter",
    "Escape",
    "Home",
    "Intl",
    "LibreRVAC",
    "Tab",
    "rvac pair",
    "rvac trust",
];

/// Text before a literal that is not shown: names for the style sheet, words for the developer's console.
const UNREAD: [&str; 5] = [
    "class=",
    "class: ",
    "class=format!(",
    "logging::warn!(",
    "GlError(",
];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

/// Every literal of a line with the text before it.
fn literals(line: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let mut from = None;
    let mut escaped = false;
    for (at, sign) in line.char_indices() {
        match (sign, from) {
            ('"', None) => from = Some(at),
            ('"', Some(start)) if !escaped => {
                found.push((&line[..start], &line[start + 1..at]));
                from = None;
            }
            _ => {}
        }
        escaped = sign == '\\' && !escaped;
    }
    found
}

/// Two words, a word with a capital, or a child of an element.
fn is_read(before: &str, literal: &str) -> bool {
    let is_letter = |sign: Option<char>| sign.is_some_and(char::is_alphabetic);
    let has_two_words = literal.match_indices(' ').any(|(at, _)| {
        is_letter(literal[..at].chars().last()) && is_letter(literal[at + 1..].chars().next())
    });
    let mut signs = literal.chars();
    let is_capital =
        signs.next().is_some_and(char::is_uppercase) && signs.next().is_some_and(char::is_lowercase);
    let before = before.trim_end();
    let is_child = before.ends_with('>') && !before.ends_with("=>");
    has_two_words || is_capital || is_child && literal.chars().any(char::is_alphabetic)
}

fn texts(source: &str) -> Vec<String> {
    let lines = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let found = lines.flat_map(literals).filter(|(before, literal)| {
        is_read(before, literal)
            && !ALLOWED.contains(literal)
            && !UNREAD.iter().any(|unread| before.ends_with(unread))
    });
    found.map(|(_, literal)| literal.to_owned()).collect()
}

#[test]
fn no_view_holds_a_text() {
    let views = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src");
    let sources = sources(&views);
    assert!(sources.len() > 40, "the views are found");
    for path in sources {
        if path.ends_with("map/shaders.rs") {
            continue;
        }
        let texts = texts(&fs::read_to_string(&path).unwrap());
        assert!(
            texts.is_empty(),
            "{}: put into clients/panel/logic/src/words: {texts:?}",
            path.display()
        );
    }
}

#[test]
fn a_text_in_a_view_is_found() {
    for line in [
        r#"<p>"Robot"</p>"#,
        r#"aria-label="Chosen rooms""#,
        r#"format!("{count} rooms left")"#,
        r#"{if on { "On now" } else { "" }}"#,
        r#"<dd>"none"</dd>"#,
    ] {
        assert_eq!(texts(line).len(), 1, "{line}");
    }
    for line in [
        r#"class="small strong""#,
        r#"<button id="start">{words().action.start}</button>"#,
        r#"// "A comment.""#,
        r#"Some("stop") => "idle","#,
    ] {
        assert!(texts(line).is_empty(), "{line}");
    }
}
