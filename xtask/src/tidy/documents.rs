//! Links between documents, and names of code in documents.
//!
//! A document names code as `` `path/to/file.rs::name` ``: then the file must exist and define `name`, and a test that is named
//! must run.

use super::Finding;
use super::files::Files;
use crate::markdown_links::{inside, targets};
use std::path::Path;

/// Checks every Markdown file.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for (path, text) in files.texts(&[".md"]) {
        for target in links(text) {
            if !resolves(files, path, target) {
                found.push(format!("{path}: the link to {target} leads nowhere"));
            }
        }
        for (file, name) in names(text) {
            if !defines(files, file, name) {
                found.push(format!("{path}: {file} does not define {name}"));
            } else if files.text(file).is_some_and(|text| is_ignored(text, name)) {
                found.push(format!("{path}: the test {name} of {file} is ignored"));
            }
        }
    }
    Ok(Finding::Checked(found))
}

/// Targets of links inside the repository.
fn links(text: &str) -> impl Iterator<Item = &str> {
    targets(text)
        .map(|target| target.split('#').next().unwrap_or_default())
        .filter(|target| !target.is_empty() && !target.contains("://") && !target.starts_with("mailto:"))
}

fn resolves(files: &Files, document: &str, target: &str) -> bool {
    inside(Path::new(document), target).is_some_and(|(file, _)| {
        // The root of the repository is a place, too.
        file == Path::new("") || file.to_str().is_some_and(|file| files.has(file))
    })
}

/// Pairs of file and name in inline code.
fn names(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let spans = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
    spans.filter_map(|span| {
        span.split_once(".rs::")
            .map(|(file, name)| (span.get(..file.len() + 3).unwrap_or(span), name))
    })
}

fn defines(files: &Files, file: &str, name: &str) -> bool {
    let Some(text) = files.text(file) else {
        return false;
    };
    // `Type::method` is found by its last part, which must be defined in the same file.
    let name = name.rsplit("::").next().unwrap_or(name).trim_end_matches("()");
    let words = [
        "fn ", "struct ", "enum ", "trait ", "const ", "static ", "type ", "mod ",
    ];
    let ends = |rest: &str| !rest.starts_with(|letter: char| letter.is_alphanumeric() || letter == '_');
    let item = words.iter().any(|word| {
        let wanted = format!("{word}{name}");
        text.match_indices(&wanted)
            .any(|(at, _)| text.get(at + wanted.len()..).is_some_and(ends))
    });
    item || variant(text, name)
}

/// Whether the function has the attribute `ignore` for another reason than that it is a campaign: those run with
/// `cargo xtask test --all`.
fn is_ignored(text: &str, name: &str) -> bool {
    let head = format!("fn {name}(");
    let above = text
        .lines()
        .rev()
        .skip_while(|line| !line.contains(&head))
        .skip(1);
    above
        .map(str::trim)
        .take_while(|line| line.starts_with("#["))
        .any(|line| line.starts_with("#[ignore") && !line.starts_with("#[ignore = \"campaign"))
}

/// Whether a line is the variant of an enum or a field with this name.
fn variant(text: &str, name: &str) -> bool {
    text.lines().map(str::trim).any(|line| {
        let line = line.strip_prefix("pub ").unwrap_or(line);
        line.strip_prefix(name).is_some_and(|rest| {
            rest.starts_with([',', '(', ':']) || rest.starts_with(" {") || rest.starts_with(" =")
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{is_ignored, links, names, variant};

    #[test]
    fn links_inside_the_repository_are_found() {
        let text = "[a](b.md#part) [c](https://example.org) [d](#here) [e](../f)";
        assert_eq!(links(text).collect::<Vec<_>>(), ["b.md", "../f"]);
    }

    #[test]
    fn names_of_code_are_found() {
        let text = "The loop (`brain/src/lib.rs::Brain::step`) and `plain code`.";
        assert_eq!(
            names(text).collect::<Vec<_>>(),
            [("brain/src/lib.rs", "Brain::step")]
        );
    }

    #[test]
    fn tests_that_do_not_run_are_found() {
        let text = "#[test]\n#[ignore = \"slow\"]\nfn slow() {}\n\n#[test]\nfn fast() {}\n\n\
                    #[test]\n#[ignore = \"campaign: 40 s\"]\nfn many() {}\n";
        assert!(is_ignored(text, "slow"));
        assert!(!is_ignored(text, "many"));
        assert!(!is_ignored(text, "fast") && !is_ignored(text, "absent"));
    }

    #[test]
    fn variants_are_found() {
        assert!(variant("    Start {\n", "Start"));
        assert!(!variant("    Started,\n", "Start"));
    }
}
