//! Manual control by single requests.

use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use serde_json::json;

use super::rig::DialectRig;

pub(super) fn drive(rig: &DialectRig) -> anyhow::Result<()> {
    let stray = json!({"action": "move", "vector": {"velocity": 1, "angle": 0}});
    let told = rig.put("HighResolutionManualControlCapability", &stray)?;
    ensure!(told["code"] == 409, "nobody has switched it on: {told}");
    sleep(Duration::from_millis(1_200));
    let place = || -> anyhow::Result<[f64; 2]> {
        let map = rig.read("robot/state/map")?;
        let entities = map["entities"].as_array().context("no entities")?;
        let robot = entities
            .iter()
            .find(|one| one["type"] == "robot_position")
            .context("no robot")?;
        let part = |axis: usize| robot["points"][axis].as_f64().context("no place");
        Ok([part(0)?, part(1)?])
    };
    let before = place()?;
    let told = rig.told(&["drive", "-0.5", "0", "1.5"])?;
    ensure!(
        told["codes"]
            .as_array()
            .is_some_and(|codes| codes.len() > 5 && codes.iter().all(|code| code == 200)),
        "{told}"
    );
    let begun = Instant::now();
    rig.wait_for_state(&["idle", "docked"])?;
    ensure!(
        begun.elapsed() < Duration::from_secs(3),
        "it drives on for {:?}",
        begun.elapsed()
    );
    sleep(Duration::from_millis(2_500));
    let after = place()?;
    let way_cm = (after[0] - before[0]).hypot(after[1] - before[1]);
    ensure!(way_cm > 5.0 && way_cm < 80.0, "{before:?} to {after:?}");
    Ok(())
}
