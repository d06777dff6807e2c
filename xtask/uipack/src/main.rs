//! Packs the panel: `uipack IN.wasm OUTDIR`.
//!
//! IN.wasm is what cargo made of clients/panel. It is split into what the first picture needs and what is loaded after it; the first goes
//! through wasm-bindgen, and the functions of each into an order that packs well. The modules, the page, the style sheet and the icons
//! of clients/panel/static go to OUTDIR under names that carry a hash of their content, each with a gzip and a Brotli twin. The page
//! and the service worker alone keep their names: they are what a browser asks for first. OUTDIR is replaced as a whole.
#![forbid(unsafe_code)]

mod arrange;
mod bundle;
mod split;

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use bundle::Bundle;
use split::{LINK, SCRIPT};
use wasm_bindgen_cli_support::{Bindgen, Output};

/// Pictures of the panel, the one for the page first and that for the home screens of phones second.
const ICONS: [&str; 4] = ["icon.svg", "icon-192.png", "icon-512.png", "icon-maskable.png"];

fn main() -> ExitCode {
    let arguments: Vec<OsString> = env::args_os().skip(1).collect();
    let [wasm, folder] = arguments.as_slice() else {
        eprintln!("usage: uipack IN.wasm OUTDIR");
        return ExitCode::from(2);
    };
    match pack(Path::new(wasm), Path::new(folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("uipack: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn pack(wasm: &Path, folder: &Path) -> Result<()> {
    let parts = split::split(wasm, &sibling(folder, "split")?)?;
    let (script, module) = bind(&parts.first)?;
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../clients/panel/static");
    let read_bytes = |name: &str| {
        let path = sources.join(name);
        fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    let read =
        |name: &str| String::from_utf8(read_bytes(name)?).with_context(|| format!("{name} is not UTF-8"));
    let mut bundle = Bundle::default();
    let module_name = bundle.add("panel.wasm", module);
    let mut link = parts.link;
    for (name, later) in parts.later {
        let named = bundle.add(&name, arrange::alike_together(&later)?);
        link = link.replace(&format!("./{name}"), &format!("./{named}"));
    }
    let [script_name, link_name] = bundle.add_bound([(SCRIPT, script), (LINK, link)])?;
    let boot = filled(
        &read("boot.js")?,
        &[("panel.js", &script_name), ("panel.wasm", &module_name)],
    )?;
    let boot_name = bundle.add("boot.js", boot.into_bytes());
    let style_name = bundle.add("panel.css", read("panel.css")?.into_bytes());
    let mut icons = Vec::new();
    for icon in ICONS {
        icons.push((icon, bundle.add(icon, read_bytes(icon)?)));
    }
    let icons: Vec<(&str, &String)> = icons.iter().map(|(icon, name)| (*icon, name)).collect();
    let manifest = filled(&read("manifest.webmanifest")?, &icons)?;
    let manifest_name = bundle.add("manifest.webmanifest", manifest.into_bytes());
    let [icon, touch_icon, ..] = icons.as_slice() else {
        bail!("the page needs two icons");
    };
    let names = [
        ("boot.js", &boot_name),
        (SCRIPT, &script_name),
        (LINK, &link_name),
        ("panel.css", &style_name),
        ("manifest.webmanifest", &manifest_name),
        *icon,
        *touch_icon,
    ];
    let page = filled(&read("index.html")?, &names)?;
    bundle.add_named("index.html", page.into_bytes());
    let worker = service_worker(&read("sw.js")?, &bundle)?;
    bundle.add_named("sw.js", worker.into_bytes());
    replace(folder, &bundle)?;
    for (name, [plain, gzip, brotli]) in bundle.sizes() {
        writeln!(
            std::io::stdout(),
            "{name} {plain} bytes, {gzip} gzip, {brotli} brotli"
        )
        .ok(); // Nobody may be listening.
    }
    Ok(())
}

/// The script that keeps the files of this version, and whose text is another one for every other version.
fn service_worker(template: &str, bundle: &Bundle) -> Result<String> {
    let name = |name: &str| match name {
        "index.html" => "'/'".to_owned(),
        name => format!("'/{name}'"),
    };
    let files: Vec<String> = bundle.sizes().map(|(file, ..)| name(file)).collect();
    let values = [("version", &bundle.version()), ("files", &files.join(", "))];
    filled(template, &values)
}

/// The JavaScript side and the module that belongs to it.
fn bind(wasm: &Path) -> Result<(String, Vec<u8>)> {
    let mut output = Bindgen::new()
        .input_path(wasm)
        .web(true)?
        .typescript(false)
        .omit_default_module_path(true)
        .remove_name_section(true)
        .remove_producers_section(true)
        // Of these the later modules take the table of functions.
        .keep_lld_exports(true)
        .generate_output()
        .with_context(|| {
            format!(
                "wasm-bindgen cannot read {}: build clients/panel first",
                wasm.display()
            )
        })?;
    let foreign: Vec<&String> = foreign_scripts(&output);
    if !foreign.is_empty() {
        bail!(
            "dependencies of the panel bring JavaScript files of their own, which are not packed: {foreign:?}"
        );
    }
    let module = arrange::alike_together(&output.wasm_mut().emit_wasm())?;
    Ok((output.js().to_owned(), module))
}

/// Crates whose own JavaScript the module wants beside the generated one.
fn foreign_scripts(output: &Output) -> Vec<&String> {
    let snippets = output
        .snippets()
        .iter()
        .filter(|(_, scripts)| !scripts.is_empty())
        .map(|(name, _)| name);
    snippets.chain(output.local_modules().keys()).collect()
}

/// The template with each `{{name}}` replaced; each must occur and none may be left.
fn filled(template: &str, values: &[(&str, &String)]) -> Result<String> {
    let mut text = template.to_owned();
    for (name, value) in values {
        let mark = format!("{{{{{name}}}}}");
        if !text.contains(&mark) {
            bail!("the template has no {mark}");
        }
        text = text.replace(&mark, value);
    }
    if text.contains("{{") {
        bail!("the template has a mark that nothing fills");
    }
    Ok(text)
}

/// Writes the bundle beside `folder` and puts it in its place. A folder that is not a packed panel is left alone.
fn replace(folder: &Path, bundle: &Bundle) -> Result<()> {
    let fresh = sibling(folder, "new")?;
    if fresh.exists() {
        fs::remove_dir_all(&fresh).with_context(|| format!("cannot clear {}", fresh.display()))?;
    }
    fs::create_dir_all(&fresh).with_context(|| format!("cannot make {}", fresh.display()))?;
    bundle.write(&fresh)?;
    if folder.exists() {
        let empty = fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none());
        if !empty && !folder.join("index.html").is_file() {
            bail!(
                "{} holds something that is not a packed panel: choose another folder",
                folder.display()
            );
        }
        fs::remove_dir_all(folder).with_context(|| format!("cannot replace {}", folder.display()))?;
    }
    fs::rename(&fresh, folder).with_context(|| format!("cannot make {}", folder.display()))
}

/// The folder beside OUTDIR whose name has the ending.
fn sibling(folder: &Path, ending: &str) -> Result<PathBuf> {
    let mut name = folder
        .file_name()
        .context("OUTDIR must be the name of a folder")?
        .to_owned();
    name.push(format!(".{ending}"));
    Ok(folder.with_file_name(name))
}

#[cfg(test)]
mod tests {
    use super::filled;

    #[test]
    fn every_mark_is_filled_and_every_value_used() {
        let name = "a-1.js".to_owned();
        assert_eq!(filled("x {{a.js}} y", &[("a.js", &name)]).unwrap(), "x a-1.js y");
        assert!(filled("x", &[("a.js", &name)]).is_err());
        assert!(filled("{{a.js}} {{b.js}}", &[("a.js", &name)]).is_err());
    }
}
