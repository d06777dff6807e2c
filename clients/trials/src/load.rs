//! What the bridge takes while telemetry comes at 50 Hz: processor, memory, and bytes to the broker.

use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};

use crate::Arguments;
use crate::broker::Door;
use crate::mosquitto::{Rig, is_state};
use crate::process::{ran_s, resident_mib};
use crate::verdict::Verdict;

/// A board of a robot has little of both. These are for a development build, which is larger than what a package holds.
const RESIDENT_MIB_MAX: f64 = 16.0;
const SHARE_MAX: f64 = 0.05;

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let time = Duration::from_secs(if arguments.long { 60 } else { 10 });
    verdict.version(Some(env!("CARGO_PKG_VERSION")));
    let rig = Rig::start(Door::Open, "5")?;
    let listener = rig.broker.listen(&["librervac/#", "homeassistant/#"])?;
    listener.wait_for("a state", Duration::from_secs(20), is_state(""))?;
    sleep(Duration::from_secs(2));
    for (name, bytes_name, command) in [
        ("rest_core_share", "rest_bytes_per_minute", None),
        ("cleaning_core_share", "cleaning_bytes_per_minute", Some("start")),
    ] {
        if let Some(command) = command {
            rig.command(command)?;
            listener.wait_for("cleaning", Duration::from_secs(10), is_state("cleaning"))?;
        }
        listener.all_within(Duration::from_millis(200));
        let process = rig.bridge.as_ref().context("no bridge")?.id();
        let before = ran_s(process)?;
        let begun = Instant::now();
        let heard = listener.all_within(time);
        let took_s = begun.elapsed().as_secs_f64();
        let share = (ran_s(process)? - before) / took_s;
        let bytes: usize = heard
            .iter()
            .map(|heard| heard.payload.len() + heard.topic.len())
            .sum();
        let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
        verdict.figure(name, share);
        verdict.figure(bytes_name, f64::from(bytes) * 60.0 / took_s);
        verdict.check(&format!("{name} is below {SHARE_MAX}"), within(share, SHARE_MAX));
    }
    let process = rig.bridge.as_ref().context("no bridge")?.id();
    verdict.figure("resident_mib", resident_mib(process, "VmRSS")?);
    let most = resident_mib(process, "VmHWM")?;
    verdict.figure("resident_max_mib", most);
    verdict.check("its memory is small", within(most, RESIDENT_MIB_MAX));
    Ok(())
}

fn within(value: f64, most: f64) -> anyhow::Result<()> {
    ensure!(value < most, "{value:.3} is not below {most}");
    Ok(())
}
