//! Puts the linker scripts where the linker finds them.

use std::env;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = env::var("OUT_DIR")?;
    fs::write(Path::new(&out).join("link.x"), include_str!("link.x"))?;
    if env::var_os("CARGO_FEATURE_MEMORY_X").is_some() {
        fs::write(Path::new(&out).join("memory.x"), include_str!("memory.x"))?;
    }
    println!("cargo:rustc-link-search={out}");
    if env::var("CARGO_CFG_TARGET_ARCH")? == "mips" {
        println!("cargo:rustc-link-arg-examples=-Tlink.x");
    }
    println!("cargo:rerun-if-changed=link.x");
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-changed=build.rs");
    Ok(())
}
