//! The tables of SAFETY.md, each between two marks.

use super::measured::{MeasuredFigures, MeasuredTrial};
use super::model::{Evidence, Forbidden, Latch, RuleBook, RulePlace, SafetyRule};
use super::unit::grouped;
use anyhow::Context;
use std::fmt::Write;

/// Where most of the code is.
const CORDLIB: &str = "firmware/cordlib/src/";

/// The page with fresh tables.
pub(super) fn renewed(page: &str, book: &RuleBook, measured: &MeasuredFigures) -> anyhow::Result<String> {
    let page = replaced(page, "rules", &rules(book)?)?;
    let page = replaced(&page, "latches", &latches(book)?)?;
    let page = replaced(&page, "how each rule is shown", &evidence(book, measured)?)?;
    replaced(&page, "the real firmware", &trials(book, measured)?)
}

fn replaced(page: &str, name: &str, table: &str) -> anyhow::Result<String> {
    let begin = format!("<!-- Table of {name}: made by cargo xtask codegen from protocol/. -->");
    let end = format!("<!-- End of the table of {name}. -->");
    let marks = || format!("SAFETY.md needs the marks {begin:?} and {end:?}");
    let (before, rest) = page.split_once(&begin).with_context(marks)?;
    let (_, after) = rest.split_once(&end).with_context(marks)?;
    Ok(format!("{before}{begin}\n\n{table}\n{end}{after}"))
}

fn rules(book: &RuleBook) -> anyhow::Result<String> {
    let mut out = String::from(
        "| rule | fault | what happens | reaction at most | place | state |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for rule in &book.rules {
        let [effect, reaction] = [rule.filled(&rule.effect)?, rule.filled(&rule.reaction)?];
        writeln!(
            out,
            "| {} | {} | {effect} | {reaction} | {} | {} |",
            rule.id,
            rule.fault,
            place(rule),
            rule.state
        )?;
    }
    Ok(out)
}

fn place(rule: &SafetyRule) -> String {
    let names = rule.place.iter().map(|place| match place {
        RulePlace::Mcu => "mcu",
        RulePlace::Daemon => "daemon",
        RulePlace::Brain => "brain",
    });
    let names = names.collect::<Vec<_>>().join(", ");
    let code = rule.code.iter().map(|code| {
        let short = code.strip_prefix(CORDLIB).filter(|_| !code.contains("::"));
        format!("`{}`", short.unwrap_or(code))
    });
    let code = code.collect::<Vec<_>>().join(", ");
    match (names.as_str(), code.as_str()) {
        ("", code) => code.to_owned(),
        (names, code) => format!("{names}: {code}"),
    }
}

fn latches(book: &RuleBook) -> anyhow::Result<String> {
    let mut out = String::from("| latched | `clear` is refused while | forbids |\n| --- | --- | --- |\n");
    for Latch {
        inhibits,
        refused,
        forbids,
    } in &book.latches
    {
        let names = inhibits.iter().map(|name| format!("`{name}`"));
        let forbids = forbids.iter().map(|what| match what {
            Forbidden::Motion => "motion",
            Forbidden::Charging => "charging",
        });
        let (names, forbids) = (joined(names), joined(forbids.map(str::to_owned)));
        writeln!(out, "| {names} | {refused} | {forbids} |")?;
    }
    Ok(out)
}

fn joined(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join(", ")
}

fn evidence(book: &RuleBook, measured: &MeasuredFigures) -> anyhow::Result<String> {
    let mut out = String::from("| rule | test | worst / limit |\n| --- | --- | --- |\n");
    for Evidence {
        rules,
        how,
        figures,
        result,
    } in &book.shown
    {
        let mut shown = Vec::new();
        for figure in figures {
            let limit = book.limit(figure)?;
            let worst = measured.tests.get(figure).copied();
            let name = if figures.len() > 1 {
                limit.name.as_str()
            } else {
                ""
            };
            let figure = format!("{name} {} / {}", worst_ms(worst, 0), grouped(limit.value));
            shown.push(figure.trim_start().to_owned());
        }
        let figures = shown.join(", ");
        writeln!(out, "| {} | {how} | {figures}{result} |", rules.join(", "))?;
    }
    Ok(out)
}

fn trials(book: &RuleBook, measured: &MeasuredFigures) -> anyhow::Result<String> {
    let mut out = String::from("| rule | fault | moments | worst / limit |\n| --- | --- | --- | --- |\n");
    for trial in &measured.trials {
        let MeasuredTrial {
            rule,
            what,
            limit,
            allowance,
            phases,
            worst_ms: worst,
            ..
        } = trial;
        let limit = book.limit(limit)?.value;
        let allowance = allowance
            .as_ref()
            .map(|name| {
                book.allowances
                    .iter()
                    .find(|known| known.name == *name)
                    .map(|known| format!(" + {}", grouped(known.value)))
                    .with_context(|| format!("protocol/rules.toml has no allowance {name}"))
            })
            .transpose()?
            .unwrap_or_default();
        let worst = worst_ms(Some(*worst), 1);
        writeln!(
            out,
            "| {rule} | {what} | {phases} | {worst} / {}{allowance} |",
            grouped(limit)
        )?;
    }
    for rule in &book.rules {
        for name in &rule.trials {
            if !measured.trials.iter().any(|trial| trial.name == *name) {
                writeln!(out, "| {} | `{name}` | 0 | not measured |", rule.id)?;
            }
        }
    }
    Ok(out)
}

fn worst_ms(worst: Option<f64>, decimals: usize) -> String {
    let Some(worst) = worst else {
        return "not measured".to_owned();
    };
    let text = format!("{worst:.decimals$}");
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let whole = whole.parse().map_or_else(|_| whole.to_owned(), grouped);
    match fraction {
        "" => whole,
        fraction => format!("{whole}.{fraction}"),
    }
}
