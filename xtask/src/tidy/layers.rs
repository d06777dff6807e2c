//! The layers of the brain: a module uses its own layer and those below it, and no modules of a layer use each other in a circle.
//!
//! A module is a direct child of a layer, a file or a folder with all below it. The layer's own `mod.rs` counts as a module named
//! like the layer. Tests are left out, and a name that was re-exported counts for the module that defines it.

mod circles;
mod imports;

use super::Finding;
use super::files::Files;
use crate::process;
use circles::circles;
use imports::{Import, Module, imports, modules};
use std::collections::{BTreeMap, BTreeSet};

/// What the rule wants.
pub(super) const WANTS: &str =
    "layers of the brain use only those below them, and modules of a layer do not use each other in circles";

/// Where the code is.
const ROOT: &str = "brain/src/";

/// The layers, the lowest first: each may use those before it.
const LAYERS: [&str; 10] = [
    "model",
    "mapping",
    "localization",
    "navigation",
    "recovery",
    "coverage",
    "travel",
    "docking",
    "behavior",
    "brain",
];

/// What the code shows.
#[derive(Debug, Default)]
struct Layout {
    /// The modules of each layer.
    modules: BTreeMap<String, BTreeSet<String>>,
    /// Imports that break the order of the layers, and modules that belong to none.
    misplaced: Vec<String>,
    /// Modules that use each other in a circle, with an import for each use.
    circles: Vec<String>,
}

/// Compares the code with the order of the layers.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let Layout {
        misplaced, circles, ..
    } = layout(&modules(&sources(files)));
    Ok(Finding::Checked([misplaced, circles].concat()))
}

/// Prints the layers with their modules, and the circles.
pub(super) fn print(files: &Files) {
    let layout = layout(&modules(&sources(files)));
    for (number, layer) in LAYERS.iter().enumerate() {
        let modules = layout.modules.get(*layer);
        let names: Vec<&str> = modules.into_iter().flatten().map(String::as_str).collect();
        process::print(&format!("{}. {layer}: {}", number + 1, names.join(", ")));
    }
    process::print(&format!(
        "{} imports against the order of the layers",
        layout.misplaced.len()
    ));
    process::print(&format!("{} circles", layout.circles.len()));
}

/// The source files below [`ROOT`] with their paths from there.
fn sources(files: &Files) -> Vec<(&str, &str)> {
    files
        .texts(&[".rs"])
        .filter_map(|(path, text)| Some((path.strip_prefix(ROOT)?, text)))
        .collect()
}

fn layout(modules: &[Module]) -> Layout {
    let mut layout = Layout::default();
    for module in modules {
        let Some(layer) = module.path.first() else {
            continue;
        };
        if rank(layer).is_none() {
            layout.misplaced.push(format!(
                "{ROOT}{}: {layer} is no layer; give it a place in LAYERS of xtask/src/tidy/layers.rs",
                module.file
            ));
            continue;
        }
        let names = layout.modules.entry(layer.clone()).or_default();
        names.extend(module.path.get(1).cloned());
    }
    let imports = imports(modules);
    layout
        .misplaced
        .extend(imports.iter().filter_map(against_the_order));
    layout.circles = circles_of(&imports);
    layout
}

/// Place of a layer in the order.
fn rank(layer: &str) -> Option<usize> {
    LAYERS.iter().position(|known| *known == layer)
}

/// What is wrong with an import of a layer that lies above.
fn against_the_order(import: &Import) -> Option<String> {
    let (from, to) = (import.from.first()?, import.to.first()?);
    if rank(from)? >= rank(to)? {
        return None;
    }
    Some(format!(
        "{ROOT}{}: {}: {from} may not use {to}, which lies above it",
        import.file, import.text
    ))
}

/// The modules of all layers that use each other in a circle.
fn circles_of(imports: &[Import]) -> Vec<String> {
    let mut uses: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for import in imports {
        let (from, to) = (unit(&import.from), unit(&import.to));
        if from != to && import.from.first() == import.to.first() {
            let example = format!("{ROOT}{}: {}", import.file, import.text);
            uses.entry(from).or_default().entry(to).or_insert(example);
        }
    }
    circles(&uses)
}

/// The module of a layer to which a path belongs.
fn unit(path: &[String]) -> String {
    path.iter().take(2).cloned().collect::<Vec<_>>().join("::")
}

#[cfg(test)]
mod tests {
    use super::{Layout, layout, modules};

    fn of(sources: &[(&str, &str)]) -> Layout {
        layout(&modules(sources))
    }

