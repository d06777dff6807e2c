//! Which compiler makes code for other machines here: what is installed comes first, then what Debian can add.

use crate::{process, system, workspace};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Something that the host's own compiler does not build for.
#[derive(Debug)]
pub(crate) struct Target {
    /// Its name in the words of the compiler.
    pub(crate) triple: &'static str,
    /// What it is, for people.
    what: &'static str,
    /// What cargo is told so that it compiles the standard library along when that is not installed.
    library: &'static [&'static str],
    /// The linker in Debian's packages.
    linker: &'static str,
    /// Variable by which cargo is told that linker.
    linker_variable: &'static str,
    /// What the compiler is told besides.
    flags: Option<Flags>,
    /// What a person with rustup can do.
    remedy: &'static str,
}

/// Flags of a compiler.
#[derive(Debug)]
struct Flags {
    /// The variable by which it is told.
    variable: &'static str,
    /// What each is told.
    always: &'static str,
    /// What one that knows it is told besides when it compiles the standard library along.
    with_library: &'static str,
}

/// The panel's browser.
pub(crate) const WEB: Target = Target {
    triple: "wasm32-unknown-unknown",
    what: "WebAssembly",
    library: &[
        "-Zbuild-std=std,panic_abort",
        "-Zbuild-std-features=optimize_for_size",
    ],
    linker: "wasm-ld-19",
    linker_variable: "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER",
    // Views of one type share their code: a first visit brings 665 kB in place of 768. Nobody reads the words of a panic in a browser,
    // and it ends the program either way: without them 30 kB less, and with the library's smaller code 16 more.
    flags: Some(Flags {
        variable: "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS",
        always: "--cfg erase_components -Clink-arg=--emit-relocs",
        with_library: "-Zunstable-options -Cpanic=immediate-abort",
    }),
    remedy: "rustup target add wasm32-unknown-unknown",
};

/// The robot's microcontroller. No toolchain brings a library for it.
pub(crate) const MIPS: Target = Target {
    triple: "mipsel-unknown-none",
    what: "MIPS microcontrollers",
    library: &["-Zbuild-std=core"],
    linker: "ld.lld-19",
    linker_variable: "CARGO_TARGET_MIPSEL_UNKNOWN_NONE_LINKER",
    flags: None,
    remedy: "rustup component add rust-src",
};

/// Small ARM microcontrollers: Cortex-M0 and M0+.
pub(crate) const THUMB: Target = Target {
    triple: "thumbv6m-none-eabi",
    what: "Cortex-M0 microcontrollers",
    library: &["-Zbuild-std=core"],
    linker: "ld.lld-19",
    linker_variable: "CARGO_TARGET_THUMBV6M_NONE_EABI_LINKER",
    flags: None,
    remedy: "rustup target add thumbv6m-none-eabi",
};

/// Debian's packages of a current compiler, its standard library as source, and a linker.
const PACKAGES: [&str; 5] = [
    "rustc-web",
    "cargo-web",
    "rust-web-src",
    "rust-web-llvm",
    "lld-19",
];

/// Where Debian keeps them. Its main archive alone has an older compiler and not all of the packages.
const SOURCE: &str = "on Debian 12 the packages are in its security archive: \
                      deb http://deb.debian.org/debian-security bookworm-security main";

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_LIBRARY: &str = "/usr/lib/rustlib/src/rust/library";

/// A way to make code for a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// The active toolchain with the target installed.
    Installed,
    /// The active toolchain with the source of its standard library, which is compiled along.
    Source,
    /// Debian's compiler with the source of its standard library, which is compiled along.
    Debian,
}

/// A compiler for a target.
#[derive(Clone, Debug)]
pub(crate) struct Toolchain {
    target: &'static Target,
    way: Way,
}

/// Takes the first way that this machine offers; installs Debian's packages when it offers none.
pub(crate) fn choose(target: &'static Target) -> anyhow::Result<Toolchain> {
    let way = match active(target, &sysroot()?) {
        Some(way) => way,
        None => {
            need_debian(target.what, Some(target.linker), target.remedy)?;
            Way::Debian
        }
    };
    Ok(Toolchain { target, way })
}

