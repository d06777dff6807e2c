//! Which compiler makes WebAssembly here: what is installed comes first, then what Debian can add.

use crate::{process, system, workspace};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the panel is compiled for.
pub(crate) const TARGET: &str = "wasm32-unknown-unknown";

/// Debian's packages of a current compiler, its standard library as source, and a linker.
const PACKAGES: [&str; 5] = [
    "rustc-web",
    "cargo-web",
    "rust-web-src",
    "rust-web-llvm",
    "lld-19",
];

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_SOURCE: &str = "/usr/lib/rustlib/src/rust/library/std";
const DEBIAN_LINKER: &str = "wasm-ld-19";

/// A way to make WebAssembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Toolchain {
    /// The active toolchain with the target installed.
    Target,
    /// The active toolchain with the source of its standard library, which is compiled along.
    Source,
    /// Debian's compiler with the source of its standard library, which is compiled along.
    Debian,
}

/// Takes the first way that this machine offers; installs Debian's packages when it offers none.
pub(crate) fn choose() -> anyhow::Result<Toolchain> {
    let sysroot = PathBuf::from(process::capture(rustc().args(["--print", "sysroot"]))?.trim());
    if let Some(found) = active(&sysroot) {
        return Ok(found);
    }
    if !debian_is_complete() {
        process::say("this machine has no compiler for WebAssembly yet: installing Debian's");
        system::install(&PACKAGES).context(
            "the panel needs the target wasm32-unknown-unknown; with rustup: rustup target add wasm32-unknown-unknown",
        )?;
    }
    if debian_is_complete() {
        return Ok(Toolchain::Debian);
    }
    anyhow::bail!(
        "Debian's packages {} are installed but {DEBIAN_RUSTC}, {DEBIAN_SOURCE} or {DEBIAN_LINKER} is missing; \
         with rustup: rustup target add {TARGET}",
        PACKAGES.join(" ")
    )
}

fn active(sysroot: &Path) -> Option<Toolchain> {
    let rustlib = sysroot.join("lib/rustlib");
    if rustlib.join(TARGET).join("lib").is_dir() {
        return Some(Toolchain::Target);
    }
    rustlib
        .join("src/rust/library/std/Cargo.toml")
        .is_file()
        .then_some(Toolchain::Source)
}

fn debian_is_complete() -> bool {
    [DEBIAN_RUSTC, DEBIAN_CARGO, DEBIAN_SOURCE]
        .iter()
        .all(|path| Path::new(path).exists())
        && system::find(DEBIAN_LINKER).is_some()
}

fn rustc() -> Command {
    let mut command = Command::new("rustc");
    command.current_dir(workspace::root());
    command
}

impl Toolchain {
    /// For people.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Target => "the installed wasm32 target",
            Self::Source => "the installed rust-src",
            Self::Debian => "Debian's rustc-web",
        }
    }

    /// A cargo of this toolchain that stands in the root of the repository.
    pub(crate) fn cargo(self) -> Command {
        match self {
            Self::Target => workspace::cargo(),
            Self::Source => {
                let mut command = workspace::cargo();
                with_own_library(&mut command);
                command
            }
            Self::Debian => {
                let mut command = Command::new(DEBIAN_CARGO);
                command.current_dir(workspace::root());
                // cargo gives its children the toolchain it was started with; Debian's must not inherit rustup's.
                for name in [
                    "RUSTUP_TOOLCHAIN",
                    "CARGO",
                    "RUSTDOC",
                    "RUSTFLAGS",
                    "CARGO_ENCODED_RUSTFLAGS",
                ] {
                    command.env_remove(name);
                }
                command.env("RUSTC", DEBIAN_RUSTC);
                command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", DEBIAN_LINKER);
                with_own_library(&mut command);
                command
            }
        }
    }
}

fn with_own_library(command: &mut Command) {
    command.env("RUSTC_BOOTSTRAP", "1");
    command.args(["-Zbuild-std=std,panic_abort"]);
}
