//! The panel compiled beside other work: its link takes minutes on one core, while the other core would stand idle.

use super::compilation;
use crate::{process, workspace};
use anyhow::Context;
use std::fs::File;
use std::process::{Child, Stdio};

/// A compilation of the panel that runs by itself. Stopped when dropped; what it has compiled stays.
pub(crate) struct Ahead {
    child: Child,
}

impl Ahead {
    /// Starts it; what the compiler says goes to a file.
    pub(crate) fn begin() -> anyhow::Result<Self> {
        let log = workspace::target().join("panel-ahead.log");
        std::fs::create_dir_all(workspace::target())?;
        let file = File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
        let (toolchain, mut cargo) = compilation()?;
        cargo.stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file);
        process::say(&format!(
            "build the panel with {toolchain} meanwhile ({})",
            log.display()
        ));
        let child = cargo
            .spawn()
            .with_context(|| format!("cannot start {}", process::name(&cargo)))?;
        Ok(Self { child })
    }

    /// Waits until it has ended. Whether it succeeded shows when the panel is built: that says again what was wrong.
    pub(crate) fn finish(mut self) -> anyhow::Result<()> {
        process::say("wait for the panel that is built meanwhile");
        self.child
            .wait()
            .context("cannot wait for the build of the panel")?;
        Ok(())
    }
}

impl Drop for Ahead {
    fn drop(&mut self) {
        // It may have ended by itself, and then there is nothing to stop.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}
