//! The services as systemd judges them: whether it understands them, and how much of the system they expose.

use crate::{process, system};
use anyhow::{Context, bail};
use serde::Serialize;
use std::path::Path;
use std::process::Command;

/// systemd's measure goes from 0 to 10; what it calls fine ends here.
const EXPOSURE_MAX: f64 = 2.5;
/// The services.
const UNITS: [&str; 8] = [
    "vthal.service",
    "rvac-panel.service",
    "rvac-settle.service",
    "rvac-update.service",
    "rvac-mqtt.service",
    "rvac-metrics.service",
    "rvac-hooks.service",
    "rvac-dialect.service",
];

/// Keys that systemd learnt in version 254; an older one says that it does not know them, and restarts at an even pace.
const NEW_KEYS: [&str; 2] = ["'RestartSteps'", "'RestartMaxDelaySec'"];

/// What starts one of them when a file is there.
const WATCHER: &str = "rvac-update.path";

/// A service and how much it exposes.
#[derive(Debug, Serialize)]
pub(crate) struct Exposure {
    unit: &'static str,
    exposure: f64,
}

/// Checks the services of a package that is laid out below `root`.
pub(super) fn check(root: &Path) -> anyhow::Result<Vec<Exposure>> {
    system::need("systemd-analyze", &["systemd"])?;
    let judged = root.with_extension("judged");
    lay(root, &judged)?;
    let mut verify = Command::new("systemd-analyze");
    verify.arg("--root").arg(&judged).args(["--man=no", "verify"]);
    let units = || UNITS.into_iter().chain([WATCHER]);
    verify.args(units().map(|unit| format!("/lib/systemd/system/{unit}")));
    let output = process::finish(&mut verify)?;
    let complaints: Vec<String> = String::from_utf8_lossy(&output.stderr)
        .lines()
        .filter(|line| units().any(|unit| line.contains(unit)))
        .filter(|line| !(line.contains("Unknown key") && NEW_KEYS.iter().any(|key| line.contains(key))))
        .map(str::to_owned)
        .collect();
    if !output.status.success() || !complaints.is_empty() {
        bail!("systemd does not like our services: {}", complaints.join("; "));
    }
    UNITS.into_iter().map(|unit| exposure(root, unit)).collect()
}

/// The package beside the units of this machine's systemd, to which ours refer.
fn lay(root: &Path, judged: &Path) -> anyhow::Result<()> {
    if judged.exists() {
        std::fs::remove_dir_all(judged)?;
    }
    process::capture(Command::new("cp").arg("--archive").arg(root).arg(judged))?;
    let units = judged.join("lib/systemd/system");
    for entry in std::fs::read_dir("/lib/systemd/system").context("this machine's systemd has no units")? {
        let path = entry?.path();
        let place = units.join(path.file_name().unwrap_or_default());
        if path.is_file() && !place.exists() {
            std::fs::copy(&path, place)?;
        }
    }
    Ok(())
}

fn exposure(root: &Path, unit: &'static str) -> anyhow::Result<Exposure> {
    let mut security = Command::new("systemd-analyze");
    security
        .args(["security", "--offline=true", "--no-pager"])
        .arg(root.join("lib/systemd/system").join(unit));
    let text = process::capture(&mut security)?;
    let exposure = text
        .rsplit_once("Overall exposure level for")
        .and_then(|(_, rest)| rest.split_once(": ")?.1.split_whitespace().next())
        .and_then(|number| number.parse().ok())
        .with_context(|| format!("systemd-analyze does not judge {unit}"))?;
    if exposure > EXPOSURE_MAX {
        bail!("{unit} exposes {exposure}, more than {EXPOSURE_MAX}");
    }
    Ok(Exposure { unit, exposure })
}
