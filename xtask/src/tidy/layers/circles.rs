//! Modules that use each other in a circle.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Which module uses which, with the import that shows it.
type Uses = BTreeMap<String, BTreeMap<String, String>>;

/// Every group of modules of which each reaches each other one, with the imports of its shortest circle.
pub(super) fn circles(uses: &Uses) -> Vec<String> {
    let reached: BTreeMap<&str, BTreeSet<&str>> = uses
        .keys()
        .map(|from| (from.as_str(), reach(uses, from)))
        .collect();
    let reaches = |from: &str, to: &str| reached.get(from).is_some_and(|there| there.contains(to));
    let mut told: BTreeSet<&str> = BTreeSet::new();
    let mut found = Vec::new();
    for from in uses.keys().map(String::as_str) {
        if !reaches(from, from) || told.contains(from) {
            continue;
        }
        let others = uses.keys().map(String::as_str);
        let group: BTreeSet<&str> = others
            .filter(|other| reaches(from, other) && reaches(other, from))
            .collect();
        found.push(described(uses, &group));
        told.extend(group);
    }
    found
}

/// What a module uses, with the imports that show it.
fn used_by<'uses>(uses: &'uses Uses, from: &str) -> impl Iterator<Item = (&'uses str, &'uses str)> {
    let used = uses.get(from).into_iter().flatten();
    used.map(|(to, import)| (to.as_str(), import.as_str()))
}

/// All modules that `from` uses, directly or through others.
fn reach<'uses>(uses: &'uses Uses, from: &str) -> BTreeSet<&'uses str> {
    let mut there = BTreeSet::new();
    let mut waiting: Vec<&str> = used_by(uses, from).map(|(to, _)| to).collect();
    while let Some(next) = waiting.pop() {
        if there.insert(next) {
            waiting.extend(used_by(uses, next).map(|(to, _)| to));
        }
    }
    there
}

fn described(uses: &Uses, group: &BTreeSet<&str>) -> String {
    let names: Vec<&str> = group.iter().copied().collect();
    let shortest = names.iter().filter_map(|from| shortest_circle(uses, from));
    let imports = shortest.min_by_key(Vec::len).unwrap_or_default();
    let mut lines = vec![format!("circle of {}", names.join(", "))];
    lines.extend(imports.iter().map(|import| format!("    {import}")));
    lines.join("\n")
}

/// The imports of the shortest circle from a module back to itself.
fn shortest_circle<'uses>(uses: &'uses Uses, from: &str) -> Option<Vec<&'uses str>> {
    let mut waiting = VecDeque::from([(from, Vec::new())]);
    let mut seen = BTreeSet::new();
    while let Some((at, imports)) = waiting.pop_front() {
        for (to, import) in used_by(uses, at) {
            let longer = [imports.as_slice(), &[import]].concat();
            if to == from {
                return Some(longer);
            }
            if seen.insert(to) {
                waiting.push_back((to, longer));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Uses, circles};

    fn uses(pairs: &[(&str, &str)]) -> Uses {
        let mut uses = Uses::new();
        for (from, to) in pairs {
            let of_module = uses.entry((*from).to_owned()).or_default();
            of_module.insert((*to).to_owned(), format!("{from} {to}"));
        }
        uses
    }

    #[test]
    fn each_group_is_reported_once_with_its_shortest_circle() {
        let pairs = [
            ("a", "b"),
            ("b", "c"),
            ("c", "a"),
            ("c", "b"),
            ("d", "a"),
            ("e", "f"),
            ("f", "e"),
        ];
        assert_eq!(
            circles(&uses(&pairs)),
            [
                "circle of a, b, c\n    b c\n    c b",
                "circle of e, f\n    e f\n    f e"
            ]
        );
    }

    #[test]
    fn what_uses_each_other_in_one_direction_is_no_circle() {
        assert!(circles(&uses(&[("a", "b"), ("a", "c"), ("b", "c")])).is_empty());
    }
}
