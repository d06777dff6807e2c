//! Gives each program its linker script.

use std::path::Path;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    for program in ["chip", "user"] {
        let script = Path::new(&folder).join(format!("{program}.ld"));
        println!("cargo:rustc-link-arg-bin={program}=-T{}", script.display());
        println!("cargo:rerun-if-changed={program}.ld");
    }
}
