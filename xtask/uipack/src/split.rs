//! Cuts the program in two: what the first picture needs, and what is loaded after it.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use wasm_split_cli_support::{Options, transform};

/// The script that loads the later files; the first one imports it under this name.
pub(crate) const LINK: &str = "late.js";
/// The first script, from which that one takes what the files share.
pub(crate) const SCRIPT: &str = "panel.js";

/// The program in its files.
#[derive(Debug)]
pub(crate) struct Split {
    /// The module that comes first; wasm-bindgen has not seen it yet.
    pub(crate) first: PathBuf,
    /// The script that loads the others.
    pub(crate) link: String,
    /// Modules that come later, under the names by which the script calls them.
    pub(crate) later: Vec<(String, Vec<u8>)>,
}

/// Splits what cargo made into files of `folder`, which is replaced.
pub(crate) fn split(wasm: &Path, folder: &Path) -> Result<Split> {
    let read = |path: &Path| fs::read(path).with_context(|| format!("cannot read {}", path.display()));
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot clear {}", folder.display()))?;
    }
    let whole = read(wasm).context("build clients/panel first")?;
    let first = folder.join("first.wasm");
    let (link, script) = (format!("./{LINK}"), format!("./{SCRIPT}"));
    let mut options = Options::new(&whole);
    options.output_dir = folder;
    options.main_out_path = &first;
    options.link_name = &link;
    options.main_module = &script;
    // The library's own kind of error has no way into ours but its words.
    let parts = transform(options).map_err(|error| {
        anyhow!(
            "cannot split {}: {error:#}; was it linked with --emit-relocs?",
            wasm.display()
        )
    })?;
    let link = folder.join(LINK);
    let link = fs::read_to_string(&link).with_context(|| format!("cannot read {}", link.display()))?;
    let mut later = Vec::new();
    for path in parts.split_modules {
        let name = file_name(&path)?;
        // A part that came out empty is written too, and never loaded.
        if link.contains(&name) {
            later.push((name, read(&path)?));
        }
    }
    if later.is_empty() {
        bail!("{} marks no place where it is split", wasm.display());
    }
    Ok(Split { first, link, later })
}

fn file_name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|name| name.to_str());
    Ok(name
        .with_context(|| format!("{} has no name", path.display()))?
        .to_owned())
}
