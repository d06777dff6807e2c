//! Where things lie: the root of the repository, the target folder, the programs that were built.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The optimisation a program is built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Profile {
    /// The development profile: what tests and the demo use.
    Dev,
    /// The release profile: what is measured.
    Release,
}

impl Profile {
    fn folder(self) -> &'static str {
        match self {
            Self::Dev => "debug",
            Self::Release => "release",
        }
    }
}

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_path_buf()
}

/// The folder of everything that is built.
pub(crate) fn target() -> PathBuf {
    match std::env::var_os("CARGO_TARGET_DIR") {
        Some(folder) => root().join(folder),
        None => root().join("target"),
    }
}

/// The cargo that runs this command, standing in the root of the repository.
pub(crate) fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// The path of a program of the workspace.
pub(crate) fn program(name: &str, profile: Profile) -> PathBuf {
    target().join(profile.folder()).join(name)
}

/// A small test to build beside programs: without any test cargo leaves development dependencies out, chooses other features for
/// what all share, and most of the workspace would be built once for programs and once for tests.
const BESIDE_TESTS: [&str; 2] = ["--test", "noisy_line"];

/// Builds programs by their names. No package is named: with one cargo would choose other features for what all share, and
/// build it a second time; and the other programs of a package are not waited for.
pub(crate) fn build(programs: &[&str], profile: Profile) -> anyhow::Result<()> {
    let mut command = cargo();
    command.arg("build").arg("--locked");
    for program in programs {
        command.args(["--bin", program]);
    }
    match profile {
        Profile::Dev => command.args(BESIDE_TESTS),
        Profile::Release => command.arg("--release"),
    };
    crate::process::run(&format!("build {}", programs.join(", ")), &mut command)
}
