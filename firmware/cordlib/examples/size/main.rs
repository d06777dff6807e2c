//! What cordlib costs: the size of its state on this machine, and flash and memory of the linked probe
//! (`firmware/size-probe`) on a MIPS microcontroller.
//!
//! `cargo run -p cordlib --example size [-- --json]`. Without Debian's `rustc-web`, `rust-web-src` and `lld-19` it says
//! that the microcontroller was not measured, and succeeds.

mod elf;

use std::path::Path;
use std::process::Command;

const RUSTC: &str = "/usr/bin/rustc";
const CARGO: &str = "/usr/bin/cargo";
const LIBRARY_SOURCE: &str = "/usr/lib/rustlib/src/rust/library";
const LINKER: &str = "ld.lld-19";
const TARGET: &str = "mipsel-unknown-none";
/// Memory of the PIC32MX360F256L, in bytes.
const FLASH: u32 = 256 * 1024;
const RAM: u32 = 32 * 1024;

fn main() {
    let as_json = std::env::args().any(|argument| argument == "--json");
    match measure() {
        Ok(Some(image)) if as_json => println!(
            "{{\"target\":\"{TARGET}\",\"flash_bytes\":{},\"cord_bytes\":{},\"static_bytes\":{},\"panic_paths\":{}}}",
            image.flash, image.cord, image.static_memory, image.panic_paths
        ),
        Ok(Some(image)) => {
            println!("{TARGET}, optimised for size, protocol included:");
            println!("  flash  {:>6} of {FLASH} bytes", image.flash);
            println!(
                "  memory {:>6} of {RAM} bytes: the state of the robot",
                image.cord
            );
            println!("         {:>6} bytes of variables besides", image.static_memory);
            println!("  panic paths: {}", image.panic_paths);
        }
        Ok(None) if as_json => println!("{{\"target\":null}}"),
        Ok(None) => println!("not measured: {RUSTC}, {LIBRARY_SOURCE} and {LINKER} are needed"),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}

fn measure() -> Result<Option<elf::Image>, String> {
    let complete = [RUSTC, CARGO, LIBRARY_SOURCE]
        .iter()
        .all(|path| Path::new(path).exists())
        && Command::new(LINKER).arg("--version").output().is_ok();
    if !complete {
        return Ok(None);
    }
    let probe = Path::new(env!("CARGO_MANIFEST_DIR")).join("../size-probe");
    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/cross");
    let built = Command::new(CARGO)
        .args([
            "build",
            "--release",
            "--locked",
            "-Zbuild-std=core",
            "--target",
            TARGET,
            "--target-dir",
        ])
        .arg(&target)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTC", RUSTC)
        .env("CARGO_TARGET_MIPSEL_UNKNOWN_NONE_LINKER", LINKER)
        .env("RUSTFLAGS", "-Ctarget-cpu=mips32r2")
        .env_remove("RUSTUP_TOOLCHAIN")
        .current_dir(&probe)
        .output()
        .map_err(|error| format!("{CARGO}: {error}"))?;
    if !built.status.success() {
        return Err(format!(
            "building the probe: {}",
            String::from_utf8_lossy(&built.stderr)
        ));
    }
    let path = target.join(TARGET).join("release/size-probe");
    let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    elf::Image::read(&bytes)
        .map(Some)
        .ok_or_else(|| format!("{}: no 32-bit little-endian ELF file", path.display()))
}
