//! Rust source as far as the length rules need it: comments and strings taken out, braces matched.

/// A function in a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct SourceFunction {
    /// Its name.
    pub(super) name: String,
    /// Line of its `fn`, from 1.
    pub(super) line: usize,
    /// Lines of its body with code on them.
    pub(super) lines: usize,
}

/// The source with comments and the inside of strings and characters replaced by spaces; lines stay where they are.
pub(super) fn code(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let opaque = opaque_length(rest);
        if opaque == 0 {
            out.push(first);
            rest = rest.get(first.len_utf8()..).unwrap_or_default();
            // The tail of a word is no start of a raw string: `for"` does not exist, `bar"` does not either.
            if first.is_alphanumeric() || first == '_' {
                let word = rest
                    .find(|letter: char| !letter.is_alphanumeric() && letter != '_')
                    .unwrap_or(rest.len());
                out.push_str(rest.get(..word).unwrap_or_default());
                rest = rest.get(word..).unwrap_or_default();
            }
            continue;
        }
        let (hidden, after) = rest.split_at(opaque);
        out.extend(
            hidden
                .chars()
                .map(|letter| if letter == '\n' { '\n' } else { ' ' }),
        );
        rest = after;
    }
    out
}

/// Length of the comment, string or character that begins here; 0 when none does.
fn opaque_length(rest: &str) -> usize {
    if rest.starts_with("//") {
        return rest.find('\n').unwrap_or(rest.len());
    }
    if rest.starts_with("/*") {
        return block_comment(rest);
    }
    let prefix = ["br", "cr", "b", "c", "r", ""].into_iter().find(|prefix| {
        rest.strip_prefix(prefix)
            .is_some_and(|after| after.starts_with(['"', '#', '\'']))
    });
    let Some(prefix) = prefix else { return 0 };
    let body = rest.get(prefix.len()..).unwrap_or_default();
    let length = if prefix.ends_with('r') {
        raw_string(body)
    } else if body.starts_with('"') {
        quoted(body, '"')
    } else if body.starts_with('\'') {
        character(body)
    } else {
        0
    };
    if length == 0 { 0 } else { prefix.len() + length }
}

fn block_comment(rest: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(here) = rest.get(at..).filter(|here| !here.is_empty()) {
        if here.starts_with("/*") {
            depth += 1;
            at += 2;
        } else if here.starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += here.chars().next().map_or(1, char::len_utf8);
        }
    }
    rest.len()
}

fn raw_string(body: &str) -> usize {
    let hashes = body.len() - body.trim_start_matches('#').len();
    let Some(inside) = body.get(hashes..).and_then(|after| after.strip_prefix('"')) else {
        return 0;
    };
    let end = format!("\"{}", "#".repeat(hashes));
    inside
        .find(&end)
        .map_or(body.len(), |at| hashes + 1 + at + end.len())
}

fn quoted(body: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, letter) in body.char_indices().skip(1) {
        if escaped {
            escaped = false;
        } else if letter == '\\' {
            escaped = true;
        } else if letter == quote {
            return at + 1;
        }
    }
    body.len()
}

/// A character literal, but not a lifetime: a lifetime has no second quote after one character.
fn character(body: &str) -> usize {
    let mut letters = body.char_indices().skip(1);
    match letters.next() {
        Some((_, '\\')) => quoted(body, '\''),
        Some(_) => match letters.next() {
            Some((at, '\'')) => at + 1,
            _ => 0,
        },
        None => 0,
    }
}

/// Which lines belong to items marked `#[cfg(test)]`, in code as [`code`] gives it.
pub(super) fn test_lines(code: &str) -> Vec<bool> {
    let mut marks = vec![false; code.lines().count()];
    for (at, _) in code.match_indices("#[cfg(test)]") {
        let first = line_of(code, at);
        let last = block_end(code, at).map_or(first, |end| line_of(code, end));
        marks
            .iter_mut()
            .take(last)
            .skip(first - 1)
            .for_each(|mark| *mark = true);
    }
    marks
}

/// The functions of a file, in code as [`code`] gives it.
pub(super) fn functions(code: &str) -> Vec<SourceFunction> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ") {
        let before = code.get(..at).and_then(|text| text.chars().next_back());
        if before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_') {
            continue;
        }
        let after = code.get(at + 3..).unwrap_or_default();
        let name: String = after
            .chars()
            .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
            .collect();
        if let (false, Some(end)) = (name.is_empty(), block_end(code, at)) {
            let body = code.get(at..end).unwrap_or_default();
            let lines = body.lines().filter(|line| !line.trim().is_empty()).count();
            found.push(SourceFunction {
                name,
                line: line_of(code, at),
                lines,
            });
        }
    }
    found
}

fn line_of(text: &str, at: usize) -> usize {
    text.get(..at).unwrap_or_default().matches('\n').count() + 1
}

/// The end of the first block `{ ... }` after `at`; `None` when a `;` outside of brackets comes first.
fn block_end(code: &str, at: usize) -> Option<usize> {
    let mut depth = 0_usize;
    let mut braces = 0_usize;
    for (offset, letter) in code.get(at..)?.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            ';' if depth == 0 && braces == 0 => return None,
            '{' => braces += 1,
            '}' => {
                braces = braces.saturating_sub(1);
                if braces == 0 {
                    return Some(at + offset + 1);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{code, functions, test_lines};

    #[test]
    fn comments_strings_and_characters_are_taken_out() {
        let source =
            "let a = \"{ // }\"; // fn x() {\nlet b = '{'; let c: &'a str = r#\"}\"#; /* /* { */ } */ end";
        let plain = code(source);
        assert!(!plain.contains(['{', '}']), "{plain}");
        assert!(plain.contains("&'a str") && plain.ends_with("end"), "{plain}");
        assert_eq!(plain.matches('\n').count(), 1);
    }

    #[test]
    fn functions_are_measured_without_blank_lines_and_comments() {
        let plain = code("fn one() {\n    // why\n\n    act();\n}\n\nfn two(a: [u8; 2]);\n\nfn three() {}\n");
        let measured: Vec<_> = functions(&plain)
            .into_iter()
            .map(|f| (f.name, f.line, f.lines))
            .collect();
        assert_eq!(measured, [("one".to_owned(), 1, 3), ("three".to_owned(), 9, 1)]);
    }

    #[test]
    fn test_modules_are_found() {
        let plain = code("fn a() {}\n#[cfg(test)]\nmod tests {\n    fn b() {}\n}\nfn c() {}\n");
        assert_eq!(test_lines(&plain), [false, true, true, true, true, false]);
    }
}
