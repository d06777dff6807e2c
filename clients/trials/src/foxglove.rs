//! A client of Foxglove's protocol looks as its app does: it follows all that is offered, and decodes it by the schemas that came along.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::Arguments;
use crate::home::Home;
use crate::process::{Server, core_share, resident_mib};
use crate::program::{output, python_package, wait_for};
use crate::verdict::Verdict;

/// What the app is given to begin with.
const LAYOUT: &str = "../../packaging/foxglove/layout.json";
/// What is said again every two seconds is said within it.
const LOOK_S: &str = "5";

const SCHEMAS: [(&str, &str); 8] = [
    ("/pose", "foxglove.PoseInFrame"),
    ("/tf", "foxglove.FrameTransform"),
    ("/robot", "foxglove.SceneUpdate"),
    ("/map", "foxglove.Grid"),
    ("/plan", "foxglove.SceneUpdate"),
    ("/log", "foxglove.Log"),
    ("/status", "vthal.Status"),
    ("/device", "vthal.Device"),
];

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let python = arguments
        .foxglove_python
        .as_deref()
        .context("--foxglove-python")?;
    verdict.version(Some(&python_package(python, "websockets")?));
    let home = Home::start()?;
    let mut command = Command::new(arguments.foxglove.as_ref().context("--foxglove")?);
    command.arg("--vthal").arg(home.socket()).args(["--port", "0"]);
    let server = Server::start(command)?;
    let address = format!("ws://127.0.0.1:{}", server.port()?);
    let look = || look(python, &address);
    home.order(r#"{"c":"start"}"#)?;
    wait_for("cleaning", Duration::from_secs(30), || {
        let status = home.told("status")?;
        Ok(status.contains(r#""state":"cleaning""#).then_some(()))
    })?;
    let first = look()?;
    verdict.check(
        "each topic comes in the form that its schema says",
        offered(&first),
    );
    verdict.check("the map is whole", map(&first));
    let mut second = Value::Null;
    let share = core_share(server.id(), || {
        second = look()?;
        Ok(())
    })?;
    verdict.figure("cleaning_core_share", share);
    verdict.figure("resident_mib", resident_mib(server.id(), "VmRSS")?);
    verdict.check("the robot moves through the map", moved(&first, &second));
    verdict.check("the layout shows what there is", layout(&second));
    home.order(r#"{"c":"stop"}"#)
}

fn look(python: &Path, address: &str) -> anyhow::Result<Value> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/foxglove.py");
    let told = output(Command::new(python).arg(script).args([address, LOOK_S]))?;
    Ok(serde_json::from_str(told.trim())?)
}

fn offered(seen: &Value) -> anyhow::Result<()> {
    for (topic, schema) in SCHEMAS {
        let told = &seen[topic];
        ensure!(told["schema"] == schema, "{topic}: {told}");
        // A quiet log is no fault.
        let is_heard = told["count"].as_u64().is_some_and(|count| count > 0);
        ensure!(is_heard || topic == "/log", "nothing on {topic}");
    }
    let status = &seen["/status"]["last"];
    ensure!(status["state"] == "cleaning", "{status}");
    Ok(())
}

fn map(seen: &Value) -> anyhow::Result<()> {
    let grid = &seen["/map"]["last"];
    let columns = grid["column_count"].as_u64().context("no columns")?;
    ensure!(grid["frame_id"] == "map" && columns > 20, "{grid}");
    ensure!(grid["row_stride"].as_u64() == Some(4 * columns), "{grid}");
    // In base 64 it is four thirds as long.
    let length = grid["data"]["length"].as_u64().context("no data")?;
    ensure!(length / 4 * 3 >= 4 * columns * 20, "{grid}");
    Ok(())
}

fn moved(first: &Value, second: &Value) -> anyhow::Result<()> {
    let place = |seen: &Value| {
        let pose = &seen["/pose"]["last"];
        let position = &pose["pose"]["position"];
        // Zeros are left out by its way of writing.
        let axis = |name: &str| position[name].as_f64().unwrap_or_default();
        (pose["frame_id"] == "map").then(|| [axis("x"), axis("y")])
    };
    let (before, after) = (
        place(first).context("no pose")?,
        place(second).context("no pose")?,
    );
    let way_m = (after[0] - before[0]).hypot(after[1] - before[1]);
    ensure!(way_m > 0.02, "{before:?} to {after:?}");
    Ok(())
}

/// Each topic and each field that the layout names is one of those seen.
fn layout(seen: &Value) -> anyhow::Result<()> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(LAYOUT))?;
    let layout: Value = serde_json::from_str(&text)?;
    let panels = layout["configById"].as_object().context("no panels")?;
    let mut wanted = Vec::new();
    for panel in panels.values() {
        let topics = panel["topics"].as_object();
        wanted.extend(topics.into_iter().flat_map(|topics| topics.keys().cloned()));
        let paths = panel["paths"].as_array();
        let values = paths
            .into_iter()
            .flatten()
            .filter_map(|path| path["value"].as_str());
        wanted.extend(values.map(str::to_owned));
    }
    ensure!(wanted.len() >= 10, "the layout shows nearly nothing: {wanted:?}");
    for path in wanted {
        let mut parts = path.split('.');
        let topic = parts.next().unwrap_or_default();
        let mut value = &seen[topic]["last"];
        for part in parts {
            value = &value[part];
        }
        ensure!(!value.is_null(), "{path} is not there");
    }
    Ok(())
}
