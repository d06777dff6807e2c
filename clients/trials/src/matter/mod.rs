//! matter.js lets the robot into a home, reads it, follows it and has it clean a room, over a cable between two networks.

mod controller;
mod link;

use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use serde_json::{Value, json};

use crate::Arguments;
use crate::home::Home;
use crate::process::{ask, core_share, resident_mib};
use crate::program::{Program, output, wait_for};
use crate::verdict::Verdict;
use controller::Controller;
use link::Link;

const PORT: u16 = 5540;
/// The daemon tells a change at once, and a home is told a moment later.
const SOON: Duration = Duration::from_secs(10);
/// Datagrams of a peer that speaks no Matter.
const GARBAGE: u32 = 2000;
const CLEANING: u8 = 1;
const IDLE: u8 = 0;

/// The robot's side: the daemon with its robot, and the program under trial.
struct MatterRig {
    home: Home,
    link: Link,
    program: PathBuf,
    bridge: Option<Program>,
}

impl MatterRig {
    fn state(&self) -> PathBuf {
        self.home.scratch.join("matter")
    }

    fn start_bridge(&mut self) -> anyhow::Result<()> {
        let mut command = self.link.on_robot(&self.program);
        command.arg("--vthal").arg(self.home.socket());
        command.arg("--state").arg(self.state());
        command.args(["--network", "wlan0", "--port", &PORT.to_string()]);
        let log = self.home.scratch.join("matter.log");
        std::fs::write(&log, "")?;
        let bridge = self.bridge.insert(Program::start(command, log)?);
        wait_for("rvac-matter is ready", SOON, || {
            ensure!(bridge.lives(), "{}", bridge.said());
            Ok(bridge.said().contains("ready ").then_some(()))
        })
    }

    fn bridge(&mut self) -> anyhow::Result<&mut Program> {
        self.bridge.as_mut().context("rvac-matter does not run")
    }

    /// By which a home is let in: what the program prints when it is asked for it.
    fn code(&self) -> anyhow::Result<String> {
        let told = output(
            std::process::Command::new(&self.program)
                .arg("--qr")
                .arg("--state")
                .arg(self.state()),
        )?;
        let line = told.lines().find_map(|line| line.strip_prefix("code "));
        Ok(line.context("no code")?.trim().to_owned())
    }

    fn wait_for_state(&self, wanted: &[&str]) -> anyhow::Result<()> {
        wait_for(&format!("{wanted:?}"), SOON, || {
            let status: Value = serde_json::from_str(&self.home.told("status")?)?;
            let is_so = wanted.iter().any(|state| status["state"] == *state);
            Ok(is_so.then_some(()))
        })
    }
}

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let packages = arguments
        .matter_packages
        .as_deref()
        .context("--matter-packages")?;
    verdict.version(Some(&version(packages)?));
    let mut rig = MatterRig {
        home: Home::start()?,
        link: Link::lay()?,
        program: arguments.matter.clone().context("--matter")?,
        bridge: None,
    };
    rig.start_bridge()?;
    let keys = rig.home.scratch.join("keys");
    let mut peer = Controller::start(&rig.link, packages, &keys)?;
    let code = rig.code()?;
    verdict.check("a wrong code lets nobody in", wrong_code((&rig, packages), &code));
    verdict.check("garbage moves nothing", garbage(&mut rig, &mut peer));
    let begun = Instant::now();
    peer.order("commission", &json!({"code": code}))?;
    verdict.figure("commissioned_s", begun.elapsed().as_secs_f64());
    let seen = peer.order("read", &Value::Null)?;
    verdict.check("it is a vacuum cleaner with a battery", about(&mut peer));
    verdict.check("state, battery and modes are the daemon's", read(&rig, &seen));
    verdict.check("the rooms of the map are its areas", areas(&rig, &seen));
    verdict.check(
        "a room is chosen, and one that is not there is refused",
        chosen(&mut peer),
    );
    let work = cleaned(&mut rig, &mut peer, verdict);
    verdict.check("exactly that room is cleaned; pause, resume and home", work);
    verdict.check(
        "how hard it cleans is chosen, not in the middle of a job",
        suction(&mut rig, &mut peer),
    );
    verdict.check(
        "what it cannot start it refuses by its name",
        refused(&rig, &mut peer),
    );
    let known = restarted(&mut rig, &mut peer, verdict);
    verdict.check("it is known again after a restart", known);
    verdict.check(
        "a daemon that was killed is an error, and comes back",
        killed(&mut rig, &mut peer),
    );
    Ok(())
}

