//! Modules that use each other in a circle.

use std::collections::{BTreeMap, BTreeSet};

/// Which module uses which, with the import that shows it.
type Uses = BTreeMap<String, BTreeMap<String, String>>;

/// Every group of modules of which each reaches each other one, with an import for each use within it.
pub(super) fn circles(uses: &Uses) -> Vec<String> {
    let reached: BTreeMap<&str, BTreeSet<&str>> = uses
        .keys()
        .map(|from| (from.as_str(), reach(uses, from)))
        .collect();
    let reaches = |from: &str, to: &str| reached.get(from).is_some_and(|there| there.contains(to));
    let mut told: BTreeSet<&str> = BTreeSet::new();
    let mut found = Vec::new();
    for from in uses.keys().filter(|from| reaches(from, from)) {
        if told.contains(from.as_str()) {
            continue;
        }
        let group: BTreeSet<&str> = uses
            .keys()
            .map(String::as_str)
            .filter(|other| reaches(from, other) && reaches(other, from))
            .collect();
        found.push(described(uses, &group));
        told.extend(group);
    }
    found
}

/// All modules that `from` uses, directly or through others.
fn reach<'uses>(uses: &'uses Uses, from: &str) -> BTreeSet<&'uses str> {
    let mut there = BTreeSet::new();
    let mut waiting: Vec<&str> = uses
        .get(from)
        .into_iter()
        .flat_map(BTreeMap::keys)
        .map(String::as_str)
        .collect();
    while let Some(next) = waiting.pop() {
        if there.insert(next) {
            waiting.extend(
                uses.get(next)
                    .into_iter()
                    .flat_map(BTreeMap::keys)
                    .map(String::as_str),
            );
        }
    }
    there
}

fn described(uses: &Uses, group: &BTreeSet<&str>) -> String {
    let names: Vec<&str> = group.iter().copied().collect();
    let mut lines = vec![format!("circle of {}", names.join(", "))];
    for from in group {
        let to_others = uses.get(*from).into_iter().flatten();
        lines.extend(
            to_others
                .filter(|(to, _)| group.contains(to.as_str()))
                .map(|(_, import)| format!("    {import}")),
        );
    }
    lines.join("\n")
}
