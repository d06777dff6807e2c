//! Building a firmware, twice in different folders when it must be shown that the result is the same.
//!
//! Three things would let the place of the sources into the program: file names in messages and debug information, which
//! the compiler cuts off (`trim-paths`); and the identity of each crate, which cargo derives from its absolute path and
//! which decides names and order of functions. So cargo calls the compiler through this program (see [`as_compiler`]),
//! which derives the identity of crates of ours from what they are instead.

use super::RustBoard;
use crate::toolchain::Toolchain;
use crate::workspace::{self, Profile};
use crate::{process, toolchain};
use anyhow::{Context, bail};
use std::ffi::{OsStr, OsString};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Tells this program that it stands in for the compiler, and where the sources lie that the identities must not show.
const AS_COMPILER: &str = "XTASK_COMPILER_ROOT";

/// What else decides over a build.
#[derive(Clone, Debug, Default)]
pub(crate) struct Options {
    /// Features of the firmware's crate.
    pub(crate) features: Vec<String>,
}

/// Builds the firmware whose sources lie below `root`; gives the ELF file.
pub(crate) fn build(
    board: &RustBoard,
    tools: &Toolchain,
    place: &Place,
    options: &Options,
) -> anyhow::Result<PathBuf> {
    let mut cargo = tools.cargo();
    cargo
        .current_dir(&place.root)
        // Before the word `build`: a list of -Z behind it would replace the toolchain's own.
        .args([
            "-Ztrim-paths",
            "build",
            "--release",
            "--locked",
            "--manifest-path",
        ])
        .arg(place.root.join(&board.board.firmware).join("Cargo.toml"))
        .args([
            "--bin",
            &board.program,
            "--target",
            toolchain::MIPS.triple,
            "--target-dir",
        ])
        .arg(&place.target);
    let features: Vec<&str> = board
        .variant
        .iter()
        .chain(&options.features)
        .map(String::as_str)
        .collect();
    if !features.is_empty() {
        cargo.arg("--features").arg(features.join(","));
    }
    forget_wishes(&mut cargo);
    cargo
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_PROFILE_RELEASE_TRIM_PATHS", "all")
        .env("RUSTC_WRAPPER", own_program()?)
        .env(
            AS_COMPILER,
            place.root.canonicalize().context("the folder of the sources")?,
        );
    process::run(
        &format!("build {} with {}, {}", board.program, tools.name(), place.what),
        &mut cargo,
    )?;
    let elf = place
        .target
        .join(toolchain::MIPS.triple)
        .join("release")
        .join(&board.program);
    if !elf.is_file() {
        bail!("the firmware was built but {} is missing", elf.display());
    }
    Ok(elf)
}

/// Builds other programs for the chip, such as examples: the words say of which manifest and which. Their bytes may depend on
/// where they are built. Gives the folder in which cargo leaves them.
pub(crate) fn build_others(what: &str, words: &[&str]) -> anyhow::Result<PathBuf> {
    let tools = toolchain::choose(&toolchain::MIPS)?;
    let target = workspace::target().join("cross");
    let mut cargo = tools.cargo();
    forget_wishes(&mut cargo);
    cargo
        .args(["build", "--release", "--locked"])
        .args(words)
        .args(["--target", toolchain::MIPS.triple, "--target-dir"])
        .arg(&target);
    process::run(&format!("build {what} with {}", tools.name()), &mut cargo)?;
    Ok(target.join(toolchain::MIPS.triple).join("release"))
}

/// What this shell wants of other programs is not part of the firmware.
fn forget_wishes(cargo: &mut Command) {
    for (name, _) in std::env::vars_os().filter(|(name, _)| is_wish(name)) {
        cargo.env_remove(name);
    }
}

/// Whether this variable changes what the compiler makes of the same sources.
fn is_wish(name: &OsStr) -> bool {
    name.to_str()
        .is_some_and(|name| name.ends_with("RUSTFLAGS") || name.starts_with("CARGO_PROFILE_"))
}

/// A folder with sources and a folder for what is built of them.
#[derive(Debug)]
pub(crate) struct Place {
    root: PathBuf,
    target: PathBuf,
    what: &'static str,
}

impl Place {
    /// The repository itself.
    pub(crate) fn here() -> Self {
        Self {
            root: workspace::root(),
            target: workspace::target().join("cross"),
            what: "in the repository",
        }
    }

