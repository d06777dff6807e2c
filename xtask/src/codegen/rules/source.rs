//! rules.toml as constants: in Rust for cordlib, for the monitor and for whoever tries the rules, and in C.

use super::model::{Constant, Forbidden, RuleBook};
use super::unit::Unit;
use crate::codegen::rust_name::{constant as upper, number};
use anyhow::Context;
use std::collections::BTreeMap;
use std::fmt::Write;

const MADE: &str = "Made by cargo xtask codegen from protocol/rules.toml. Do not edit.";

/// The constants of cordlib, a module for each family of them.
pub(super) fn of_cordlib(book: &RuleBook, inhibits: &BTreeMap<String, String>) -> anyhow::Result<String> {
    let mut modules: BTreeMap<&str, String> = BTreeMap::new();
    for rule in &book.rules {
        for setting in &rule.settings {
            let text = modules.entry(&setting.module).or_default();
            let why = format!("{}. {}", rule.id, setting.why);
            declare(text, why.trim_end(), &setting.constant(rule)?)?;
        }
    }
    let mut out = format!("//! Figures of the safety rules. {MADE}\n");
    for (module, text) in modules {
        write!(out, "\npub(crate) mod {module} {{\n{text}}}\n")?;
    }
    let of_hardware = book.latches.iter().filter(|latch| latch.forbids.len() > 1);
    let names = of_hardware
        .flat_map(|latch| &latch.inhibits)
        .map(|name| {
            inhibits
                .get(name)
                .map(|variant| format!("Inhibit::{variant}"))
                .with_context(|| format!("no inhibit is called {name}"))
        })
        .collect::<anyhow::Result<Vec<_>>>()?;
    write!(
        out,
        "\npub(crate) mod latch {{\nuse rvac_protocol::message::Inhibit;\n\n/// Latches that forbid motion and charging.\n\
         pub(crate) const FORBID_ALL: [Inhibit; {}] = [{}];\n}}\n",
        names.len(),
        names.join(", ")
    )?;
    Ok(out)
}

/// The limits of the monitor, which are those of no firmware.
pub(super) fn of_monitor(book: &RuleBook) -> anyhow::Result<String> {
    let mut out = format!("//! What the monitor judges by. {MADE}\n\n");
    for figure in &book.judged {
        let why = match figure.why.as_str() {
            "" => figure.limit.clone(),
            why => format!("{}, and {why}", figure.limit),
        };
        declare(&mut out, &why, &figure.constant(book)?)?;
    }
    Ok(out)
}

/// The reaction times, for those who try the rules. `named` says whether a limit is wanted.
pub(super) fn of_limits(book: &RuleBook, named: impl Fn(&str) -> bool) -> anyhow::Result<String> {
    let mut out = format!(
        "//! Reaction times of the rules. {MADE}\n\n\
         /// A limit of rules.toml.\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\npub struct Limit {{\n\
         /// The rule and the name, as in `S6.stop`.\npub name: &'static str,\n\
         /// Milliseconds.\npub ms: u32,\n}}\n"
    );
    for rule in &book.rules {
        for limit in rule.limits.iter().filter(|limit| limit.unit == Unit::Ms) {
            let name = format!("{}.{}", rule.id, limit.name);
            if named(&upper(&name)) {
                let ms = number(limit.value);
                let explained = sentence(&format!("{}: {}", rule.id, limit.why));
                write!(
                    out,
                    "\n/// {explained}\npub const {}: Limit = Limit {{ name: \"{name}\", ms: {ms} }};\n",
                    upper(&name)
                )?;
            }
        }
    }
    Ok(out)
}

