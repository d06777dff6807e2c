//! Lengths of files and functions, and the head of every file.

use super::Finding;
use super::files::Files;
use super::rust_text::{code, functions as functions_of, test_lines};

/// Most lines of a file, without tests.
const FILE_LINES_MAX: usize = 500;
/// Most lines of a function, without blank lines and comments.
const FUNCTION_LINES_MAX: usize = 70;

/// Every Rust file says what it is.
pub(super) fn heads(files: &Files) -> anyhow::Result<Finding> {
    let bare = files.texts(&[".rs"]).filter(|(_, text)| !has_head(text));
    Ok(Finding::Checked(
        bare.map(|(path, _)| format!("{path}: begins without //! that says what the file is"))
            .collect(),
    ))
}

fn has_head(text: &str) -> bool {
    let mut lines = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with("#!["));
    lines
        .find(|line| !line.starts_with("// "))
        .is_some_and(|line| line.starts_with("//!"))
}

/// Files are short.
pub(super) fn files(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for (path, text) in files.texts(&[".rs"]).filter(|(path, _)| !is_test(path)) {
        let tests = test_lines(&code(text)).iter().filter(|is_test| **is_test).count();
        let lines = text.lines().count() - tests;
        if lines > FILE_LINES_MAX {
            found.push(format!(
                "{path}: {lines} lines without tests; split it by concept ({FILE_LINES_MAX} at most)"
            ));
        }
    }
    Ok(Finding::Checked(found))
}

/// Functions are short.
pub(super) fn functions(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for (path, text) in files.texts(&[".rs"]) {
        for function in functions_of(&code(text)) {
            if function.lines > FUNCTION_LINES_MAX {
                let (name, line, lines) = (&function.name, function.line, function.lines);
                found.push(format!(
                    "{path}:{line}: {name} has {lines} lines; take parts out ({FUNCTION_LINES_MAX} at most)"
                ));
            }
        }
    }
    Ok(Finding::Checked(found))
}

fn is_test(path: &str) -> bool {
    path.split('/').any(|part| part == "tests" || part == "tests.rs")
}

#[cfg(test)]
mod tests {
    use super::has_head;

    #[test]
    fn attributes_and_licence_lines_may_stand_before_the_head() {
        assert!(has_head("// SPDX-License-Identifier: X\n#![no_std]\n//! What.\n"));
        assert!(!has_head("use std::io;\n//! Late.\n"));
        assert!(!has_head(""));
    }
}