    /// A copy of all that the firmware is made of, in a folder of another name and depth.
    pub(crate) fn elsewhere() -> anyhow::Result<Self> {
        let folder = workspace::target().join("firmware/elsewhere");
        let root = folder.join("a/copy of the sources");
        if root.exists() {
            std::fs::remove_dir_all(&root).with_context(|| format!("cannot clear {}", root.display()))?;
        }
        for part in [
            "Cargo.toml",
            "rust-toolchain.toml",
            "firmware",
            "protocol",
            "robots",
        ] {
            copy(&workspace::root().join(part), &root.join(part))
                .with_context(|| format!("cannot copy {part} to {}", root.display()))?;
        }
        Ok(Self {
            root,
            target: folder.join("target"),
            what: "in a copy elsewhere",
        })
    }
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    if from.is_file() {
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder)?;
        }
        return std::fs::copy(from, to).map(|_| ());
    }
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let name = entry?.file_name();
        if name != "target" {
            copy(&from.join(&name), &to.join(&name))?;
        }
    }
    Ok(())
}

/// This program, also when it was built anew while it runs.
fn own_program() -> anyhow::Result<PathBuf> {
    let running = std::env::current_exe().context("where is this program?")?;
    let built = workspace::program("xtask", Profile::Dev);
    Ok(if running.is_file() { running } else { built })
}

/// When cargo called this program as its compiler: becomes that compiler and does not return.
pub(crate) fn as_compiler() -> anyhow::Result<()> {
    let Some(root) = std::env::var_os(AS_COMPILER) else {
        return Ok(());
    };
    let mut words = std::env::args_os().skip(1);
    let compiler = words.next().context("cargo names the compiler first")?;
    let words: Vec<OsString> = words.collect();
    let own = source(&words).is_some_and(|file| file.starts_with(&root));
    let mut command = Command::new(&compiler);
    if own {
        let name = std::env::var("CARGO_PKG_NAME").unwrap_or_default();
        let identity = identity(&name, &words);
        command.args(words.iter().map(|word| with_identity(word, &identity)));
    } else {
        command.args(&words);
    }
    let error = command.exec();
    Err(error).with_context(|| format!("cannot start {}", compiler.display()))
}

/// The crate's first file, as an absolute path.
fn source(words: &[OsString]) -> Option<PathBuf> {
    let file = words
        .iter()
        .find(|word| Path::new(word).extension() == Some(OsStr::new("rs")))?;
    Path::new(file).canonicalize().ok()
}

/// What makes the crate what it is: package, crate, kind and features.
fn identity(package: &str, words: &[OsString]) -> String {
    let mut hash = fnv1a_64(0xcbf2_9ce4_8422_2325, package.as_bytes());
    let mut wanted = false;
    for word in words.iter().map(|word| word.to_string_lossy()) {
        if wanted {
            hash = fnv1a_64(hash, word.as_bytes());
        }
        wanted = matches!(&*word, "--crate-name" | "--crate-type" | "--cfg" | "--target");
    }
    format!("{hash:016x}")
}

fn with_identity(word: &OsStr, identity: &str) -> OsString {
    match word.to_str() {
        Some(text) if text.starts_with("metadata=") => format!("metadata={identity}").into(),
        _ => word.to_owned(),
    }
}

/// Fowler-Noll-Vo 1a, 64 bits. It tells crates apart and guards against nothing.
fn fnv1a_64(start: u64, bytes: &[u8]) -> u64 {
    bytes.iter().chain(&[0]).fold(start, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::{identity, is_wish, with_identity};
    use std::ffi::{OsStr, OsString};

    fn words(text: &str) -> Vec<OsString> {
        text.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn wishes_of_the_shell_are_flags_and_profiles() {
        for name in [
            "RUSTFLAGS",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_PROFILE_RELEASE_LTO",
        ] {
            assert!(is_wish(OsStr::new(name)), "{name}");
        }
        for name in ["PATH", "CARGO_HOME", "CARGO_TARGET_DIR"] {
            assert!(!is_wish(OsStr::new(name)), "{name}");
        }
    }

    #[test]
    fn a_crates_identity_depends_on_what_it_is_and_not_on_where_it_lies() {
        let here = identity(
            "p",
            &words("--crate-name a /here/lib.rs --cfg f --out-dir /here/target"),
        );
        assert_eq!(
            here,
            identity(
                "p",
                &words("--crate-name a /there/lib.rs --cfg f --out-dir /there/target")
            )
        );
        assert_ne!(
            here,
            identity(
                "p",
                &words("--crate-name a /here/lib.rs --cfg g --out-dir /here/target")
            )
        );
        assert_ne!(
            here,
            identity(
                "q",
                &words("--crate-name a /here/lib.rs --cfg f --out-dir /here/target")
            )
        );
    }

    #[test]
    fn only_the_identity_is_replaced() {
        assert_eq!(with_identity(OsStr::new("metadata=0123"), "ab"), "metadata=ab");
        assert_eq!(
            with_identity(OsStr::new("extra-filename=-0123"), "ab"),
            "extra-filename=-0123"
        );
    }
}
