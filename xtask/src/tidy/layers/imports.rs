//! What each module of a crate uses, read from its source: `use` declarations and paths, without tests.

use crate::tidy::rust_text::code;
use std::collections::{BTreeMap, BTreeSet};

/// A module that is no test.
#[derive(Debug)]
pub(super) struct Module {
    /// Its names from the root of the crate on.
    pub(super) path: Vec<String>,
    /// Its file, from the folder of the source on.
    pub(super) file: String,
    /// Paths of its `use` declarations, each with the name that it gets here.
    uses: Vec<(String, Vec<String>)>,
    /// Paths in the code beside those.
    paths: Vec<Vec<String>>,
}

/// A use of another module.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Import {
    /// The file in which it stands.
    pub(super) file: String,
    /// The path as it stands there.
    pub(super) text: String,
    /// The module that uses.
    pub(super) from: Vec<String>,
    /// The module that defines what is used.
    pub(super) to: Vec<String>,
}

/// How often a name may be re-exported on its way.
const RE_EXPORTS_MAX: usize = 8;

/// The modules of a crate from its files; test modules are left out.
pub(super) fn modules(sources: &[(&str, &str)]) -> Vec<Module> {
    let plain: Vec<(&str, Vec<String>, String)> = sources
        .iter()
        .map(|(file, text)| (*file, path_of(file), code(text)))
        .collect();
    let tests: BTreeSet<Vec<String>> = plain
        .iter()
        .flat_map(|(_, path, text)| test_modules(text).into_iter().map(|name| child(path, &name)))
        .collect();
    let is_test = |path: &[String]| {
        (1..=path.len()).any(|length| path.get(..length).is_some_and(|part| tests.contains(part)))
    };
    plain
        .into_iter()
        .filter(|(_, path, _)| !is_test(path))
        .map(|(file, path, text)| {
            let (declared, rest) = without_uses(&without_tests(&text));
            Module {
                path,
                file: file.to_owned(),
                uses: declared.iter().flat_map(|tree| expanded(tree)).collect(),
                paths: paths(&rest),
            }
        })
        .collect()
}

/// All that modules use of each other.
pub(super) fn imports(modules: &[Module]) -> Vec<Import> {
    let known: BTreeMap<&[String], &Module> = modules
        .iter()
        .map(|module| (module.path.as_slice(), module))
        .collect();
    let mut found = Vec::new();
    for module in modules {
        let declared = module.uses.iter().map(|(_, path)| path);
        for path in declared.chain(&module.paths) {
            let absolute = absolute(module, path, &known);
            let Some(to) = absolute.and_then(|absolute| definer(&absolute, &known, 0)) else {
                continue;
            };
            if to != module.path {
                found.push(Import {
                    file: module.file.clone(),
                    text: path.join("::"),
                    from: module.path.clone(),
                    to,
                });
            }
        }
    }
    found
}

/// A path from the root of the crate on; `None` for one that leads into another crate or stays in the module.
fn absolute(module: &Module, path: &[String], known: &BTreeMap<&[String], &Module>) -> Option<Vec<String>> {
    let first = path.first()?;
    let after = |count: usize| path.get(count..).unwrap_or_default().to_vec();
    match first.as_str() {
        "crate" => Some(after(1)),
        "self" => Some([module.path.clone(), after(1)].concat()),
        "super" => {
            let ups = path.iter().take_while(|part| *part == "super").count();
            let kept = module.path.len().checked_sub(ups)?;
            Some([module.path.get(..kept)?.to_vec(), after(ups)].concat())
        }
        name => {
            let declared = module
                .uses
                .iter()
                .find(|(given, target)| given == name && target.as_slice() != path);
            if let Some((_, target)) =
                declared.filter(|(_, target)| target.first().is_some_and(|first| first != name))
            {
                return absolute(module, &[target.clone(), after(1)].concat(), known);
            }
            let inside = child(&module.path, name);
            known
                .contains_key(inside.as_slice())
                .then(|| [inside, after(1)].concat())
        }
    }
}

/// The module that defines what a path leads to: what is re-exported on the way is followed.
fn definer(path: &[String], known: &BTreeMap<&[String], &Module>, depth: usize) -> Option<Vec<String>> {
    let module = (0..=path.len())
        .rev()
        .find_map(|length| known.get(path.get(..length)?))?;
    let next = path.get(module.path.len());
    let re_export = next.and_then(|name| module.uses.iter().find(|(given, _)| given == name));
    if let Some((_, target)) = re_export.filter(|_| depth < RE_EXPORTS_MAX) {
        let rest = path.get(module.path.len() + 1..).unwrap_or_default();
        let whole = [target.as_slice(), rest].concat();
        return definer(&absolute(module, &whole, known)?, known, depth + 1);
    }
    Some(module.path.clone())
}

