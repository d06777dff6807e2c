//! What mdBook is given: the pages of the book, and below `repository/` every document, picture and script outside of it that a page leads to.
//! mdBook shows only what lies in its own folder, while in the repository a document stands beside the code that it is about.

use crate::markdown_links::{inside, rewritten, way};
use anyhow::{Context, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Pages of the book, from the root of the repository.
const PAGES: &str = "docs/book/src";
/// The table of contents, which a site has beside every page: links to it lead to the first one.
const SUMMARY: &str = "docs/book/src/SUMMARY.md";
const FIRST: &str = "introduction.md";
/// Where everything else goes.
const BESIDE: &str = "repository";

/// The folder is ready.
pub(super) struct Staged {
    /// What `mdbook build` takes.
    pub(super) folder: PathBuf,
    pub(super) pages: usize,
    /// Those that the repository has outside of the book.
    pub(super) pages_beside: usize,
}

/// Lays out the sources below `folder`; what lay there is gone.
pub(super) fn stage(root: &Path, folder: &Path) -> anyhow::Result<Staged> {
    if folder.exists() {
        std::fs::remove_dir_all(folder)?;
    }
    let sources = folder.join("src");
    let mut reached = Reached::default();
    let contents = reached.follow(root, Path::new(SUMMARY))?;
    while let Some(document) = reached.waiting.pop() {
        if !reached.pages.contains_key(&document) {
            let text = reached.follow(root, &document)?;
            reached.pages.insert(document, text);
        }
    }
    for file in &reached.files {
        copy(&root.join(file), &sources.join(place(file)))?;
    }
    for (document, text) in &reached.pages {
        write(&sources.join(place(document)), text)?;
    }
    write(&sources.join("SUMMARY.md"), &reached.summary(&contents)?)?;
    let settings = std::fs::read_to_string(root.join("docs/book/book.toml"))?;
    // Otherwise a README becomes index.html, and the links to it lead nowhere.
    let settings = format!("{settings}\n[build]\nuse-default-preprocessors = false\n");
    write(&folder.join("book.toml"), &settings)?;
    Ok(Staged {
        folder: folder.to_owned(),
        pages: reached.pages.len(),
        pages_beside: reached.beside().count(),
    })
}

/// What can be reached from the summary.
#[derive(Default)]
struct Reached {
    /// The text of each page with the links that it has in the site, by its path in the repository.
    pages: BTreeMap<PathBuf, String>,
    /// Pages that somebody leads to.
    waiting: Vec<PathBuf>,
    /// Pictures, scripts and other files.
    files: BTreeSet<PathBuf>,
}

impl Reached {
    /// Gives the text of a document with the links that it has in the site, and notes what they lead to.
    fn follow(&mut self, root: &Path, document: &Path) -> anyhow::Result<String> {
        let text = std::fs::read_to_string(root.join(document))
            .with_context(|| format!("the page {}", document.display()))?;
        let mut led_to = Vec::new();
        let text = rewritten(&text, |target| {
            let (file, anchor) = inside(document, target)?;
            let target = format!("{}{anchor}", way(&place(document), &place(&file)));
            led_to.push(file);
            Some(target)
        });
        for file in led_to {
            if !root.join(&file).is_file() {
                bail!(
                    "{} leads to {}, which is no file: a site shows no folder",
                    document.display(),
                    file.display()
                );
            }
            if file.extension().is_none_or(|ending| ending != "md") {
                self.files.insert(file);
            } else if file != Path::new(SUMMARY) {
                self.waiting.push(file);
            }
        }
        Ok(text)
    }

    /// Places and texts of the pages that stand outside of the book.
    fn beside(&self) -> impl Iterator<Item = (PathBuf, &String)> {
        self.pages
            .iter()
            .map(|(document, text)| (place(document), text))
            .filter(|(place, _)| place.starts_with(BESIDE))
    }

    /// The book's contents, and the documents beside it as a part of their own: mdBook makes pages only of what stands here.
    fn summary(&self, contents: &str) -> anyhow::Result<String> {
        let mut text = format!("{contents}\n# In the repository\n\n");
        for (place, page) in self.beside() {
            let place = place.display();
            let title = page
                .lines()
                .find_map(|line| line.strip_prefix("# "))
                .with_context(|| format!("{place} has no title"))?;
            text.push_str(&format!("- [{title}]({place})\n"));
        }
        Ok(text)
    }
}

/// Where a file of the repository lies in the site's sources.
fn place(file: &Path) -> PathBuf {
    if file == Path::new(SUMMARY) {
        return PathBuf::from(FIRST);
    }
    match file.strip_prefix(PAGES) {
        Ok(own) => own.to_owned(),
        Err(_) => Path::new(BESIDE).join(file),
    }
}

fn write(file: &Path, text: &str) -> anyhow::Result<()> {
    folder_of(file)?;
    std::fs::write(file, text).with_context(|| file.display().to_string())
}

fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    folder_of(to)?;
    std::fs::copy(from, to).with_context(|| from.display().to_string())?;
    Ok(())
}

