//! mosquitto as broker: what is said, what is heard, and every break of the connection.

use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::Arguments;
use crate::broker::{Broker, Door, Heard, Listener};
use crate::home::Home;
use crate::notifications;
use crate::process::{beside, resident_mib};
use crate::program::{Program, server, version_in};
use crate::verdict::Verdict;

/// Within this time everything is back after a break.
pub(crate) const BACK: Duration = Duration::from_secs(10);
/// Within this time a command shows.
const SOON: Duration = Duration::from_secs(10);

/// A robot, a broker, and the bridge between them.
pub(crate) struct Rig {
    pub(crate) home: Home,
    pub(crate) broker: Broker,
    pub(crate) bridge: Option<Program>,
}

impl Rig {
    pub(crate) fn start(door: Door, version: &str) -> anyhow::Result<Self> {
        let home = Home::start()?;
        let broker = Broker::start(home.scratch.join("").as_path(), door)?;
        let configuration = format!(
            "{}version = {version:?}\nvthal = {:?}\nid = \"robo\"\nname = \"Robo\"\ncommands = true\nmap_every_s = 1\ndialect_prefix = \"kaart\"\n",
            broker.for_bridge(),
            home.socket().display().to_string(),
        );
        std::fs::write(home.scratch.join("rvac-mqtt.toml"), configuration)?;
        let mut rig = Self {
            home,
            broker,
            bridge: None,
        };
        rig.start_bridge()?;
        Ok(rig)
    }

    pub(crate) fn start_bridge(&mut self) -> anyhow::Result<()> {
        let mut command = Command::new(beside("rvac-mqtt")?);
        command
            .arg("--config")
            .arg(self.home.scratch.join("rvac-mqtt.toml"));
        self.bridge = Some(Program::start(command, self.home.scratch.join("bridge.log"))?);
        Ok(())
    }

    pub(crate) fn command(&self, word: &str) -> anyhow::Result<()> {
        self.broker.publish("librervac/robo/command", word, &[])
    }
}

/// All of it.
pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let version = version_in(Command::new(server("mosquitto")).arg("-h"))?;
    verdict.version(version.as_deref());
    let mut rig = Rig::start(Door::Open, "5")?;
    sayings(&rig, verdict)?;
    dialect(&rig, arguments, verdict)?;
    commands(&rig, verdict)?;
    hostile(&mut rig, verdict)?;
    let breaks = if arguments.long { 20 } else { 2 };
    broken(&mut rig, breaks, verdict)?;
    drop(rig);
    let guarded = Rig::start(Door::Guarded, "3.1.1")?;
    let listener = guarded.broker.listen(&["librervac/#"])?;
    let state = listener.wait_for("a state", SOON, is_state(""));
    verdict.check(
        "3.1.1 over TLS with a client's certificate, user and password",
        state.map(drop),
    );
    Ok(())
}

/// The state of a vacuum with this word.
pub(crate) fn is_state(word: &str) -> impl Fn(&Heard) -> bool {
    let part = format!("\"state\":\"{word}");
    move |heard: &Heard| heard.topic.ends_with("/robo/state") && heard.text().contains(&part)
}

fn sayings(rig: &Rig, verdict: &mut Verdict) -> anyhow::Result<()> {
    // What the broker keeps is said to who comes later; so somebody comes later.
    let early = rig.broker.listen(&["librervac/#", "homeassistant/#"])?;
    early.wait_for("a picture", Duration::from_secs(20), |heard| {
        heard.topic.ends_with("/map")
    })?;
    sleep(Duration::from_secs(1));
    let late = rig.broker.listen(&["librervac/#", "homeassistant/#"])?;
    let kept = late.all_within(Duration::from_secs(2));
    let find = |end: &str| find(&kept, end);
    verdict.check(
        "the device's description is kept and whole",
        find("device/robo/config").and_then(|heard| {
            at_least_once(heard)?;
            let message: Value = serde_json::from_slice(&heard.payload)?;
            let components = message["components"].as_object().context("no components")?;
            ensure!(components.len() >= 20, "only {} entities", components.len());
            let vacuum = &components["vacuum"];
            ensure!(
                vacuum["fan_speed_list"]
                    .as_array()
                    .is_some_and(|list| list.len() == 4),
                "{vacuum}"
            );
            Ok(())
        }),
    );
    verdict.check(
        "the state is kept with quality 1 and names all rooms",
        find("/robo/state").and_then(|heard| {
            at_least_once(heard)?;
            let state: Value = serde_json::from_slice(&heard.payload)?;
            ensure!(
                state["segments"]
                    .as_object()
                    .is_some_and(|rooms| rooms.len() >= 2),
                "{state}"
            );
            Ok(())
        }),
    );
    verdict.check(
        "readings are kept",
        find("/readings").and_then(|heard| {
            at_least_once(heard)?;
            let readings: Value = serde_json::from_slice(&heard.payload)?;
            ensure!(
                readings["battery"].as_f64().is_some_and(|charge| charge > 0.0),
                "{readings}"
            );
            ensure!(readings["trouble"] == "none", "{readings}");
            Ok(())
        }),
    );
    picture_and_presence(&kept, verdict);
    Ok(())
}