fn version(packages: &Path) -> anyhow::Result<String> {
    let manifest = std::fs::read_to_string(packages.join("node_modules/@matter/main/package.json"))?;
    let manifest: Value = serde_json::from_str(&manifest)?;
    Ok(manifest["version"].as_str().context("no version")?.to_owned())
}

/// By a home of its own, which is gone afterwards. It tries again and again; with the right code the next one is in after two seconds.
fn wrong_code((rig, packages): (&MatterRig, &Path), code: &str) -> anyhow::Result<()> {
    let mut stranger = Controller::start(&rig.link, packages, &rig.home.scratch.join("stranger"))?;
    let wrong = json!({"code": code, "passcode": 20_202_020, "wait_ms": 8_000});
    ensure!(stranger.order("commission", &wrong).is_err(), "it was let in");
    Ok(())
}

fn garbage(rig: &mut MatterRig, peer: &mut Controller) -> anyhow::Result<()> {
    let before = rig.home.told("status")?;
    let memory = resident_mib(rig.bridge()?.id(), "VmRSS")?;
    peer.order(
        "garbage",
        &json!({"port": PORT, "count": GARBAGE, "host": "::ffff:10.77.0.1"}),
    )?;
    sleep(Duration::from_secs(1));
    let bridge = rig.bridge()?;
    ensure!(bridge.lives(), "it has ended: {}", bridge.said());
    let grown = resident_mib(bridge.id(), "VmRSS")? - memory;
    ensure!(grown < 4.0, "it has grown by {grown} MiB");
    let state = |text: &str| serde_json::from_str::<Value>(text).map(|status| status["state"].clone());
    ensure!(
        state(&before)? == state(&rig.home.told("status")?)?,
        "the robot has moved"
    );
    Ok(())
}

fn about(peer: &mut Controller) -> anyhow::Result<()> {
    let about = peer.order("about", &Value::Null)?;
    let has = |kind: u32| {
        about["types"]
            .as_array()
            .is_some_and(|types| types.contains(&json!(kind)))
    };
    ensure!(has(0x74) && has(0x11), "{about}");
    ensure!(
        about["vendorId"] == 0xfff1 && about["productName"] == "Robot vacuum",
        "{about}"
    );
    Ok(())
}

fn read(rig: &MatterRig, seen: &Value) -> anyhow::Result<()> {
    let device: Value = serde_json::from_str(&rig.home.told("device")?)?;
    let charge = device["battery"]["charge"].as_f64().context("no charge")?;
    let half_percent = seen["power"]["batPercentRemaining"]
        .as_f64()
        .context("no share")?;
    ensure!(
        (half_percent / 200.0 - charge).abs() < 0.03,
        "{half_percent} is not {charge}"
    );
    ensure!(
        seen["power"]["batPresent"] == true && seen["power"]["status"] == 1,
        "{}",
        seen["power"]
    );
    let operation = &seen["operation"];
    // Stopped, charging or docked: where the simulator puts it.
    let state = operation["operationalState"].as_u64().context("no state")?;
    ensure!([0x00, 0x41, 0x42].contains(&state), "{operation}");
    ensure!(operation["operationalError"]["errorStateId"] == 0, "{operation}");
    ensure!(seen["run"]["currentMode"] == IDLE, "{}", seen["run"]);
    let modes = seen["clean"]["supportedModes"].as_array().context("no modes")?;
    ensure!(modes.len() == 4, "{modes:?}");
    Ok(())
}

fn areas(rig: &MatterRig, seen: &Value) -> anyhow::Result<()> {
    let home: Value = serde_json::from_str(&rig.home.told("home")?)?;
    let rooms = home["rooms"].as_array().context("no rooms")?;
    let ids: Vec<&Value> = rooms.iter().map(|room| &room["id"]).collect();
    let areas = seen["areas"]["supportedAreas"].as_array().context("no areas")?;
    let told: Vec<&Value> = areas.iter().map(|area| &area["areaId"]).collect();
    ensure!(ids == told && ids.len() == 2, "{ids:?} are {told:?}");
    let named = |area: &Value| {
        area["areaInfo"]["locationInfo"]["locationName"]
            .as_str()
            .is_some_and(|name| !name.is_empty())
    };
    ensure!(areas.iter().all(named), "{areas:?}");
    // No job of ours can leave out a part of itself: SkipArea, 2, is none of the commands.
    ensure!(
        seen["areas"]["acceptedCommandList"] == json!([0]),
        "{}",
        seen["areas"]
    );
    Ok(())
}

