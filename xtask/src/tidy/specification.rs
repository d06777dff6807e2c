//! The specification of the wire, the page about the socket, and the code that speaks them use the same words.

use super::Finding;
use super::files::Files;
use std::collections::BTreeSet;

const SPECIFICATION: &str = "protocol/SPEC.md";
const MESSAGES: &str = "protocol/rvac-protocol/src/message/";

/// Closed sets of messages: the file and the enum, the key that names them, and the document that shows each.
const SETS: [(&str, &str, &str, &str); 3] = [
    (
        "protocol/rvac-protocol/src/message/command.rs",
        "Command",
        "c",
        SPECIFICATION,
    ),
    (
        "clients/rvac-api/src/request.rs",
        "RequestBody",
        "c",
        "docs/book/src/socket-api.md",
    ),
    (
        "clients/rvac-api/src/update.rs",
        "Update",
        "e",
        "docs/book/src/socket-api.md",
    ),
];

/// Every word that the message types put on the wire stands in the specification.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let Some(specification) = files.text(SPECIFICATION) else {
        return Ok(Finding::Checked(vec![format!("{SPECIFICATION} is missing")]));
    };
    let sources: Vec<_> = files
        .texts(&[".rs"])
        .filter(|(path, _)| path.starts_with(MESSAGES))
        .collect();
    let words: BTreeSet<&str> = sources.iter().flat_map(|(_, text)| words(text)).collect();
    let mut found: Vec<String> = words
        .into_iter()
        .filter(|word| !specification.contains(word))
        .map(|word| format!("{SPECIFICATION} does not mention {word:?}, which {MESSAGES} puts on the wire"))
        .collect();
    for (source, set, key, document) in SETS {
        let shown = files.text(document).unwrap_or_default();
        for name in files
            .text(source)
            .map(|text| variants(text, set))
            .unwrap_or_default()
        {
            let shape = format!("\"{key}\":\"{name}\"");
            if !shown.contains(&shape) {
                found.push(format!(
                    "{document} shows no {shape}, but {source} defines it in {set}"
                ));
            }
        }
    }
    Ok(Finding::Checked(found))
}

/// The words in `=> "word"`, which is how a message type names its values.
fn words(source: &str) -> impl Iterator<Item = &str> {
    source
        .lines()
        .filter_map(|line| line.split_once("=> \"")?.1.split_once('"').map(|(word, _)| word))
}

/// The variants of an enum as they are written on the wire.
fn variants(source: &str, set: &str) -> Vec<String> {
    let body = source
        .split_once(&format!("pub enum {set} {{"))
        .map_or("", |(_, after)| after);
    let body = body.split_once("\n}").map_or(body, |(body, _)| body);
    let mut renamed = None;
    let mut found = Vec::new();
    for line in body.lines().filter_map(|line| line.strip_prefix("    ")) {
        if let Some(word) = line.strip_prefix("#[serde(rename = \"") {
            renamed = word.split('"').next().map(str::to_owned);
        } else if line.starts_with(|letter: char| letter.is_ascii_uppercase()) {
            let name = line.split(|letter: char| !letter.is_ascii_alphanumeric()).next();
            found.push(renamed.take().unwrap_or_else(|| kebab(name.unwrap_or_default())));
        }
    }
    found
}

/// `MapDelta` becomes `map-delta`.
fn kebab(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && !out.is_empty() {
            out.push('-');
        }
        out.push(letter.to_ascii_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{variants, words};

    #[test]
    fn variants_and_words_are_found() {
        let source = "pub enum Command {\n    /// Doc.\n    Hello(HostHello),\n    #[serde(rename = \"halt\")]\n    Stop,\n    ArmNow {\n        undock: bool,\n    },\n}\n\
                      match self {\n    Self::A => \"wheel left\",\n}";
        assert_eq!(variants(source, "Command"), ["hello", "halt", "arm-now"]);
        assert_eq!(words(source).collect::<Vec<_>>(), ["wheel left"]);
    }
}