/// What an observer adds, and over how many milliseconds the events of a rule are spread.
pub(super) fn of_observers(book: &RuleBook) -> anyhow::Result<String> {
    let mut out = String::new();
    for allowance in &book.allowances {
        let (name, ms) = (upper(&allowance.name), number(allowance.value));
        write!(
            out,
            "\n/// {}\npub const {name}_MS: u32 = {ms};\n",
            sentence(&allowance.why)
        )?;
    }
    out.push_str(
        "\n/// Longest period of what implements a rule, in milliseconds.\n#[must_use]\npub fn period_ms(rule: &str) -> u32 {\nmatch rule {\n",
    );
    for rule in &book.rules {
        if let Some(period) = rule.period {
            writeln!(out, "\"{}\" => {},", rule.id, number(i64::from(period)))?;
        }
    }
    writeln!(out, "_ => {},\n}}\n}}", number(i64::from(super::USUAL_PERIOD_MS)))?;
    Ok(out)
}

/// The header for firmware in C: plain numbers with their units in the names.
pub(super) fn in_c(book: &RuleBook) -> anyhow::Result<String> {
    let mut out = format!(
        "/* Figures of the safety rules of SAFETY.md, for firmware in C. {MADE}\n *\n\
         \u{20}* A limit is what somebody outside must see; the others are what cordlib uses to stay within it. All are whole\n\
         \u{20}* numbers of the unit at the end of the name: MS milliseconds, CC hundredths of a degree Celsius, NM nanometres,\n\
         \u{20}* MILLIONTHS of full drive.\n *\n * SPDX-License-Identifier: GPL-3.0-or-later\n */\n\
         #ifndef CORDLIB_RULES_H\n#define CORDLIB_RULES_H\n"
    );
    for rule in &book.rules {
        if rule.limits.is_empty() && rule.settings.is_empty() {
            continue;
        }
        write!(out, "\n/* {}: {} */\n", rule.id, rule.fault)?;
        for limit in &rule.limits {
            let name = format!("LIMIT_{}_{}", upper(&rule.id), upper(&limit.name));
            define(&mut out, &name, (limit.value, limit.unit))?;
        }
        for setting in &rule.settings {
            let made = setting.constant(rule)?;
            let name = format!("{}_{}", upper(&setting.module), upper(&setting.name));
            define(&mut out, &name, (made.value, made.unit))?;
        }
    }
    latches_in_c(&mut out, book)?;
    out.push_str("\n#endif\n");
    Ok(out)
}

fn latches_in_c(out: &mut String, book: &RuleBook) -> anyhow::Result<()> {
    out.push_str(
        "\n/* What a latch forbids: 1 motion, 2 charging, 3 both. Cleared only when its cause is gone. */\n",
    );
    for latch in &book.latches {
        let forbids = latch.forbids.iter().map(|what| match what {
            Forbidden::Motion => 1,
            Forbidden::Charging => 2,
        });
        let forbids: i32 = forbids.sum();
        for inhibit in &latch.inhibits {
            writeln!(out, "#define CORD_LATCH_{}_FORBIDS {forbids}", upper(inhibit))?;
        }
    }
    Ok(())
}

fn define(out: &mut String, name: &str, (value, unit): (i64, Unit)) -> anyhow::Result<()> {
    let (ending, _) = unit.in_code();
    let name = format!("CORD_{name}{ending}");
    let value = if value < 0 {
        format!("({value})")
    } else {
        value.to_string()
    };
    Ok(writeln!(out, "#define {name} {value}")?)
}

fn declare(out: &mut String, why: &str, made: &Constant) -> anyhow::Result<()> {
    let (name, rust_type, value) = (&made.name, &made.rust_type, number(made.value));
    Ok(writeln!(
        out,
        "/// {}\npub(crate) const {name}: {rust_type} = {value};",
        sentence(why)
    )?)
}

/// With a full stop at the end, and nothing after a colon that explains nothing.
fn sentence(text: &str) -> String {
    let text = text.trim().trim_end_matches([':', '.']);
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    let all = if text.starts_with("stop") || text.starts_with("arming") {
        text.to_owned()
    } else {
        format!("{}{}", first.unwrap_or_default(), letters.as_str())
    };
    format!("{all}.")
}
