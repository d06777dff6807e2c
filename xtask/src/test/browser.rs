//! The stage that drives the panel in a browser, and what it fetches for that.

use super::extent::Extent;
use super::runner::{Result, cargo, tests};
use crate::panel::{self, Page};
use crate::workspace::{self, Profile};
use crate::{fetched, firmware, system};
use std::path::PathBuf;

/// Other engines, their driver, and a screen with a pointer for them, with Debian's packages.
const ENGINES: [(&str, &str); 4] = [
    ("firefox-esr", "firefox-esr"),
    ("WebKitWebDriver", "webkit2gtk-driver"),
    ("Xvfb", "xvfb"),
    ("xdotool", "xdotool"),
];

/// The tests take turns in one process: those that measure a time have the machine for themselves.
pub(super) fn browser(extent: Extent) -> Result {
    system::need("chromium", &["chromium"])?;
    system::need("chromedriver", &["chromium-driver"])?;
    let assets = panel::build(Page::Release)?;
    let elf = firmware::usual_elf()?;
    workspace::build(&["rvac-sim", "vthal", "panel-server", "rvac"], Profile::Dev)?;
    let screenshots = workspace::target().join("screenshots");
    std::fs::create_dir_all(&screenshots).map_err(anyhow::Error::from)?;
    let axe = axe()?;
    let mut command = cargo(&["test", "--locked", "--test", "browser", "--", "--nocapture"]);
    // Most of a test is waiting for a robot that keeps the pace of the clock on the wall.
    command.args(["--test-threads", "3"]);
    command
        .env("RVAC_AXE", axe)
        .env("RVAC_BROWSER_TESTS", "1")
        .env("RVAC_LOSSES", extent.pick("1", "1", "100"))
        .env("RVAC_GESTURES", extent.pick("50", "50", "1000"))
        .env("RVAC_WATCH_MINUTES", extent.pick("0.2", "0.2", "60"))
        .env("RVAC_PANEL", assets)
        .env("RVAC_FIRMWARE", elf)
        .env("RVAC_SCREENSHOTS", screenshots);
    if extent == Extent::Long {
        for (program, package) in ENGINES {
            system::need(program, &[package])?;
        }
        command.env("RVAC_ENGINES", "1");
    }
    tests(&mut command)
}

/// Fetches axe-core, which looks for faults of accessibility; the lock file beside its manifest names version and checksum.
fn axe() -> anyhow::Result<PathBuf> {
    let folder = fetched::npm("axe", "clients/panel-server/tests/axe")?;
    let script = folder.join("node_modules/axe-core/axe.min.js");
    if !script.is_file() {
        anyhow::bail!("npm has fetched axe-core but {} is missing", script.display());
    }
    Ok(script)
}
