//! Examples in a page of the book.

use serde_json::Value;

/// A script, with the definitions before it, and the lines that it prints.
pub(crate) struct Example {
    pub(crate) script: String,
    pub(crate) answers: Vec<Value>,
}

/// The examples of a page, in its order.
pub(crate) fn examples(page: &str) -> Vec<Example> {
    let (mut definitions, mut examples) = (String::new(), Vec::new());
    let mut blocks = blocks(page).into_iter().peekable();
    while let Some((kind, text)) = blocks.next() {
        if kind != "sh" {
            continue;
        }
        let script = format!("{definitions}{text}");
        match blocks.next_if(|(next, _)| *next == "json") {
            Some((_, answers)) => examples.push(Example {
                script,
                answers: answers
                    .lines()
                    .map(|line| serde_json::from_str(line).unwrap())
                    .collect(),
            }),
            None => definitions = script,
        }
    }
    examples
}

/// Fenced blocks: their kind and their text.
fn blocks(page: &str) -> Vec<(&str, String)> {
    let mut found = Vec::new();
    let mut open: Option<(&str, String)> = None;
    for line in page.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(kind), None) => open = Some((kind, String::new())),
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, Some((_, text))) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    found
}