fn chosen(peer: &mut Controller) -> anyhow::Result<()> {
    let unknown = peer.order("select", &json!({"areas": [1, 4711]}))?;
    ensure!(unknown["status"] == 1 && unknown["statusText"] != "", "{unknown}");
    let chosen = peer.order("select", &json!({"areas": [2]}))?;
    ensure!(chosen["status"] == 0, "{chosen}");
    let seen = peer.order("read", &Value::Null)?;
    ensure!(seen["areas"]["selectedAreas"] == json!([2]), "{}", seen["areas"]);
    Ok(())
}

/// Done, by the answer of the robot and by what it does.
fn does(peer: &mut Controller, (order, state): (&str, u64)) -> anyhow::Result<()> {
    let answer = peer.order(order, &Value::Null)?;
    ensure!(
        answer["commandResponseState"]["errorStateId"] == 0,
        "{order}: {answer}"
    );
    let seen = peer.order("read", &Value::Null)?;
    ensure!(
        seen["operation"]["operationalState"] == state,
        "{order}: {}",
        seen["operation"]
    );
    Ok(())
}

fn start(peer: &mut Controller) -> anyhow::Result<()> {
    let begun = peer.order("run", &json!({"mode": CLEANING}))?;
    ensure!(begun["status"] == 0, "{begun}");
    Ok(())
}