fn child(path: &[String], name: &str) -> Vec<String> {
    [path, &[name.to_owned()]].concat()
}

/// `mapping/map/mod.rs` and `mapping/map.rs` are `mapping::map`.
fn path_of(file: &str) -> Vec<String> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let parts = stem.split('/').map(str::to_owned).collect::<Vec<_>>();
    match parts.split_last() {
        Some((last, folder)) if last == "mod" || (last == "lib" && folder.is_empty()) => folder.to_vec(),
        _ => parts,
    }
}

/// Names of the modules that are declared for tests only, `#[cfg(test)] mod name;`.
fn test_modules(code: &str) -> Vec<String> {
    let declared = code.split("#[cfg(test)]").skip(1).filter_map(|after| {
        let item = after.split([';', '{']).next()?;
        let is_file = after.get(item.len()..)?.starts_with(';');
        let name = item.trim().rsplit_once("mod ")?.1;
        is_file.then(|| name.trim().to_owned())
    });
    declared.collect()
}

/// Code in which every item marked `#[cfg(test)]` is gone.
fn without_tests(code: &str) -> String {
    let mut out = String::new();
    let mut rest = code;
    while let Some((before, marked)) = rest.split_once("#[cfg(test)]") {
        out.push_str(before);
        rest = marked.get(item_length(marked)..).unwrap_or_default();
    }
    out + rest
}

/// Length of the item that begins here: up to its `;` or the end of its block.
fn item_length(code: &str) -> usize {
    let mut depth = 0_usize;
    for (at, letter) in code.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth <= 1 => return at + 1,
            '}' => depth -= 1,
            ';' if depth == 0 => return at + 1,
            _ => {}
        }
    }
    code.len()
}

/// The trees of all `use` declarations, and the code without them and without `in` paths of visibilities.
fn without_uses(code: &str) -> (Vec<String>, String) {
    let (mut trees, mut rest) = (Vec::new(), String::new());
    let mut lines = code.lines();
    while let Some(line) = lines.next() {
        let Some(begun) = use_tree(line) else {
            rest.push_str(without_visibility(line).as_str());
            rest.push('\n');
            continue;
        };
        let mut tree = begun.to_owned();
        while !tree.contains(';') {
            let Some(more) = lines.next() else { break };
            tree.push_str(more);
        }
        trees.push(tree.split(';').next().unwrap_or_default().to_owned());
    }
    (trees, rest)
}

/// What is imported by a line that begins a `use` declaration.
fn use_tree(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let item = match line.strip_prefix("pub") {
        Some(after) if after.starts_with('(') => after.split_once(')')?.1.trim_start(),
        Some(after) => after.trim_start(),
        None => line,
    };
    item.strip_prefix("use ")
}

fn without_visibility(line: &str) -> String {
    match line.split_once("pub(in ") {
        Some((before, after)) => {
            let item = after.split_once(')').map_or("", |(_, item)| item);
            format!("{before}{}", without_visibility(item))
        }
        None => line.to_owned(),
    }
}

/// The paths of a tree, each with the name that it gets.
fn expanded(tree: &str) -> Vec<(String, Vec<String>)> {
    let tree = tree.trim();
    let Some((before, inside)) = tree.split_once('{') else {
        let (path, alias) = tree.split_once(" as ").unwrap_or((tree, ""));
        let mut parts: Vec<String> = path
            .trim()
            .split("::")
            .map(|part| part.trim().to_owned())
            .collect();
        if parts.len() > 1 && parts.last().is_some_and(|last| last == "self" || last == "*") {
            parts.pop();
        }
        let name = parts.last().filter(|_| alias.is_empty()).cloned();
        return vec![(name.unwrap_or_else(|| alias.trim().to_owned()), parts)];
    };
    let inside = inside.rsplit_once('}').map_or(inside, |(inside, _)| inside);
    branches(inside)
        .iter()
        .flat_map(|branch| expanded(&format!("{before}{branch}")))
        .collect()
}

/// The branches of a tree, at its commas outside of inner braces.
fn branches(inside: &str) -> Vec<String> {
    let (mut found, mut depth) = (vec![String::new()], 0_usize);
    for letter in inside.chars() {
        match letter {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if letter == ',' && depth == 0 {
            found.push(String::new());
        } else if let Some(last) = found.last_mut() {
            last.push(letter);
        }
    }
    found.retain(|branch| !branch.trim().is_empty());
    found.iter().map(|branch| branch.trim().to_owned()).collect()
}

/// All paths of at least two names in code.
fn paths(code: &str) -> Vec<Vec<String>> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    code.split(|letter| !is_part(letter))
        .filter(|word| word.contains("::") && !word.starts_with(':'))
        .map(|word| {
            word.split("::")
                .filter(|part| !part.is_empty())
                .map(str::to_owned)
                .collect()
        })
        .collect()
}
