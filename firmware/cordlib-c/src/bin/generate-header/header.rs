//! From `pub extern "C" fn` and `pub const CORD_...` in Rust to prototypes and macros in C, with their documentation.
//!
//! It reads the regular form that rustfmt produces and refuses anything else, so that the header cannot differ from the
//! source.

use std::fmt::Write as _;
use std::path::Path;

/// Files in the order of the header.
const FILES: [&str; 8] = [
    "callbacks.rs",
    "machine.rs",
    "main_loop.rs",
    "time.rs",
    "connection.rs",
    "inputs.rs",
    "board.rs",
    "requests.rs",
];

const HEAD: &str = "\
/* C interface of cordlib. Written by `cargo run -p cordlib-c --bin generate-header`; do not edit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORDLIB_H
#define CORDLIB_H

#include <stdint.h>

#ifdef __cplusplus
extern \"C\" {
#endif
";

const TAIL: &str = "
#ifdef __cplusplus
}
#endif

#endif /* CORDLIB_H */
";

/// The whole header for the sources in `folder`.
pub(crate) fn generate(folder: &Path) -> Result<String, String> {
    let mut text = HEAD.to_owned();
    for file in FILES {
        let path = folder.join(file);
        let source =
            std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let items = items(&source).map_err(|error| format!("{}: {error}", path.display()))?;
        text.push_str(&items);
    }
    text.push_str(TAIL);
    Ok(text)
}

fn items(source: &str) -> Result<String, String> {
    let mut text = String::new();
    let mut documentation = Vec::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if let Some(words) = line.strip_prefix("///") {
            documentation.push(words.trim());
        } else if line.starts_with("pub const CORD_") {
            text.push_str(&comment(&documentation));
            text.push_str(&constant(line)?);
        } else if line.contains("extern \"C\" fn") && line.starts_with("pub ") {
            let mut signature = line.to_owned();
            while !signature.ends_with('{') {
                let next = lines.next().ok_or("a function without a body")?;
                signature.push_str(next.trim_start());
            }
            text.push_str(&comment(&documentation));
            text.push_str(&prototype(&signature)?);
        }
        if !line.starts_with("///") && !line.starts_with("#[") {
            documentation.clear();
        }
    }
    Ok(text)
}

/// The documentation without its Rust sections.
fn comment(documentation: &[&str]) -> String {
    let words: Vec<&str> = documentation
        .iter()
        .take_while(|line| !line.starts_with("# "))
        .copied()
        .filter(|line| !line.is_empty())
        .collect();
    format!("\n/* {} */\n", words.join("\n * "))
}

/// `pub const CORD_OK: i32 = 0;`
fn constant(line: &str) -> Result<String, String> {
    let rest = line.strip_prefix("pub const ").ok_or("no constant")?;
    let (name, value) = rest.split_once(": i32 = ").ok_or("a constant that is no i32")?;
    Ok(format!("#define {name} {}\n", value.trim_end_matches(';')))
}

fn prototype(signature: &str) -> Result<String, String> {
    let (_, rest) = signature.split_once("extern \"C\" fn ").ok_or("no function")?;
    let (name, rest) = rest.split_once('(').ok_or("no parameters")?;
    let rest = rest.trim_end_matches('{').trim_end();
    let (parameters, result) = match rest.rsplit_once(") -> ") {
        Some((parameters, result)) if !result.contains(')') => (parameters, c_type(result)?),
        _ => (rest.strip_suffix(')').ok_or("no end of parameters")?, "void"),
    };
    let mut list = String::new();
    for parameter in split(parameters) {
        let (name, kind) = parameter.split_once(": ").ok_or("a parameter without type")?;
        let separator = if list.is_empty() { "" } else { ", " };
        write!(list, "{separator}{}", declaration(name, kind)?).map_err(|error| error.to_string())?;
    }
    if list.is_empty() {
        list.push_str("void");
    }
    Ok(format!("{}{name}({list});\n", spaced(result)))
}

/// Parameters by commas outside of parentheses.
fn split(parameters: &str) -> Vec<&str> {
    let mut depth = 0;
    parameters
        .split(|letter| {
            match letter {
                '(' => depth += 1,
                ')' => depth -= 1,
                _ => {}
            }
            letter == ',' && depth == 0
        })
        .map(str::trim)
        .filter(|parameter| !parameter.is_empty())
        .collect()
}

fn declaration(name: &str, kind: &str) -> Result<String, String> {
    let Some(callback) = kind
        .strip_prefix("Option<extern \"C\" fn(")
        .and_then(|rest| rest.strip_suffix('>'))
    else {
        return Ok(format!("{}{name}", spaced(c_type(kind)?)));
    };
    let (parameters, result) = callback
        .rsplit_once(") -> ")
        .map_or((callback.trim_end_matches(')'), "()"), |(parameters, result)| {
            (parameters, result)
        });
    let mut list = Vec::new();
    for parameter in split(parameters) {
        let (name, kind) = parameter
            .split_once(": ")
            .ok_or("a callback's parameter without name")?;
        list.push(format!("{}{name}", spaced(c_type(kind)?)));
    }
    let list = if list.is_empty() {
        "void".to_owned()
    } else {
        list.join(", ")
    };
    let result = if result == "()" { "void" } else { c_type(result)? };
    Ok(format!("{result} (*{name})({list})"))
}

fn spaced(kind: &str) -> String {
    if kind.ends_with('*') {
        kind.to_owned()
    } else {
        format!("{kind} ")
    }
}

fn c_type(kind: &str) -> Result<&'static str, String> {
    match kind.trim() {
        "f64" => Ok("double"),
        "i32" => Ok("int32_t"),
        "u32" => Ok("uint32_t"),
        "u8" => Ok("uint8_t"),
        "*const c_char" => Ok("const char *"),
        other => Err(format!("no C type is known for {other}")),
    }
}
