//! Compiling and linking with SDCC.

use super::{Mcs51Memory, beside, sealed};
use crate::{process, system, workspace};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The memory model: variables behind a pointer unless they say otherwise, arguments and locals on the stack.
const MODEL: [&str; 3] = ["-mmcs51", "--model-large", "--stack-auto"];
/// Folders with headers, below `firmware/`.
const INCLUDED: [&str; 6] = [
    "cord-c/cord",
    "cord-c/generated",
    "cordlib-c/include",
    "relax/board/generated",
    "relax/chip",
    "relax/chip/generated",
];
/// The file whose module comes first: it has `main`.
const MAIN: &str = "relax/board/main.c";
/// Folders with sources.
const COMPILED: [&str; 2] = ["relax/chip", "cord-c/cord"];

/// An image and what SDCC tells of it.
#[derive(Debug)]
pub(crate) struct Built {
    /// What is flashed.
    pub(super) image: PathBuf,
    /// What the linker wrote.
    linked: PathBuf,
    modules: Vec<PathBuf>,
    /// What the chip has.
    pub(super) chip: Mcs51Memory,
}

/// Builds into a folder.
pub(super) fn build(out: &Path, chip: Mcs51Memory) -> anyhow::Result<Built> {
    system::need("sdcc", &["sdcc"])?;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let root = workspace::root().join("firmware");
    let mut files = vec![root.join(MAIN)];
    for folder in COMPILED {
        files.extend(sources(&root.join(folder))?);
    }
    process::say("compile and link the firmware of relax with SDCC");
    let mut modules = Vec::new();
    for source in &files {
        let module = out
            .join(source.file_stem().unwrap_or_default())
            .with_extension("rel");
        let mut compiler = Command::new("sdcc");
        compiler
            .current_dir(&root)
            .args(MODEL)
            .args(["--std-c99", "--opt-code-size"]);
        for folder in INCLUDED {
            compiler.arg("-I").arg(folder);
        }
        // A path below the folder of the sources, so that no file names where the project lies.
        let source = source.strip_prefix(&root).unwrap_or(source);
        compiler.arg("-c").arg(source).arg("-o").arg(&module);
        process::capture(&mut compiler)?;
        modules.push(module);
    }
    let linked = out.join("linked.ihx");
    let mut linker = Command::new("sdcc");
    linker
        .args(MODEL)
        .args(["--xram-size", &chip.xdata.bytes.to_string()])
        .args(["--iram-size", &chip.idata.bytes.to_string()])
        .args(["--code-size", &chip.program_bytes().to_string()])
        .arg("-o");
    linker.arg(&linked).args(&modules);
    process::capture(&mut linker)?;
    let image = out.join("relax.ihx");
    std::fs::write(&image, sealed::seal(&read(&linked)?, chip.code.bytes)?)
        .with_context(|| format!("cannot write {}", image.display()))?;
    Ok(Built {
        image,
        linked,
        modules,
        chip,
    })
}

/// The C files of a folder, in the order of their names.
pub(super) fn sources(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "c") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

impl Built {
    /// What is flashed.
    pub(crate) fn image(&self) -> &Path {
        &self.image
    }

    /// The image as text.
    pub(super) fn hex(&self) -> anyhow::Result<String> {
        read(&self.image)
    }

    /// What the linker wrote, as text: the program without what was never written.
    pub(super) fn program(&self) -> anyhow::Result<String> {
        read(&self.linked)
    }

    /// What the linker says of memory.
    pub(super) fn memory(&self) -> anyhow::Result<String> {
        read(&beside(&self.linked, "mem"))
    }

    /// The assembler's listings.
    pub(super) fn listings(&self) -> anyhow::Result<Vec<String>> {
        self.modules
            .iter()
            .map(|module| read(&beside(module, "asm")))
            .collect()
    }

    /// Where a function is, in hexadecimal digits.
    pub(crate) fn address_of(&self, name: &str) -> anyhow::Result<String> {
        let map = read(&beside(&self.linked, "map"))?;
        let address = map.lines().find_map(|line| {
            let mut words = line.split_whitespace().skip_while(|word| word.ends_with(':'));
            let address = words.next()?;
            (words.next()? == name).then(|| address.to_owned())
        });
        address.with_context(|| format!("the linker's map has no {name}"))
    }
}

fn read(path: &Path) -> anyhow::Result<String> {
    std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}
