//! The specification of the wire and the code that speaks it use the same words.

use super::Finding;
use super::files::Files;
use std::collections::BTreeSet;

const SPECIFICATION: &str = "protocol/SPEC.md";
const MESSAGES: &str = "protocol/rvac-protocol/src/message/";

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
    let commands = files
        .text(&format!("{MESSAGES}command.rs"))
        .map(variants)
        .unwrap_or_default();
    for command in commands {
        let shape = format!("\"c\":\"{command}\"");
        if !specification.contains(&shape) {
            found.push(format!(
                "{SPECIFICATION} shows no packet {shape}, but it is a command of {MESSAGES}command.rs"
            ));
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

/// The variants of `enum Command` as they are written on the wire.
fn variants(source: &str) -> Vec<String> {
    let body = source
        .split_once("pub enum Command {")
        .map_or("", |(_, after)| after);
    let body = body.split_once("\n}").map_or(body, |(body, _)| body);
    let lines = body.lines().filter_map(|line| line.strip_prefix("    "));
    let names = lines.filter(|line| line.starts_with(|letter: char| letter.is_ascii_uppercase()));
    names
        .map(|line| {
            line.chars()
                .take_while(char::is_ascii_alphanumeric)
                .collect::<String>()
                .to_ascii_lowercase()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{variants, words};

    #[test]
    fn variants_and_words_are_found() {
        let source = "pub enum Command {\n    /// Doc.\n    Hello(HostHello),\n    Stop,\n    Arm {\n        undock: bool,\n    },\n}\n\
                      match self {\n    Self::A => \"wheel left\",\n}";
        assert_eq!(variants(source), ["hello", "stop", "arm"]);
        assert_eq!(words(source).collect::<Vec<_>>(), ["wheel left"]);
    }
}