fn find<'a>(kept: &'a [Heard], end: &str) -> anyhow::Result<&'a Heard> {
    let heard = kept.iter().find(|heard| heard.topic.ends_with(end));
    heard.with_context(|| format!("no {end}"))
}

/// Kept by the broker, and delivered at least once.
fn at_least_once(heard: &Heard) -> anyhow::Result<()> {
    ensure!(
        heard.retained && heard.quality == 1,
        "{} is not kept with quality 1",
        heard.topic
    );
    Ok(())
}

fn picture_and_presence(kept: &[Heard], verdict: &mut Verdict) {
    let find = |end: &str| find(kept, end);
    verdict.check(
        "the map is a picture with quality 0",
        find("/map").and_then(|heard| {
            ensure!(
                heard.quality == 0 && heard.payload.starts_with(b"\x89PNG"),
                "{} bytes",
                heard.payload.len()
            );
            Ok(())
        }),
    );
    verdict.check(
        "the robot is there",
        find("/availability").and_then(|heard| {
            ensure!(heard.text() == "online", "{}", heard.text());
            at_least_once(heard)
        }),
    );
}

fn order(rig: &Rig, listener: &Listener, (word, state): (&str, &str), verdict: &mut Verdict) {
    let result = rig
        .command(word)
        .and_then(|()| listener.wait_for(state, SOON, is_state(state)));
    verdict.check(&format!("{word} leads to {state}"), result.map(drop));
}

fn commands(rig: &Rig, verdict: &mut Verdict) -> anyhow::Result<()> {
    let listener = rig.broker.listen(&["librervac/#"])?;
    for step in [("start", "cleaning"), ("pause", "paused"), ("start", "cleaning")] {
        order(rig, &listener, step, verdict);
    }
    listener.wait_for("off the dock", SOON, |heard| {
        let text = heard.text();
        text.contains("\"activity\":\"cleaning\"") && text.contains("\"docked\":false")
    })?;
    for step in [("return_to_base", "returning"), ("stop", "idle")] {
        order(rig, &listener, step, verdict);
    }
    let ended = listener.wait_for("the end of the run", SOON, |heard| {
        heard.topic.ends_with("event/run")
    });
    verdict.check(
        "the end of a run is an event that nobody keeps",
        ended.and_then(|heard| {
            ensure!(
                !heard.retained && heard.text().contains("\"event_type\":\""),
                "{}",
                heard.text()
            );
            Ok(())
        }),
    );
    parts_of_the_home(rig, &listener, verdict)
}

