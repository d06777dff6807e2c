//! What a first visit to the panel brings over the network, read from the packed files: what the robot and its Start button wait for, and
//! the views that are loaded behind it.

use crate::process;
use anyhow::Context;
use serde_json::json;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// What browsers fetch only when the page goes to a phone's home screen.
const LATER: &str = "apple-touch-icon";

/// Files that the page names, those that its scripts name, and their bytes, packed as a browser takes them.
fn fetched(folder: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    let page = text(folder, "index.html")?;
    let mut names: BTreeSet<String> = BTreeSet::from(["index.html".to_owned()]);
    for line in page.lines().filter(|line| !line.contains(LATER)) {
        names.extend(named(folder, line, &["href=\"", "src=\""], '"'));
    }
    let scripts: Vec<String> = names
        .iter()
        .filter(|name| name.ends_with(".js"))
        .cloned()
        .collect();
    for script in scripts {
        names.extend(named(folder, &text(folder, &script)?, &["'./"], '\''));
    }
    sized(folder, names)
}

/// The modules that the scripts load after the first picture, and their bytes.
fn later(folder: &Path, first: &[(String, u64)]) -> anyhow::Result<Vec<(String, u64)>> {
    let mut names = BTreeSet::new();
    for (script, _) in first.iter().filter(|(name, _)| name.ends_with(".js")) {
        names.extend(named(folder, &text(folder, script)?, &["new URL(\"./"], '"'));
    }
    sized(folder, names)
}

fn sized(folder: &Path, names: BTreeSet<String>) -> anyhow::Result<Vec<(String, u64)>> {
    let packed = |name: String| {
        let packed = folder.join(format!("{name}.br"));
        let bytes = fs::metadata(&packed)
            .with_context(|| format!("cannot read {}", packed.display()))?
            .len();
        Ok((name, bytes))
    };
    names.into_iter().map(packed).collect()
}

/// Files of the folder whose names stand behind one of the marks, up to `end`.
fn named(folder: &Path, text: &str, marks: &[&str], end: char) -> Vec<String> {
    let behind = marks.iter().flat_map(|mark| text.split(mark).skip(1));
    behind
        .filter_map(|rest| Some(rest.split_once(end)?.0.to_owned()))
        .filter(|name| folder.join(name).is_file())
        .collect()
}

fn text(folder: &Path, name: &str) -> anyhow::Result<String> {
    let path = folder.join(name);
    fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
}

/// Prints it as one line of JSON: bytes over the wire with Brotli, and requests, until the robot is on the screen and after it.
pub(super) fn print(folder: &Path) -> anyhow::Result<()> {
    let files = fetched(folder)?;
    let later = later(folder, &files)?;
    let bytes = |files: &[(String, u64)]| files.iter().map(|(_, bytes)| bytes).sum::<u64>();
    let figures = json!({
        "first_load_bytes": bytes(&files), "requests": files.len(), "files": files,
        "later_bytes": bytes(&later), "later": later,
    });
    process::print(&figures.to_string());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{fetched, later};
    use std::fs;

    #[test]
    fn the_page_and_what_it_and_its_scripts_name_is_counted_once() {
        let folder = std::env::temp_dir().join(format!("xtask-first-load-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let page = "<link rel=\"icon\" href=\"a.svg\">\n<link rel=\"modulepreload\" href=\"p.js\">\n\
                    <script src=\"p.js\"></script>\n<link rel=\"apple-touch-icon\" href=\"i.png\">";
        for (name, bytes) in [
            ("index.html", page.as_bytes()),
            ("a.svg", b"1"),
            (
                "p.js",
                b"fetch('./m.wasm'); import('./p.js'); import('./gone.js'); new URL(\"./l.wasm\")",
            ),
            ("m.wasm", b"22"),
            ("l.wasm", b"4444"),
            ("i.png", b"333"),
        ] {
            fs::write(folder.join(name), bytes).unwrap();
            fs::write(folder.join(format!("{name}.br")), bytes).unwrap();
        }
        let files = fetched(&folder).unwrap();
        let late = later(&folder, &files).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a.svg", "index.html", "m.wasm", "p.js"]);
        assert_eq!(files[2].1, 2);
        assert_eq!(late, [("l.wasm".to_owned(), 4)]);
    }
}
