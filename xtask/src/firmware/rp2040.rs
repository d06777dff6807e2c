//! Firmware for an RP2040: builds it, tells its size, and lets it say hello in an emulator.

use super::elf::Elf;
use crate::chip::Chip;
use crate::{fetched, process, system, toolchain, workspace};
use anyhow::{Context, bail};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The chip's name in robots/chips, and in the manifest of a firmware that is for it.
const CHIP: &str = "rp2040";
/// The emulator of the chip, which comes from npm, and the program that drives it.
const EMULATOR: &str = "firmware/rp2040-reference/emulator";
/// How long the emulated chip runs, and what it is asked in the middle of that.
const RUN_MS: u32 = 1_000;
const QUESTION: &str = r#"{"c":"info"}"#;

/// A firmware for this chip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Port {
    /// The name of the package, its program and the robot.
    pub(crate) name: String,
    folder: PathBuf,
}

#[derive(Debug, Serialize)]
struct PortReport {
    flash_bytes: u64,
    ram_bytes: u64,
    said_hello: bool,
    answered_info: bool,
}

/// All firmware for this chip, by what their manifests say: none is listed here.
pub(crate) fn ports() -> anyhow::Result<Vec<Port>> {
    let firmware = workspace::root().join("firmware");
    let mut ports = Vec::new();
    for entry in
        std::fs::read_dir(&firmware).with_context(|| format!("cannot read {}", firmware.display()))?
    {
        let folder = entry?.path();
        let Ok(text) = std::fs::read_to_string(folder.join("Cargo.toml")) else {
            continue;
        };
        let manifest: toml::Table = text
            .parse()
            .with_context(|| format!("{}/Cargo.toml", folder.display()))?;
        ports.extend(port(&manifest, folder));
    }
    ports.sort_by(|one, other| one.name.cmp(&other.name));
    Ok(ports)
}

fn port(manifest: &toml::Table, folder: PathBuf) -> Option<Port> {
    let package = manifest.get("package")?;
    let chip = package.get("metadata")?.get("librervac")?.get("chip")?;
    (chip.as_str() == Some(CHIP)).then_some(())?;
    Some(Port {
        name: package.get("name")?.as_str()?.to_owned(),
        folder,
    })
}

/// Builds a firmware, tells its size, and lets it run.
pub(super) fn run(port: &Port, json: bool) -> anyhow::Result<()> {
    let file = build(port)?;
    let elf = Elf::read(&std::fs::read(&file)?)?;
    let said = run_emulated(port, &file)?;
    let chip = Chip::load(&workspace::root().join("robots"), CHIP)?;
    let (flash, ram) = (chip.region("flash")?, chip.region("ram")?);
    let report = PortReport {
        flash_bytes: elf
            .segments
            .iter()
            .map(|segment| segment.bytes.len() as u64)
            .sum(),
        ram_bytes: elf
            .sections
            .iter()
            .filter(|section| ram.addresses().contains(&section.address))
            .map(|section| u64::from(section.size))
            .sum(),
        said_hello: says(&said, r#"{"c":"hello""#, &port.name),
        answered_info: says(&said, r#"{"c":"info""#, "cordlib-version"),
    };
    if json {
        process::print(&serde_json::to_string(&report)?);
    } else {
        process::print(&format!(
            "flash {} of {} bytes, memory {} of {} bytes without the stack",
            report.flash_bytes, flash.bytes, report.ram_bytes, ram.bytes
        ));
        said.lines().for_each(process::print);
        process::say(&file.display().to_string());
    }
    if report.flash_bytes > u64::from(flash.budget_bytes())
        || report.ram_bytes > u64::from(ram.budget_bytes())
    {
        bail!("{} does not fit into the chip", port.name);
    }
    if !(report.said_hello && report.answered_info) {
        bail!(
            "{} says no hello or gives no info in the emulated chip",
            port.name
        );
    }
    Ok(())
}

/// Whether a line begins like this and holds that.
fn says(said: &str, beginning: &str, part: &str) -> bool {
    said.lines()
        .any(|line| line.starts_with(beginning) && line.contains(part))
}

fn build(port: &Port) -> anyhow::Result<PathBuf> {
    let toolchain = toolchain::choose(&toolchain::THUMB)?;
    let out = workspace::target().join("rp2040");
    let mut cargo = toolchain.cargo();
    cargo
        .args(["build", "--locked", "--release", "--manifest-path"])
        .arg(port.folder.join("Cargo.toml"))
        .args(["--target", toolchain::THUMB.triple, "--target-dir"])
        .arg(&out);
    process::run(
        &format!("build {} with {}", port.name, toolchain.name()),
        &mut cargo,
    )?;
    Ok(out.join(toolchain::THUMB.triple).join("release").join(&port.name))
}

/// Everything that it says on its link, a packet a line.
fn run_emulated(port: &Port, file: &Path) -> anyhow::Result<String> {
    system::need("node", &["nodejs"])?;
    // Every port uses the emulator of the reference.
    let folder = fetched::npm("rp2040js", EMULATOR)?;
    let script = workspace::root().join(EMULATOR).join("run.mjs");
    std::fs::copy(script, folder.join("run.mjs"))?;
    process::say(&format!(
        "let {} run for {RUN_MS} ms in the emulated chip",
        port.name
    ));
    let mut node = Command::new("node");
    node.current_dir(&folder)
        .arg("run.mjs")
        .arg(file)
        .args([&RUN_MS.to_string(), QUESTION]);
    process::capture(&mut node)
}

#[cfg(test)]
mod tests {
    use super::{Port, ports};

    #[test]
    fn the_reference_is_found_by_its_manifest() {
        let names: Vec<String> = ports()
            .expect("manifests")
            .into_iter()
            .map(|Port { name, .. }| name)
            .collect();
        assert!(names.contains(&"rp2040-reference".to_owned()), "{names:?}");
        assert!(!names.contains(&"sr8730".to_owned()), "{names:?}");
    }
}