fn parts_of_the_home(rig: &Rig, listener: &Listener, verdict: &mut Verdict) -> anyhow::Result<()> {
    let clean = rig.broker.publish("librervac/robo/rooms/clean", r#"["1"]"#, &[]);
    let cleans = clean.and_then(|()| listener.wait_for("cleaning", SOON, is_state("cleaning")));
    verdict.check("a room is cleaned", cleans.map(drop));
    let zone = r#"{"command":"clean","parts":[{"zone":[[-1.0,-0.4],[-0.4,-0.4],[-0.4,0.2]]}],"passes":2}"#;
    rig.command("stop")?;
    listener.wait_for("idle", SOON, is_state("idle"))?;
    let clean = rig.broker.publish("librervac/robo/request", zone, &[]);
    let cleans = clean.and_then(|()| listener.wait_for("cleaning", SOON, is_state("cleaning")));
    verdict.check("a zone is cleaned", cleans.map(drop));
    rig.command("stop")?;
    listener.wait_for("idle", SOON, is_state("idle"))?;
    let refused = rig.broker.publish("librervac/robo/rooms/clean", "[4711]", &[]);
    let refused = refused.and_then(|()| {
        listener.wait_for("the refusal", SOON, |heard| {
            heard.topic.ends_with("event/refused")
        })
    });
    verdict.check(
        "a room that does not exist is refused by name",
        refused.and_then(|heard| {
            ensure!(heard.text().contains("no-such-room"), "{}", heard.text());
            Ok(())
        }),
    );
    Ok(())
}

/// The map as clients of Valetudo read it, and their commands.
fn dialect(rig: &Rig, arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let listener = rig.broker.listen(&["kaart/robo/#"])?;
    let picture = listener.wait_for("a map for cards", SOON, |heard| {
        heard.topic.ends_with("map-data-hass")
    });
    let python = arguments.python.clone().unwrap_or_else(|| "python3".into());
    verdict.check(
        "the picture for map cards holds a map as they read it",
        picture.and_then(|heard| {
            let file = rig.home.scratch.join("card.png");
            std::fs::write(&file, &heard.payload)?;
            let map = notifications::read(&python, "card", &file)?;
            ensure!(map["layers"].to_string().contains("segment"), "{map}");
            ensure!(map["entities"].to_string().contains("robot_position"), "{map}");
            Ok(())
        }),
    );
    let is = |end: &'static str, text: &'static str| {
        move |heard: &Heard| heard.topic.ends_with(end) && heard.text() == text
    };
    rig.broker
        .publish("kaart/robo/BasicControlCapability/operation/set", "START", &[])?;
    let cleans = listener.wait_for("cleaning", SOON, is("StatusStateAttribute/status", "cleaning"));
    verdict.check("their START leads to cleaning", cleans.map(drop));
    rig.broker
        .publish("kaart/robo/BasicControlCapability/operation/set", "STOP", &[])?;
    let stands = listener.wait_for("idle", SOON, |heard: &Heard| {
        heard.topic.ends_with("StatusStateAttribute/status")
            && ["idle", "docked"].contains(&heard.text().as_str())
    });
    verdict.check("their STOP leads to rest", stands.map(drop));
    Ok(())
}

fn hostile(rig: &mut Rig, verdict: &mut Verdict) -> anyhow::Result<()> {
    let listener = rig
        .broker
        .listen(&["librervac/robo/state", "librervac/robo/event/refused"])?;
    listener.all_within(Duration::from_millis(500));
    let still = |listener: &Listener, what: &str| -> anyhow::Result<()> {
        let moved = listener.all_within(Duration::from_secs(2));
        let moved = moved.iter().find(|heard| is_state("cleaning")(heard));
        ensure!(moved.is_none(), "{what} moved it: {moved:?}");
        Ok(())
    };
    rig.broker.publish("librervac/robo/command", "start", &["-r"])?;
    // The bridge hears it as a fresh command while it is connected, and as a kept one when it comes back.
    listener.wait_for("cleaning", SOON, is_state("cleaning"))?;
    rig.command("stop")?;
    listener.wait_for("idle", SOON, is_state("idle"))?;
    rig.bridge = None;
    rig.start_bridge()?;
    listener.wait_for("idle", BACK, is_state("idle")).ok(); // The state is as it was, so it may be kept and not said anew.
    verdict.check(
        "a kept command is none when the bridge comes back",
        still(&listener, "a kept command"),
    );
    rig.broker.publish("librervac/robo/command", "", &["-r"])?;
    for wrong in [
        "START",
        "{\"c\":\"start\"}",
        "null",
        "\u{1f}{\"c\":\"start\"}\u{1f}",
    ] {
        rig.command(wrong)?;
    }
    rig.broker.publish(
        "librervac/robo/request",
        r#"{"c":"drive","v":0.3,"w":0,"ttl":400}"#,
        &[],
    )?;
    let long_topic = format!("librervac/robo/{}", "x".repeat(60_000));
    rig.broker.publish(&long_topic, "start", &[])?;
    verdict.check("what is no command moves nothing", still(&listener, "no command"));
    let bridge = rig.bridge.as_mut().context("no bridge")?;
    let before = resident_mib(bridge.id(), "VmRSS")?;
    rig.broker
        .flood("librervac/robo/rooms/clean", "no list", 50_000)?;
    let large = "y".repeat(3_000);
    rig.broker.flood("librervac/robo/command", &large, 2_000)?;
    sleep(Duration::from_secs(1));
    let grown = resident_mib(bridge.id(), "VmRSS")? - before;
    verdict.figure("flood_grown_mib", grown);
    verdict.check(
        "a flood of 52,000 messages moves nothing and lets nothing grow",
        still(&listener, "a flood").and_then(|()| {
            ensure!(bridge.lives(), "the bridge has ended: {}", bridge.said());
            ensure!(grown < 2.0, "it has grown by {grown:.1} MiB");
            Ok(())
        }),
    );
    Ok(())
}

fn broken(rig: &mut Rig, times: u32, verdict: &mut Verdict) -> anyhow::Result<()> {
    let mut slowest = Duration::ZERO;
    for _ in 0..times {
        rig.broker.kill();
        sleep(Duration::from_millis(700));
        rig.broker.start_again()?;
        let begun = Instant::now();
        let listener = rig.broker.listen(&["librervac/#"])?;
        let back = listener.wait_for("the state", BACK, is_state(""));
        verdict.check("all is said again after the broker was killed", back.map(drop));
        slowest = slowest.max(begun.elapsed());
    }
    verdict.figure("back_after_broker_s", slowest.as_secs_f64());
    let listener = rig.broker.listen(&["librervac/robo/availability"])?;
    let is = |word: &'static str| move |heard: &Heard| heard.text() == word;
    rig.home.kill_daemon();
    let gone = listener.wait_for("offline", SOON, is("offline"));
    verdict.check("a robot without its daemon is not there", gone.map(drop));
    rig.home.start_daemon()?;
    let begun = Instant::now();
    let back = listener.wait_for("online", BACK, is("online"));
    verdict.check("it is back when the daemon is", back.map(drop));
    verdict.figure("back_after_daemon_s", begun.elapsed().as_secs_f64());
    rig.bridge = None;
    let gone = listener.wait_for("offline", SOON, is("offline"));
    verdict.check("the broker says when the bridge is gone", gone.map(drop));
    rig.start_bridge()?;
    let back = listener.wait_for("online", BACK, is("online"));
    verdict.check("it is back when the bridge is", back.map(drop));
    Ok(())
}
