//! The table of robots in the book, made from robots/*/robot.toml.

use super::Generated;
use anyhow::Context;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

const TABLE: &str = "docs/book/src/robots-table.md";

/// Names of all robots that are described, sorted.
pub(crate) fn names(robots: &Path) -> anyhow::Result<Vec<String>> {
    let mut names: Vec<String> = descriptions(robots)?
        .iter()
        .map(|(_, robot)| text(robot, "name"))
        .collect();
    names.sort();
    Ok(names)
}

/// The table as it should be.
pub(crate) fn table(root: &Path) -> anyhow::Result<Generated> {
    let mut text =
        String::from("<!-- Made by cargo xtask codegen from robots/*/robot.toml. Do not edit. -->\n");
    for (path, robot) in descriptions(&root.join("robots"))? {
        let shown = path.strip_prefix(root).unwrap_or(&path);
        writeln!(
            text,
            "\n## `{}`\n\nFrom `{}`.\n",
            self::text(&robot, "name"),
            shown.display()
        )?;
        writeln!(text, "| quantity | value |\n| --- | --- |")?;
        rows(&mut text, "", &robot)?;
    }
    Ok(Generated {
        path: root.join(TABLE),
        text,
    })
}

fn rows(text: &mut String, prefix: &str, table: &Table) -> anyhow::Result<()> {
    for (key, value) in table {
        let name = if prefix.is_empty() {
            key.clone()
        } else {
            format!("{prefix}.{key}")
        };
        match value {
            Value::Table(table) => rows(text, &name, table)?,
            Value::String(value) => writeln!(
                text,
                "| {name} | {} |",
                value.replace('|', "\\|").replace('\n', " ")
            )?,
            other => writeln!(text, "| {name} | {} |", other.to_string().replace('|', "\\|"))?,
        }
    }
    Ok(())
}

fn descriptions(robots: &Path) -> anyhow::Result<Vec<(PathBuf, Table)>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(robots).with_context(|| format!("cannot read {}", robots.display()))? {
        let path = entry?.path().join("robot.toml");
        if !path.is_file() {
            continue;
        }
        let text = std::fs::read_to_string(&path)?;
        found.push((
            path.clone(),
            text.parse::<Table>()
                .with_context(|| path.display().to_string())?,
        ));
    }
    found.sort_by(|left, right| left.0.cmp(&right.0));
    Ok(found)
}

fn text(robot: &Table, key: &str) -> String {
    robot
        .get(key)
        .and_then(Value::as_str)
        .unwrap_or_default()
        .to_owned()
}
