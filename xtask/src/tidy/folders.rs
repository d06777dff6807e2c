//! The README tells of every folder at the top.

use super::Finding;
use super::files::Files;
use std::collections::BTreeSet;

/// Looks for a row `| [name/](name) | sentence |` for each top folder.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let readme = files.text("README.md").unwrap_or_default();
    let folders: BTreeSet<&str> = files
        .all()
        .filter_map(|file| file.path.split_once('/'))
        .map(|(folder, _)| folder)
        .collect();
    let missing = folders.into_iter().filter(|folder| !tells(readme, folder));
    Ok(Finding::Checked(
        missing
            .map(|folder| format!("README.md: no sentence about {folder}/"))
            .collect(),
    ))
}

fn tells(readme: &str, folder: &str) -> bool {
    let name = format!("`{folder}/`");
    readme
        .lines()
        .any(|line| line.starts_with('|') && line.contains(&name))
}