/// A cargo of a compiler that has the source of its standard library, without a target: the caller names it, what of the library is
/// compiled along, and brings the linker.
pub(crate) fn source_cargo() -> anyhow::Result<Command> {
    let mut command = if has_source(&sysroot()?) {
        workspace::cargo()
    } else {
        need_debian("boards' processors", None, "rustup component add rust-src")?;
        debian_cargo()
    };
    command.env("RUSTC_BOOTSTRAP", "1");
    Ok(command)
}

fn sysroot() -> anyhow::Result<PathBuf> {
    let path = process::capture(rustc().args(["--print", "sysroot"]))?;
    Ok(PathBuf::from(path.trim()))
}

fn active(target: &Target, sysroot: &Path) -> Option<Way> {
    let installed = sysroot.join("lib/rustlib").join(target.triple).join("lib");
    if installed.is_dir() {
        Some(Way::Installed)
    } else {
        has_source(sysroot).then_some(Way::Source)
    }
}

/// Whether the active toolchain has the source of its standard library.
fn has_source(sysroot: &Path) -> bool {
    sysroot
        .join("lib/rustlib/src/rust/library/std/Cargo.toml")
        .is_file()
}

/// Makes sure that Debian's compiler is there, with a linker if the caller brings none.
fn need_debian(what: &str, linker: Option<&str>, remedy: &str) -> anyhow::Result<()> {
    if debian_is_complete(linker) {
        return Ok(());
    }
    process::say(&format!(
        "this machine has no compiler for {what} yet: installing Debian's"
    ));
    system::install(&PACKAGES)
        .with_context(|| format!("a compiler for {what} is needed; with rustup: {remedy}; {SOURCE}"))?;
    anyhow::ensure!(
        debian_is_complete(linker),
        "Debian's packages {} are installed but {DEBIAN_RUSTC}, {DEBIAN_LIBRARY} or {} is missing; with rustup: {remedy}",
        PACKAGES.join(" "),
        linker.unwrap_or(DEBIAN_CARGO)
    );
    Ok(())
}

fn debian_is_complete(linker: Option<&str>) -> bool {
    [DEBIAN_RUSTC, DEBIAN_CARGO, DEBIAN_LIBRARY]
        .iter()
        .all(|path| Path::new(path).exists())
        && linker.is_none_or(|linker| system::find(linker).is_some())
}

fn rustc() -> Command {
    let mut command = Command::new("rustc");
    command.current_dir(workspace::root());
    command
}

fn debian_cargo() -> Command {
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
    command
}

impl Toolchain {
    /// For people.
    pub(crate) fn name(&self) -> String {
        match self.way {
            Way::Installed => format!("the installed {} target", self.target.triple),
            Way::Source => "the installed rust-src".to_owned(),
            Way::Debian => "Debian's rustc-web".to_owned(),
        }
    }

    /// A cargo of this toolchain that stands in the root of the repository.
    pub(crate) fn cargo(&self) -> Command {
        let mut command = match self.way {
            Way::Installed | Way::Source => workspace::cargo(),
            Way::Debian => {
                let mut command = debian_cargo();
                command.env(self.target.linker_variable, self.target.linker);
                command
            }
        };
        if self.way != Way::Installed {
            command.env("RUSTC_BOOTSTRAP", "1");
            command.args(self.target.library);
        }
        if let Some(flags) = &self.target.flags {
            let told = if self.way != Way::Installed && self.knows(flags.with_library) {
                format!("{} {}", flags.always, flags.with_library)
            } else {
                flags.always.to_owned()
            };
            command.env(flags.variable, told);
        }
        command
    }

    /// Whether the compiler, which may be older than these flags are, takes them.
    fn knows(&self, flags: &str) -> bool {
        let mut command = match self.way {
            Way::Installed | Way::Source => rustc(),
            Way::Debian => Command::new(DEBIAN_RUSTC),
        };
        command
            .env("RUSTC_BOOTSTRAP", "1")
            .args(flags.split(' '))
            .args(["--print", "cfg"]);
        process::finish(&mut command).is_ok_and(|output| output.status.success())
    }
}
