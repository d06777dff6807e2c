//! Text of others as a terminal may show it: characters that would move its cursor, colour it or type into it are made visible.

use serde_json::Value;

/// Stands for what was taken out.
const MARK: char = '\u{fffd}';

/// Whether a terminal might obey it. Line ends and tabs only make room.
fn is_order(letter: char) -> bool {
    letter.is_control() && letter != '\n' && letter != '\t'
}

/// The text without orders.
pub(crate) fn plain(text: &str) -> String {
    text.replace(is_order, &MARK.to_string())
}

/// The same in one line, so that a text cannot add lines to a list.
pub(crate) fn one_line(text: &str) -> String {
    text.replace(char::is_control, &MARK.to_string())
}

/// JSON in which an order is spelled as an escape: taken out of every text.
pub(crate) fn plain_json(mut value: Value) -> Value {
    clean(&mut value);
    value
}

/// As deep as the parser lets values nest.
fn clean(value: &mut Value) {
    match value {
        Value::String(text) if text.contains(is_order) => *text = plain(text),
        Value::Array(values) => values.iter_mut().for_each(clean),
        Value::Object(entries) => entries.values_mut().for_each(clean),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{one_line, plain, plain_json};

    #[test]
    fn a_text_gives_no_commands_to_a_terminal() {
        let text = "a\u{1b}[2J\u{7}b\u{9b}31mc\u{1f}\td\ne<b>";
        assert_eq!(plain(text), "a\u{fffd}[2J\u{fffd}b\u{fffd}31mc\u{fffd}\td\ne<b>");
        assert!(!one_line(text).contains(char::is_control));
        assert_eq!(
            plain_json(json!({"a": ["\u{1b}c", 1, {"b": "\u{8}"}], "c": "Köök"})),
            json!({"a": ["\u{fffd}c", 1, {"b": "\u{fffd}"}], "c": "Köök"})
        );
    }
}
