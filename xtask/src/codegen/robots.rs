//! The tables of robots in the book, made from robots/*/robot.toml.

use super::Generated;
use anyhow::Context;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

const PAGE: &str = "docs/book/src/robots-table.md";

const HEAD: &str = "\
<!-- Made by cargo xtask codegen from robots/*/robot.toml. Do not edit. -->
# Robots: sizes and limits

Each figure says how it is known. A *placeholder* was chosen so that the simulator has something to work with: measure
it before a real robot drives.
";

/// Names of all robots that are described, sorted.
pub(crate) fn names(robots: &Path) -> anyhow::Result<Vec<String>> {
    let mut names: Vec<String> = descriptions(robots)?
        .iter()
        .map(|(_, robot)| word(robot, "name"))
        .collect();
    names.sort();
    Ok(names)
}

/// The description of the robot with this name, if there is one.
pub(crate) fn description(robots: &Path, name: &str) -> anyhow::Result<Option<PathBuf>> {
    let found = descriptions(robots)?.into_iter();
    let mut found = found.filter(|(_, robot)| word(robot, "name") == name);
    Ok(found.next().map(|(path, _)| path))
}

/// The page as it should be.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let mut text = String::from(HEAD);
    for (path, robot) in descriptions(&root.join("robots"))? {
        let shown = path.strip_prefix(root).unwrap_or(&path);
        writeln!(
            text,
            "\n## {} (`{}`)\n",
            word(&robot, "title"),
            word(&robot, "name")
        )?;
        writeln!(text, "From `{}`.\n", shown.display())?;
        writeln!(
            text,
            "| quantity | value | unit | known how | source |\n| --- | --- | --- | --- | --- |"
        )?;
        for (part, figures) in &robot {
            for (name, figure) in figures.as_table().into_iter().flatten() {
                row(&mut text, &format!("{part}: {name}"), figure)?;
            }
        }
    }
    Ok(vec![Generated {
        path: root.join(PAGE),
        text,
    }])
}

fn row(text: &mut String, name: &str, figure: &Value) -> anyhow::Result<()> {
    let Some(figure) = figure.as_table() else {
        return Ok(writeln!(text, "| {name} | {} | | | |", plain(figure))?);
    };
    let value = figure
        .get("value")
        .or_else(|| figure.get("values"))
        .map(plain)
        .unwrap_or_default();
    let unit = word(figure, "unit");
    let unit = if unit == "1" { "" } else { &unit };
    let (confidence, source) = (word(figure, "confidence"), word(figure, "source"));
    Ok(writeln!(
        text,
        "| {name} | {value} | {unit} | {confidence} | {source} |"
    )?)
}

fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.replace('|', "\\|"),
        Value::Array(values) => values.iter().map(plain).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    }
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

fn word(table: &Table, key: &str) -> String {
    table
        .get(key)
        .and_then(Value::as_str)
        .unwrap_or_default()
        .replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::row;

    #[test]
    fn a_figure_becomes_a_row() {
        let table: toml::Table = "a = { value = 0.5, unit = \"m\", confidence = \"known\", source = \"board\" }\nb = { values = [1, 2] }"
            .parse()
            .expect("valid");
        let mut text = String::new();
        for (name, figure) in &table {
            row(&mut text, name, figure).expect("a string takes everything");
        }
        assert_eq!(text, "| a | 0.5 | m | known | board |\n| b | 1, 2 |  |  |  |\n");
    }
}
