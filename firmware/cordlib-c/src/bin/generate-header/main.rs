//! Writes `include/cordlib.h` from the sources of this crate.

mod header;

use std::path::Path;

use anyhow::Context;

fn main() -> anyhow::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = header::generate(&root.join("src")).map_err(anyhow::Error::msg)?;
    let path = root.join("include/cordlib.h");
    std::fs::write(&path, text).with_context(|| format!("writing {}", path.display()))
}
