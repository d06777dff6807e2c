//! A disk under the daemon's state folder that fails at one of its changes: a library that is preloaded into the daemon.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use vthal_bench::Scratch;

const SOURCE: &str = include_str!("failing_disk.c");

/// How a disk fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DiskFault {
    /// One change fails with an error of input and output.
    ErrorOnce,
    /// From one change on the disk is full.
    Full,
    /// From one change on the disk is only for reading, as cards end.
    ReadOnly,
    /// One change is half written, and from then on everything fails.
    Torn,
}

impl DiskFault {
    pub(crate) const ALL: [Self; 4] = [Self::ErrorOnce, Self::Full, Self::ReadOnly, Self::Torn];

    /// For people and figures.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ErrorOnce => "error-once",
            Self::Full => "full",
            Self::ReadOnly => "read-only",
            Self::Torn => "torn",
        }
    }

    /// The system's error (Linux: errno.h), and the word for the library.
    const fn order(self) -> (i32, &'static str) {
        const EIO: i32 = 5;
        const ENOSPC: i32 = 28;
        const EROFS: i32 = 30;
        match self {
            Self::ErrorOnce => (EIO, "once"),
            Self::Full => (ENOSPC, "on"),
            Self::ReadOnly => (EROFS, "on"),
            Self::Torn => (EIO, "torn"),
        }
    }
}

/// The library, built for this machine.
pub(crate) struct FailingDisk {
    scratch: Scratch,
    library: PathBuf,
}

impl FailingDisk {
    /// Builds it with the C compiler that Rust links with.
    pub(crate) fn build() -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let (source, library) = (scratch.join("failing_disk.c"), scratch.join("failing_disk.so"));
        fs::write(&source, SOURCE)?;
        let built = Command::new("cc")
            .args(["-shared", "-fPIC", "-O1", "-Wall", "-Werror", "-o"])
            .args([&library, &source])
            .status()
            .context("no C compiler")?;
        ensure!(built.success(), "the failing disk cannot be built: {built}");
        Ok(Self { scratch, library })
    }

    /// What becomes `program` with a disk below `folder` whose change with this number fails.
    pub(crate) fn under(
        &self,
        program: &Path,
        folder: &Path,
        (manner, at): (DiskFault, u32),
    ) -> anyhow::Result<Command> {
        let report = self.scratch.join("report");
        if report.exists() {
            fs::remove_file(&report)?;
        }
        let (error, word) = manner.order();
        let mut command = Command::new(program);
        command.env("LD_PRELOAD", &self.library).env(
            "FAILING_DISK",
            format!("{}:{}:{at}:{error}:{word}", folder.display(), report.display()),
        );
        Ok(command)
    }

    /// The change that has failed first, and its path; `None` if none has yet.
    pub(crate) fn failed(&self) -> Option<String> {
        fs::read_to_string(self.scratch.join("report"))
            .ok()
            .map(|told| told.trim_end().to_owned())
    }
}
