//! The book's wiki of machines: a page each, made from what robots/ tells of them, and a list of all.

mod data;
mod page;
#[cfg(test)]
mod tests;

use super::Generated;
use super::board::{self, Pinout};
use anyhow::{Context, bail};
use data::MachineKind;
pub(crate) use data::{BoardLikeness, FactsOrigin, MachineFacts, variants};
use page::Background;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

const FOLDER: &str = "docs/book/src/machines";
const CONTENTS: &str = "docs/book/src/SUMMARY.md";

const HEAD: &str = "\
<!-- Made by cargo xtask codegen from robots/. Do not edit. -->
# Machines

One page a machine, all in one form: parts, chip, pins, connectors, protocol, and what nobody knows. A page speaks only of what is known.
No window cleaner is here yet, and no snow blower: nobody of this project knows anything about one.

Each line says how sure it is:

| word | meaning |
| --- | --- |
| known | a document of the maker, a measurement, or two sources that do not copy each other |
| one source | one source says so |
| unverified | a guess, or what is said of such machines in general: look before you rely on it |

To add a machine, write `robots/machines/NAME.toml` ([the keys](../../../../robots/README.md#machines)) and run `cargo xtask codegen`. To
bring one to life, follow the [porting guide](../porting.md).
";

/// The pages and their list, as they should be.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let described = board::described(root)?;
    let machines = data::all(root, &described)?;
    check_names(&machines)?;
    check_folder(root, &machines)?;
    let mut files = vec![Generated {
        path: root.join(FOLDER).join("index.md"),
        text: list(&machines)?,
    }];
    for machine in &machines {
        files.push(Generated {
            path: root.join(FOLDER).join(format!("{}.md", machine.name)),
            text: page_of(root, machine, &machines)?,
        });
    }
    Ok(files)
}

fn page_of(root: &Path, machine: &MachineFacts, all: &[MachineFacts]) -> anyhow::Result<String> {
    let facts = match &machine.origin {
        FactsOrigin::Ours(folder) => Some(folder),
        FactsOrigin::Sister(sister) => Some(&sister.base),
        FactsOrigin::Others => None,
    };
    let pinout = facts
        .map(|facts| Pinout::load(&root.join("robots"), &root.join(facts)))
        .transpose()?;
    if let Some(pinout) = &pinout {
        machine.check(pinout)?;
    }
    let base =
        match &machine.origin {
            FactsOrigin::Sister(sister) => Some(base(&sister.base, all).with_context(|| {
                format!("{}: {} has no machine.toml", machine.file.display(), sister.base)
            })?),
            FactsOrigin::Ours(_) | FactsOrigin::Others => None,
        };
    let pinout = pinout.as_ref();
    Ok(page::text(machine, &Background { pinout, base })?)
}

fn base<'a>(facts: &str, all: &'a [MachineFacts]) -> Option<&'a MachineFacts> {
    all.iter()
        .find(|machine| matches!(&machine.origin, FactsOrigin::Ours(folder) if folder == facts))
}

/// Two machines of one name would share a page.
fn check_names(machines: &[MachineFacts]) -> anyhow::Result<()> {
    let mut names = BTreeSet::from(["index"]);
    match machines.iter().find(|machine| !names.insert(&machine.name)) {
        Some(machine) => bail!("{}: there is a page of this name already", machine.file.display()),
        None => Ok(()),
    }
}

/// Every page stands in the book's contents, and none is left of a machine whose file is gone.
fn check_folder(root: &Path, machines: &[MachineFacts]) -> anyhow::Result<()> {
    let contents = std::fs::read_to_string(root.join(CONTENTS)).context(CONTENTS)?;
    let missing: Vec<String> = machines
        .iter()
        .filter(|machine| !contents.contains(&format!("(machines/{}.md)", machine.name)))
        .map(|machine| format!("[{}](machines/{}.md)", machine.title, machine.name))
        .collect();
    if !missing.is_empty() {
        bail!("{CONTENTS} lacks {}", missing.join(", "));
    }
    for entry in std::fs::read_dir(root.join(FOLDER)).into_iter().flatten() {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let page = name.strip_suffix(".md").unwrap_or(&name);
        if page != "index" && !machines.iter().any(|machine| machine.name == page) {
            bail!(
                "{FOLDER}/{name} is the page of no machine: delete it, or write robots/machines/{page}.toml"
            );
        }
    }
    Ok(())
}

fn list(machines: &[MachineFacts]) -> Result<String, std::fmt::Error> {
    let mut text = String::from(HEAD);
    for (kind, title) in [
        (MachineKind::Vacuum, "Vacuum cleaners"),
        (MachineKind::Mower, "Lawn mowers"),
        (MachineKind::Base, "Bases without tools"),
        (MachineKind::Sensor, "Sensors"),
    ] {
        let mut of_kind = machines.iter().filter(|machine| machine.kind == kind).peekable();
        if of_kind.peek().is_none() {
            continue;
        }
        writeln!(
            text,
            "\n## {title}\n\n| machine | also | what runs |\n| --- | --- | --- |"
        )?;
        for machine in of_kind {
            let also = page::cell(&machine.also_sold_as.join(", "));
            writeln!(
                text,
                "| [{}]({}.md) | {also} | {} |",
                machine.title,
                machine.name,
                page::cell(&machine.runs)
            )?;
        }
    }
    Ok(text)
}
