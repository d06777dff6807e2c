//! Licences of everything we depend on, and of our own crates.

use super::Finding;
use super::files::Files;
use crate::metadata::{Package, WORKSPACES, packages};

/// Licences that may be joined with code under GPL-3.0-or-later and AGPL-3.0-or-later.
const FITTING: [&str; 14] = [
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "0BSD",
    "Unlicense",
    "CC0-1.0",
    "Unicode-3.0",
    "BSL-1.0",
    "NCSA",
    "MPL-2.0",
];

/// Compares each package's licence with the list.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let mut found = Vec::new();
    for workspace in WORKSPACES
        .iter()
        .filter(|workspace| files.has(workspace.manifest))
    {
        for package in packages(workspace)?.values() {
            if let Some(fault) = fault(package) {
                found.push(format!("{} ({}): {fault}", package.name, workspace.manifest));
            }
        }
    }
    found.sort();
    found.dedup();
    Ok(Finding::Checked(found))
}

fn fault(package: &Package) -> Option<String> {
    if package.ours {
        let expected = if is_panel(&package.name) {
            "AGPL-3.0-or-later"
        } else {
            "GPL-3.0-or-later"
        };
        return (package.licence != expected)
            .then(|| format!("is {:?}, must be {expected}", package.licence));
    }
    (!fits(&package.licence)).then(|| {
        format!(
            "licence {:?} is not on the list of licences that fit",
            package.licence
        )
    })
}

fn is_panel(name: &str) -> bool {
    name.starts_with("panel")
}

/// Whether an expression of `OR`, `AND`, `WITH` and brackets can be met with licences of the list.
///
/// `AND` binds closer than `OR`; a bracket is taken as one choice, which is enough for what crates declare.
fn fits(expression: &str) -> bool {
    let flat = expression
        .replace(" WITH LLVM-exception", "")
        .replace('/', " OR ");
    let groups = flat
        .split(" AND ")
        .map(|group| group.trim_matches(['(', ')', ' ']).to_owned())
        .collect::<Vec<_>>();
    !expression.is_empty()
        && groups.iter().all(|group| {
            group
                .split(" OR ")
                .any(|name| FITTING.contains(&name.trim_matches(['(', ')', ' '])))
        })
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn expressions() {
        assert!(fits("MIT OR Apache-2.0"));
        assert!(fits("(MIT OR Apache-2.0) AND Unicode-3.0"));
        assert!(fits("MIT/Apache-2.0"));
        assert!(fits("Apache-2.0 WITH LLVM-exception"));
        assert!(!fits("MIT AND Proprietary"));
        assert!(!fits("GPL-2.0-only"));
        assert!(!fits(""));
    }
}
