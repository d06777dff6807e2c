//! What rules.toml says of the rest of the project must be so.

use super::measured::MeasuredFigures;
use super::model::RuleBook;
use anyhow::{Context, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const INHIBITS: &str = "protocol/rvac-protocol/src/message/inhibit.rs";
const TRIALS: &str = "sim/trials/src/catalog";
const VERDICTS: &str = "sim/monitor/src/verdict.rs";

/// Checks the file and returns the inhibits: from the name on the wire to the variant.
pub(super) fn check(
    root: &Path,
    book: &RuleBook,
    measured: &MeasuredFigures,
) -> anyhow::Result<BTreeMap<String, String>> {
    let read =
        |path: &str| std::fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"));
    let wire = read(INHIBITS)?;
    let inhibits = inhibits(&wire);
    let mut wrong = codes(root, book);
    wrong.extend(constants(root, book));
    wrong.extend(differences(
        "inhibit",
        (INHIBITS, inhibits.keys().cloned().collect()),
        book.rules.iter().flat_map(|rule| rule.inhibits.clone()).collect(),
    ));
    wrong.extend(differences(
        "latched inhibit",
        (INHIBITS, latched(&wire, &inhibits)),
        book.latches
            .iter()
            .flat_map(|latch| latch.inhibits.clone())
            .collect(),
    ));
    wrong.extend(differences(
        "rule of the monitor",
        (VERDICTS, judged(&read(VERDICTS)?)),
        book.rules.iter().flat_map(|rule| rule.monitor.clone()).collect(),
    ));
    let catalog = catalog(&root.join(TRIALS))?;
    wrong.extend(trials(book, measured, &catalog));
    wrong.extend(evidence(book));
    match wrong.as_slice() {
        [] => Ok(inhibits),
        wrong => bail!("protocol/rules.toml: {}", wrong.join("; ")),
    }
}

/// Code that is named but is not there.
fn codes(root: &Path, book: &RuleBook) -> Vec<String> {
    let named = book
        .rules
        .iter()
        .flat_map(|rule| rule.code.iter().map(move |code| (&rule.id, code)));
    let lost = named.filter(|(_, code)| {
        let (path, name) = code.split_once("::").unwrap_or((code, ""));
        !std::fs::read_to_string(root.join(path)).is_ok_and(|text| text.contains(name))
    });
    lost.map(|(id, code)| format!("{id}: there is no {code}"))
        .collect()
}

/// Constants elsewhere that differ from the limit that they stand for.
fn constants(root: &Path, book: &RuleBook) -> Vec<String> {
    let limits = book.rules.iter().flat_map(|rule| &rule.limits);
    let stated = limits.filter_map(|limit| Some((limit.stands_in.as_deref()?, limit.value)));
    let differs = stated.filter(|(place, value)| {
        let found = place.split_once("::").and_then(|(path, name)| {
            let text = std::fs::read_to_string(root.join(path)).ok()?;
            number(&text, name)
        });
        found != Some(*value)
    });
    differs
        .map(|(place, value)| format!("{place} is not {value}"))
        .collect()
}

/// The number in `NAME: Type = Type(1_000);`.
fn number(text: &str, name: &str) -> Option<i64> {
    let (_, after) = text.split_once(&format!("const {name}:"))?;
    let (_, value) = after.split_once(';')?.0.split_once('=')?;
    let digits: String = value.chars().filter(char::is_ascii_digit).collect();
    digits.parse().ok()
}

/// The sources of all trials.
fn catalog(folder: &Path) -> anyhow::Result<String> {
    let mut all = String::new();
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        all.push_str(&std::fs::read_to_string(entry?.path())?);
    }
    Ok(all)
}

