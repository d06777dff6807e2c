//! The stage that tries the bridges against the software that homes have.

use super::extent::Extent;
use super::home_assistant;
use super::runner::{Result, check};
use crate::workspace::{self, Profile, program};
use crate::{fetched, process, system};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Programs of ours that are tried, and what they stand on.
const PROGRAMS: [&str; 8] = [
    "rvac-sim",
    "vthal",
    "rvac-mqtt",
    "rvac-metrics",
    "rvac-hooks",
    "rvac-dialect",
    "panel-server",
    "try-joined",
];

/// A reader of calendars that nobody here wrote.
const ICALENDAR: &str = "icalendar==6.3.1";

/// Speaks the protocol of Foxglove's app, and decodes by the schemas that it is sent.
const FOXGLOVE: [&str; 2] = ["websockets==17.4", "protobuf==7.36.2"];

/// Draws maps for Home Assistant's cameras. It needs the Python after which this asks.
const MAP_PARSER: &str = "valetudo-map-parser==0.3.5";
const MAP_PYTHON: [u32; 2] = [3, 13];

/// Makes requests out of a description of an interface, and compares the answers with it.
const SCHEMATHESIS: &str = "schemathesis==4.32.5";

/// A DDS that is not the bridge's, and what ROS 2 itself says of its messages.
const DDS: [&str; 2] = ["cyclonedds==11.0.1", "rosbags==0.11.9"];

/// The controller of Matter stands in lists of npm, with checksums; so new must Node be for it.
const MATTER: &str = "clients/trials/peers/matter";
const MATTER_NODE: [u32; 2] = [20, 19];

/// mosquitto, Prometheus, Python, the drawing of maps where there is a Python for it, schemathesis, Cyclone DDS and a client of Foxglove's protocol; with `--long` Home Assistant and matter.js, too.
pub(super) fn joined(extent: Extent) -> Result {
    check(&mut trials(extent)?)
}

/// All of them, with what they saw as one JSON object on the output stream.
pub(super) fn as_json() -> anyhow::Result<()> {
    let seen = process::finish(
        trials(Extent::Long)?
            .arg("--json")
            .stderr(std::process::Stdio::inherit()),
    )?;
    process::print(String::from_utf8_lossy(&seen.stdout).trim());
    anyhow::ensure!(seen.status.success(), "some checks failed");
    Ok(())
}

fn trials(extent: Extent) -> anyhow::Result<Command> {
    // Debian keeps it where only root looks for programs.
    if !Path::new("/usr/sbin/mosquitto").is_file() {
        system::install(&["mosquitto"])?;
    }
    system::need("mosquitto_sub", &["mosquitto-clients"])?;
    system::need("promtool", &["prometheus"])?;
    system::need("python3", &["python3"])?;
    workspace::build(&PROGRAMS, Profile::Dev)?;
    let trials = program("try-joined", Profile::Dev);
    let calendar = workspace::target().join("joined/calendar");
    let python = fetched::python(&calendar, &[ICALENDAR], "icalendar")?.join("python");
    let mut command = if extent < Extent::Long {
        Command::new(trials)
    } else {
        let hass = home_assistant::installed()?;
        let mut command = home_assistant::alone(&trials);
        command.arg("--long").arg("--hass").arg(hass);
        command
    };
    command.arg("--python").arg(python);
    if let Some(python) = home_assistant::python_from(&MAP_PYTHON) {
        let environment = workspace::target().join("joined/map-parser");
        let parser = fetched::python_of(&python, &environment, (&[MAP_PARSER], "f2py"))?;
        command.arg("--map-python").arg(parser.join("python"));
    }
    let schemathesis = workspace::target().join("joined/schemathesis");
    let schemathesis = fetched::python(&schemathesis, &[SCHEMATHESIS], "schemathesis")?;
    command
        .arg("--schemathesis")
        .arg(schemathesis.join("schemathesis"));
    command.arg("--foxglove").arg(bridge_apart("foxglove")?);
    let client = fetched::python(
        &workspace::target().join("joined/foxglove"),
        &FOXGLOVE,
        "websockets",
    )?;
    command.arg("--foxglove-python").arg(client.join("python"));
    command.arg("--ros2").arg(bridge_apart("ros2")?);
    let dds = fetched::python(&workspace::target().join("joined/dds"), &DDS, "cyclonedds")?;
    command.arg("--ros2-python").arg(dds.join("python"));
    if extent == Extent::Long {
        name_matter(&mut command)?;
    }
    Ok(command)
}

/// What the trial of Matter needs, where this user may lay a network and Node is new enough. The stack takes minutes to build: it is
/// tried with `--long` alone.
fn name_matter(command: &mut Command) -> anyhow::Result<()> {
    system::need("node", &["nodejs"])?;
    system::need("ip", &["iproute2"])?;
    let node = node_version()?;
    if !rustix::process::geteuid().is_root() || node.as_slice() < MATTER_NODE.as_slice() {
        eprintln!("Matter is not tried: that takes root and Node {MATTER_NODE:?}, and here is {node:?}");
        return Ok(());
    }
    let packages = fetched::npm("joined/matter", MATTER)?;
    command.arg("--matter").arg(bridge_apart("matter")?);
    command.arg("--matter-packages").arg(packages);
    Ok(())
}

/// Of the Node on the search path, for example 20, 19, 2.
fn node_version() -> anyhow::Result<Vec<u32>> {
    let told = process::capture(Command::new("node").arg("--version"))?;
    let numbers = told.trim().trim_start_matches('v').split('.');
    Ok(numbers.map_while(|number| number.parse().ok()).collect())
}

/// Builds a bridge that is a workspace of its own; gives its program. Its own tests run first.
fn bridge_apart(name: &str) -> anyhow::Result<PathBuf> {
    let manifest = format!("clients/{name}/Cargo.toml");
    let target = workspace::target().join(name);
    for work in ["test", "build"] {
        let mut cargo = workspace::cargo();
        cargo
            .args([work, "--locked", "--manifest-path", &manifest, "--target-dir"])
            .arg(&target);
        process::run(&format!("cargo {work} of the bridge {name}"), &mut cargo)?;
    }
    Ok(target.join("debug").join(format!("rvac-{name}")))
}
