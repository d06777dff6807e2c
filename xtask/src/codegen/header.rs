//! C headers that programs of the workspace make from their own sources.

use super::Generated;
use crate::{process, workspace};
use anyhow::Context;
use std::path::Path;

/// A program and the files that it makes.
struct Maker {
    package: &'static str,
    program: &'static str,
    files: &'static [&'static str],
}

const MAKERS: [Maker; 2] = [
    Maker {
        package: "cordlib-c",
        program: "generate-header",
        files: &["firmware/cordlib-c/include/cordlib.h"],
    },
    Maker {
        package: "cord-c",
        program: "generate-cord",
        files: &[
            "firmware/cord-c/generated/wire.h",
            "firmware/cord-c/generated/tables.h",
            "firmware/relax/board/generated/machine.h",
        ],
    },
];

/// The headers as they should be. A maker writes them into their places; what stood there before is put back, so that the
/// caller alone decides what is written.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let mut made = Vec::new();
    for maker in &MAKERS {
        let read =
            |name: &&str| std::fs::read(root.join(name)).with_context(|| format!("cannot read {name}"));
        let before = maker.files.iter().map(read).collect::<anyhow::Result<Vec<_>>>()?;
        let mut generator = workspace::cargo();
        generator.args(["run", "--quiet", "--locked", "--package", maker.package]);
        generator.args(["--bin", maker.program]);
        process::run(&format!("make {}", maker.files.join(", ")), &mut generator)?;
        for (name, before) in maker.files.iter().zip(before) {
            let path = root.join(name);
            let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {name}"))?;
            std::fs::write(&path, before).with_context(|| format!("cannot write {name}"))?;
            made.push(Generated { path, text });
        }
    }
    Ok(made)
}