/// Trials that a rule names and nobody makes, or that were measured and no rule names.
fn trials(book: &RuleBook, measured: &MeasuredFigures, catalog: &str) -> Vec<String> {
    let named: BTreeSet<&String> = book.rules.iter().flat_map(|rule| &rule.trials).collect();
    let lost = named
        .iter()
        .filter(|name| !catalog.contains(&format!("\"{name}\"")));
    let lost = lost.map(|name| format!("{TRIALS} has no trial {name}"));
    let unnamed = measured
        .trials
        .iter()
        .filter(|trial| !named.contains(&trial.name));
    lost.chain(unnamed.map(|trial| format!("the measured trial {} is of no rule", trial.name)))
        .collect()
}

/// What one side names and the other does not.
fn differences(what: &str, (place, there): (&str, BTreeSet<String>), here: BTreeSet<String>) -> Vec<String> {
    let unknown = here
        .difference(&there)
        .map(|name| format!("{place} has no {what} {name}"));
    let unnamed = there
        .difference(&here)
        .map(|name| format!("the {what} {name} of {place} is of no rule"));
    unknown.chain(unnamed).collect()
}

/// From `Self::Bumper => "bumper"`.
fn inhibits(text: &str) -> BTreeMap<String, String> {
    let lines = text.lines().filter_map(|line| line.trim().strip_prefix("Self::"));
    let named = lines.filter_map(|line| {
        let (variant, name) = line.split_once(" => \"")?;
        Some((name.split_once('"')?.0.to_owned(), variant.to_owned()))
    });
    named.collect()
}

fn latched(text: &str, inhibits: &BTreeMap<String, String>) -> BTreeSet<String> {
    let body = text.split_once("fn is_latched").map_or("", |(_, after)| after);
    let body = body.split_once("\n    }").map_or(body, |(body, _)| body);
    let variants: BTreeSet<&str> = body
        .split("Self::")
        .skip(1)
        .filter_map(|part| part.split(|letter: char| !letter.is_ascii_alphanumeric()).next())
        .collect();
    let known = inhibits
        .iter()
        .filter(|(_, variant)| variants.contains(variant.as_str()));
    known.map(|(name, _)| name.clone()).collect()
}

/// From `Self::Bumper => "S6-bumper"`.
fn judged(text: &str) -> BTreeSet<String> {
    inhibits(text).into_keys().collect()
}

fn evidence(book: &RuleBook) -> Vec<String> {
    let mut wrong = Vec::new();
    for shown in &book.shown {
        let unknown = shown
            .rules
            .iter()
            .filter(|id| !book.rules.iter().any(|rule| rule.id == **id));
        wrong.extend(unknown.map(|id| format!("there is no rule {id}")));
        let lost = shown.figures.iter().filter(|figure| book.limit(figure).is_err());
        wrong.extend(lost.map(|figure| format!("there is no limit {figure}")));
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::{differences, inhibits, latched, number};
    use std::collections::BTreeSet;

    #[test]
    fn names_and_numbers_of_the_project_are_read() {
        let text = "Self::Bumper => \"bumper\",\nSelf::Clock => \"clock\",\npub const fn is_latched(self) -> bool {\n        matches!(self, Self::Clock)\n    }\nSelf::Bumper";
        let known = inhibits(text);
        assert_eq!(known["bumper"], "Bumper");
        assert_eq!(latched(text, &known), BTreeSet::from(["clock".to_owned()]));
        let text = "pub const FAST: Speed = Speed(100_000);";
        assert_eq!(number(text, "FAST"), Some(100_000));
        assert_eq!(number(text, "SLOW"), None);
    }

    #[test]
    fn what_only_one_side_names_is_found() {
        let set = |names: &[&str]| {
            names
                .iter()
                .map(|name| (*name).to_owned())
                .collect::<BTreeSet<_>>()
        };
        let found = differences("trial", ("there", set(&["a", "b"])), set(&["b", "c"]));
        assert_eq!(
            found,
            ["there has no trial c", "the trial a of there is of no rule"]
        );
        assert!(differences("trial", ("there", set(&["a"])), set(&["a"])).is_empty());
    }
}
