//! The panel compiled beside other work: its link takes minutes on one core, while the other core would stand idle.

use super::{Page, compilation};
use crate::{process, workspace};
use anyhow::Context;
use std::fs::File;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// How often somebody who waits is told how far it is.
const NEWS: Duration = Duration::from_secs(15);
/// How soon its end is noticed.
const LOOK: Duration = Duration::from_millis(200);

/// A compilation of the panel that runs by itself. Stopped when dropped; what it has compiled stays.
pub(crate) struct Ahead {
    child: Child,
    log: PathBuf,
}

impl Ahead {
    /// Starts it; what the compiler says goes to a file.
    pub(crate) fn begin(page: Page) -> anyhow::Result<Self> {
        let log = workspace::target().join("panel-ahead.log");
        std::fs::create_dir_all(workspace::target())?;
        let file = File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
        let (toolchain, mut cargo) = compilation(page)?;
        cargo.stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file);
        process::say(&format!(
            "build the panel with {toolchain} meanwhile ({})",
            log.display()
        ));
        let child = cargo
            .spawn()
            .with_context(|| format!("cannot start {}", process::name(&cargo)))?;
        Ok(Self { child, log })
    }

    /// Waits until it has ended, and tells how far it is. Whether it succeeded shows when the panel is built: that says again what was
    /// wrong.
    pub(crate) fn finish(mut self) -> anyhow::Result<()> {
        let mut told = Instant::now();
        while !self.has_ended()? {
            if told.elapsed() >= NEWS {
                told = Instant::now();
                process::say(&format!("wait for the panel: {}", self.last_word()));
            }
            std::thread::sleep(LOOK);
        }
        Ok(())
    }

    fn has_ended(&mut self) -> anyhow::Result<bool> {
        let status = self.child.try_wait();
        Ok(status
            .context("cannot wait for the build of the panel")?
            .is_some())
    }

    /// What the compiler works on.
    fn last_word(&self) -> String {
        let said = std::fs::read_to_string(&self.log).unwrap_or_default();
        said.lines().next_back().unwrap_or("begins").trim().to_owned()
    }
}

impl Drop for Ahead {
    fn drop(&mut self) {
        // It may have ended by itself, and then there is nothing to stop.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}