    #[test]
    fn layers_and_their_modules_are_listed() {
        let layout = of(&[
            ("lib.rs", "mod model;\nmod mapping;\npub use mapping::Map;\n"),
            ("model/mod.rs", "mod a;\nmod b;\n"),
            ("model/a.rs", ""),
            ("model/b/mod.rs", "mod c;\n"),
            ("model/b/c.rs", "use crate::model::a::A;\n"),
            (
                "mapping/mod.rs",
                "use crate::model::{a::A, b};\npub struct Map;\n",
            ),
        ]);
        let names: Vec<_> = layout.modules["model"].iter().map(String::as_str).collect();
        assert_eq!(names, ["a", "b"]);
        assert!(
            layout.misplaced.is_empty() && layout.circles.is_empty(),
            "{layout:?}"
        );
    }

    #[test]
    fn an_import_of_a_layer_above_names_file_and_import_also_through_the_root() {
        let root = ("lib.rs", "mod model;\nmod mapping;\npub use mapping::map::Map;\n");
        let head = ("mapping/mod.rs", "pub mod map;\n");
        let map = ("mapping/map.rs", "pub struct Map;\n");
        for import in [
            "use crate::mapping::map::Map;",
            "use crate::{\n    Map,\n};",
            "use crate::Map as Chart;",
            "fn f() -> crate::mapping::map::Map {}",
            "use super::super::mapping::map;",
        ] {
            let text = format!("//! Head.\n{import}\n");
            let layout = of(&[root, head, map, ("model/a.rs", &text)]);
            let found = layout.misplaced.join("\n");
            assert!(
                found.starts_with("brain/src/model/a.rs: ")
                    && found.ends_with("model may not use mapping, which lies above it"),
                "{import}: {found}"
            );
        }
    }

    #[test]
    fn a_folder_that_is_no_layer_is_refused() {
        let found = of(&[("helpers/a.rs", "")]).misplaced;
        assert!(
            found
                .join("\n")
                .starts_with("brain/src/helpers/a.rs: helpers is no layer"),
            "{found:?}"
        );
    }

    #[test]
    fn a_circle_is_found_through_re_exports_and_not_through_tests_and_comments() {
        let head = ("mapping/mod.rs", "mod a;\nmod b;\npub use a::A;\npub use b::B;\n");
        let a = ("mapping/a.rs", "use super::B;\npub struct A;\n");
        let circle = of(&[head, a, ("mapping/b.rs", "fn f(a: super::A) {}\n")]).circles;
        assert_eq!(
            circle,
            [
                "circle of mapping::a, mapping::b\n    brain/src/mapping/a.rs: super::B\n    brain/src/mapping/b.rs: super::A"
            ]
        );
        for harmless in [
            "//! See [`super::A`].\npub struct B;\n",
            "pub struct B;\n#[cfg(test)]\nmod tests {\n    use super::super::A;\n}\n",
            "pub struct B;\n#[cfg(test)]\nuse super::A;\n",
            "pub(in crate::mapping) struct B;\nconst TEXT: &str = \"super::A\";\n",
        ] {
            let layout = of(&[head, a, ("mapping/b.rs", harmless)]);
            assert!(layout.circles.is_empty(), "{harmless}: {:?}", layout.circles);
        }
    }

    #[test]
    fn a_module_that_uses_what_its_parent_defines_makes_a_circle_with_it() {
        let head = ("mapping/mod.rs", "mod a;\nuse a::A;\npub struct Map(A);\n");
        let found = of(&[head, ("mapping/a.rs", "use super::Map;\npub struct A;\n")]).circles;
        assert!(
            found.join("").starts_with("circle of mapping, mapping::a"),
            "{found:?}"
        );
    }

    #[test]
    fn files_of_test_modules_do_not_count() {
        let head = ("mapping/mod.rs", "mod a;\n#[cfg(test)]\nmod known;\nmod b;\n");
        let layout = of(&[
            head,
            ("mapping/a.rs", "use super::b::B;\n"),
            ("mapping/b.rs", "#[cfg(test)]\npub(crate) mod tests;\n"),
            ("mapping/b/tests.rs", "use crate::mapping::a;\n"),
            ("mapping/known.rs", "use crate::behavior::X;\n"),
            ("behavior/mod.rs", "pub struct X;\n"),
        ]);
        assert!(
            layout.misplaced.is_empty() && layout.circles.is_empty(),
            "{layout:?}"
        );
        assert!(!layout.modules["mapping"].contains("known"));
    }

    #[test]
    fn a_path_through_a_module_that_was_imported_counts_for_what_it_leads_to() {
        let layout = of(&[
            ("mapping/mod.rs", "mod a;\nmod b;\n"),
            ("mapping/a.rs", "use super::b;\nfn f() { b::g() }\n"),
            (
                "mapping/b.rs",
                "use crate::mapping;\nfn g() { mapping::a::f() }\n",
            ),
        ]);
        assert_eq!(layout.circles.len(), 1, "{layout:?}");
    }
}