fn cleaned(rig: &mut MatterRig, peer: &mut Controller, verdict: &mut Verdict) -> anyhow::Result<()> {
    let idle = peer.order("pause", &Value::Null)?;
    ensure!(
        idle["commandResponseState"]["errorStateId"] == 3,
        "paused without a job: {idle}"
    );
    start(peer)?;
    rig.wait_for_state(&["cleaning"])?;
    let busy = peer.order("select", &json!({"areas": [1]}))?;
    ensure!(busy["status"] == 2, "chosen in the middle of a job: {busy}");
    let id = rig.bridge()?.id();
    let share = core_share(id, || {
        sleep(Duration::from_secs(5));
        Ok(())
    })?;
    verdict.figure("cleaning_core_share", share);
    verdict.figure("resident_mib", resident_mib(id, "VmRSS")?);
    does(peer, ("pause", 2))?;
    rig.wait_for_state(&["paused"])?;
    does(peer, ("resume", 1))?;
    rig.wait_for_state(&["cleaning"])?;
    let home = peer.order("home", &Value::Null)?;
    ensure!(home["commandResponseState"]["errorStateId"] == 0, "{home}");
    rig.wait_for_state(&["docking", "docked"])?;
    rig.home.order(r#"{"c":"stop"}"#)?;
    let rooms = wait_for("the run is kept", SOON, || run_of_matter(rig))?;
    ensure!(rooms.len() == 1 && rooms[0]["id"] == 2, "{rooms:?}");
    followed(peer)
}

/// The rooms that the newest run by Matter was for, as the daemon keeps it.
fn run_of_matter(rig: &MatterRig) -> anyhow::Result<Option<Vec<Value>>> {
    let runs: Value = serde_json::from_str(&ask(&rig.home.socket(), r#"{"c":"runs"}"#, SOON)?)?;
    let by_matter = |run: &&Value| run["by"]["client"] == "rvac-matter" && run["job"]["clean"].is_object();
    let run = runs["runs"]
        .as_array()
        .and_then(|runs| runs.iter().find(by_matter));
    Ok(run.map(|run| {
        run["job"]["clean"]["rooms"]
            .as_array()
            .cloned()
            .unwrap_or_default()
    }))
}

/// What a home heard without asking: each state in its turn, and that the job has ended without an error.
fn followed(peer: &mut Controller) -> anyhow::Result<()> {
    let (mut states, mut ends) = (Vec::new(), Vec::new());
    wait_for("states and the end are told", SOON, || {
        let told = peer.order("told", &Value::Null)?;
        let list = |name: &str| told[name].as_array().cloned().unwrap_or_default();
        let of_state = |change: &Value| {
            let is_state = change["attribute"] == "operationalState";
            change["value"].as_u64().filter(|_| is_state)
        };
        states.extend(list("changes").iter().filter_map(of_state));
        let events = list("events");
        ends.extend(
            events
                .into_iter()
                .filter(|event| event["name"] == "operationCompletion"),
        );
        let mut left = states.iter();
        let follows = [1, 2, 1].iter().all(|wanted| left.any(|state| state == wanted));
        ensure!(follows, "{states:?}");
        let ended = ends.iter().any(|event| event["data"]["completionErrorCode"] == 0);
        ensure!(ended, "{ends:?}");
        Ok(Some(()))
    })
}

fn suction(rig: &mut MatterRig, peer: &mut Controller) -> anyhow::Result<()> {
    let quiet = peer.order("clean", &json!({"mode": 1}))?;
    ensure!(quiet["status"] == 0, "{quiet}");
    let unknown = peer.order("clean", &json!({"mode": 77}));
    ensure!(
        unknown.map_or(true, |answer| answer["status"] == 1),
        "a mode that there is not"
    );
    start(peer)?;
    rig.wait_for_state(&["cleaning"])?;
    let busy = peer.order("clean", &json!({"mode": 3}))?;
    ensure!(busy["status"] == 0x40 && busy["statusText"] != "", "{busy}");
    let ended = peer.order("run", &json!({"mode": IDLE}))?;
    ensure!(ended["status"] == 0, "{ended}");
    rig.wait_for_state(&["idle", "docked"])
}

fn refused(rig: &MatterRig, peer: &mut Controller) -> anyhow::Result<()> {
    rig.home.hand(r#"{"c":"lift"}"#)?;
    let refusal = wait_for("the robot feels that it hangs", SOON, || {
        let status = rig.home.told("status")?;
        Ok(status.contains("wheel-drop").then_some(()))
    })
    .and_then(|()| peer.order("run", &json!({"mode": CLEANING})));
    rig.home.hand(r#"{"c":"put-down"}"#)?;
    let refusal = refusal?;
    // Stuck, and what to do.
    ensure!(refusal["status"] == 0x41, "{refusal}");
    let text = refusal["statusText"].as_str().unwrap_or_default();
    ensure!(text.contains("flat on the floor"), "{refusal}");
    Ok(())
}

fn restarted(rig: &mut MatterRig, peer: &mut Controller, verdict: &mut Verdict) -> anyhow::Result<()> {
    rig.bridge = None;
    rig.start_bridge()?;
    let said = rig.bridge()?.said();
    ensure!(!said.contains("join a home"), "it has forgotten its home: {said}");
    let begun = Instant::now();
    let seen = wait_for("it answers its home", Duration::from_secs(40), || {
        peer.order("read", &Value::Null).map(Some)
    })?;
    verdict.figure("known_again_s", begun.elapsed().as_secs_f64());
    ensure!(seen["areas"]["selectedAreas"] == json!([2]), "{}", seen["areas"]);
    ensure!(seen["clean"]["currentMode"] == 1, "{}", seen["clean"]);
    Ok(())
}

/// Whether the robot is in trouble, by what it tells its home.
fn shows_error(peer: &mut Controller, is_wanted: bool) -> anyhow::Result<()> {
    wait_for("the state is told", SOON, || {
        let seen = peer.order("read", &Value::Null)?;
        let operation = &seen["operation"];
        let is_error = operation["operationalState"] == 3;
        ensure!(
            is_error == (operation["operationalError"]["errorStateId"] != 0),
            "{operation}"
        );
        Ok((is_error == is_wanted).then_some(()))
    })
}

fn killed(rig: &mut MatterRig, peer: &mut Controller) -> anyhow::Result<()> {
    rig.home.kill_daemon();
    let shown = shows_error(peer, true);
    let without = peer.order("run", &json!({"mode": CLEANING}));
    rig.home.start_daemon()?;
    shown?;
    let without = without?;
    ensure!(without["status"] != 0, "started without a daemon: {without}");
    shows_error(peer, false)
}