fn folder_of(file: &Path) -> anyhow::Result<()> {
    let folder = file.parent().context("a file lies in a folder")?;
    std::fs::create_dir_all(folder)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{place, stage};
    use std::path::{Path, PathBuf};

    #[test]
    fn the_book_keeps_its_places() {
        assert_eq!(
            place(Path::new("docs/book/src/guide/a.md")),
            PathBuf::from("guide/a.md")
        );
        assert_eq!(
            place(Path::new("SAFETY.md")),
            PathBuf::from("repository/SAFETY.md")
        );
    }

    fn repository(files: &[(&str, &str)]) -> PathBuf {
        let name = format!("book-staging-{}-{}", std::process::id(), files.len());
        let root = std::env::temp_dir().join(name);
        let _ = std::fs::remove_dir_all(&root);
        for (path, text) in files {
            super::write(&root.join(path), text).expect("a temporary folder can be written");
        }
        root
    }

    #[test]
    fn what_a_page_leads_to_comes_along_and_its_links_are_kept() {
        let root = repository(&[
            ("docs/book/book.toml", "[book]\ntitle = \"T\"\n"),
            ("docs/book/src/SUMMARY.md", "# S\n\n- [A](guide/a.md)\n"),
            (
                "docs/book/src/guide/a.md",
                "# A\n[rules](../../../../SAFETY.md#x)\n",
            ),
            (
                "SAFETY.md",
                "# Safety\n![way](pictures/way.svg) [a](docs/book/src/guide/a.md)\n",
            ),
            ("pictures/way.svg", "<svg/>"),
            ("LEFT.md", "# nobody leads here\n"),
        ]);
        let staged = stage(&root, &root.join("out")).expect("it can be staged");
        let read = |file: &str| std::fs::read_to_string(staged.folder.join("src").join(file)).ok();
        assert_eq!((staged.pages, staged.pages_beside), (2, 1));
        assert_eq!(
            read("guide/a.md").as_deref(),
            Some("# A\n[rules](../repository/SAFETY.md#x)\n")
        );
        assert_eq!(
            read("repository/SAFETY.md").as_deref(),
            Some("# Safety\n![way](pictures/way.svg) [a](../guide/a.md)\n")
        );
        assert!(read("repository/pictures/way.svg").is_some());
        assert!(read("repository/LEFT.md").is_none());
        assert!(read("SUMMARY.md").is_some_and(|text| text.contains("- [Safety](repository/SAFETY.md)")));
    }

    #[test]
    fn a_link_to_a_folder_is_named() {
        let root = repository(&[
            ("docs/book/book.toml", ""),
            ("docs/book/src/SUMMARY.md", "- [A](a.md)\n"),
            ("docs/book/src/a.md", "[code](../../../brain)\n"),
            ("brain/lib.rs", ""),
        ]);
        let error = stage(&root, &root.join("out"))
            .map(|_| ())
            .expect_err("a folder is no page");
        assert!(
            error.to_string().starts_with("docs/book/src/a.md leads to brain"),
            "{error}"
        );
    }
}
