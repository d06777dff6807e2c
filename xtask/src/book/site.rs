//! Links of the written site: what mdBook made of titles and files, not what we believe that it makes.

use crate::markdown_links::normal;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Pages that repeat others, or are shown for an address that is not there.
const REPEATED: [&str; 3] = ["print.html", "toc.html", "404.html"];

/// What a page offers and where it leads.
struct WrittenPage {
    ids: BTreeSet<String>,
    targets: Vec<String>,
}

/// A line for each link to a file or to an anchor that is not there.
pub(super) fn broken_links(site: &Path) -> anyhow::Result<Vec<String>> {
    let mut pages = BTreeMap::new();
    read(site, Path::new(""), &mut pages)?;
    let mut broken = Vec::new();
    for (path, page) in &pages {
        for target in &page.targets {
            if !leads_somewhere(site, (path, target), &pages) {
                broken.push(format!("{}: {target}", path.display()));
            }
        }
    }
    Ok(broken)
}

fn read(site: &Path, folder: &Path, pages: &mut BTreeMap<PathBuf, WrittenPage>) -> anyhow::Result<()> {
    for entry in std::fs::read_dir(site.join(folder))? {
        let entry = entry?;
        let path = folder.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            read(site, &path, pages)?;
        } else if path.extension().is_some_and(|ending| ending == "html")
            && !REPEATED.iter().any(|name| path == Path::new(name))
        {
            let text = std::fs::read_to_string(entry.path())?;
            pages.insert(path, page(&text));
        }
    }
    Ok(())
}

fn page(text: &str) -> WrittenPage {
    let values = |name: &str| -> Vec<String> {
        let head = format!(" {name}=\"");
        let quoted = text.split(&head).skip(1);
        quoted
            .filter_map(|rest| rest.split_once('"'))
            .map(|(value, _)| value.replace("&amp;", "&"))
            .collect()
    };
    let mut targets = values("href");
    targets.extend(values("src"));
    WrittenPage {
        ids: values("id").into_iter().collect(),
        targets,
    }
}

fn leads_somewhere(
    site: &Path,
    (from, target): (&Path, &str),
    pages: &BTreeMap<PathBuf, WrittenPage>,
) -> bool {
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    if file.contains(':') {
        return true;
    }
    let path = match (file, from.parent()) {
        ("", _) | (_, None) => from.to_owned(),
        (file, Some(folder)) => normal(&folder.join(file)),
    };
    match pages.get(&path) {
        Some(page) => anchor.is_empty() || page.ids.contains(anchor),
        None => site.join(&path).is_file(),
    }
}

#[cfg(test)]
mod tests {
    use super::{WrittenPage, leads_somewhere, page};
    use std::collections::BTreeMap;
    use std::path::{Path, PathBuf};

    #[test]
    fn anchors_must_be_there() {
        let pages: BTreeMap<PathBuf, WrittenPage> = [
            (
                "a.html",
                "<a href=\"guide/b.html#there\">b</a><h1 id=\"top\">A</h1>",
            ),
            ("guide/b.html", "<h2 id=\"there\">B</h2><img src=\"../no.png\">"),
        ]
        .map(|(path, text)| (PathBuf::from(path), page(text)))
        .into();
        let leads = |from: &str, target: &str| {
            leads_somewhere(Path::new("/nowhere"), (Path::new(from), target), &pages)
        };
        assert!(leads("a.html", "guide/b.html#there"));
        assert!(leads("guide/b.html", "../a.html#top"));
        assert!(leads("guide/b.html", "#there"));
        assert!(leads("a.html", "https://example.org/"));
        assert!(!leads("a.html", "guide/b.html#gone"));
        assert!(!leads("a.html", "guide/c.html"));
        assert!(!leads("guide/b.html", "../no.png"));
    }
}
