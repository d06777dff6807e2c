//! A real Home Assistant: set up by its own REST interface, found by discovery, and every break of the connection.

use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use serde_json::{Value, json};

use crate::Arguments;
use crate::broker::Door;
use crate::http::Site;
use crate::mosquitto::{BACK, Rig};
use crate::program::{Program, free_port, output, wait_for};
use crate::verdict::Verdict;

/// Home Assistant takes its time to start.
const START: Duration = Duration::from_secs(90);
/// Within this time a command shows.
const SOON: Duration = Duration::from_secs(15);
/// The gyro rests on the dock before the robot drives off.
const OFF_THE_DOCK: Duration = Duration::from_secs(40);
const CLIENT: &str = "http://127.0.0.1/";

struct Hub {
    rig: Rig,
    program: Option<Program>,
    hass: std::path::PathBuf,
    server: Site,
}

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let hass = arguments
        .hass
        .clone()
        .context("--hass names the program of Home Assistant")?;
    let version = output(Command::new(&hass).arg("--version"))?;
    verdict.version(Some(version.trim()));
    let rig = Rig::start(Door::Open, "5")?;
    let folder = rig.home.scratch.join("hass");
    std::fs::create_dir_all(&folder)?;
    let port = free_port()?;
    let configuration = format!(
        "homeassistant:\n  name: Home\n  latitude: 0\n  longitude: 0\n  unit_system: metric\n  time_zone: UTC\n\
         http:\n  server_host: 127.0.0.1\n  server_port: {port}\nfrontend:\nconfig:\n"
    );
    std::fs::write(folder.join("configuration.yaml"), configuration)?;
    let mut hub = Hub {
        rig,
        program: None,
        hass,
        server: Site { port, token: None },
    };
    hub.start()?;
    verdict.check("it is set up, and the broker joined to it", hub.set_up());
    shown(&hub, verdict);
    ordered(&hub, verdict)?;
    broken(&mut hub, if arguments.long { 20 } else { 2 }, verdict)?;
    Ok(())
}

impl Hub {
    fn start(&mut self) -> anyhow::Result<()> {
        let mut command = Command::new(&self.hass);
        command
            .arg("-c")
            .arg(self.rig.home.scratch.join("hass"))
            .arg("--skip-pip");
        let log = self.rig.home.scratch.join("hass.log");
        self.program = Some(Program::start(command, log)?);
        wait_for("Home Assistant answers", START, || {
            let answer = self.server.get("/manifest.json")?;
            Ok((answer.code == 200).then_some(()))
        })
    }

    fn set_up(&mut self) -> anyhow::Result<()> {
        let user = json!({
            "client_id": CLIENT, "name": "Owner", "username": "owner", "password": "of a home", "language": "en",
        });
        let code = wait_for("the first user", START, || {
            Ok(Some(self.server.post_json("/api/onboarding/users", &user)?))
        })?;
        let code = code["auth_code"].as_str().context("no code")?.to_owned();
        let form = format!("grant_type=authorization_code&code={code}&client_id={CLIENT}");
        let token = self.server.post_form("/auth/token", &form)?;
        self.server.token = Some(token["access_token"].as_str().context("no token")?.to_owned());
        let flow = json!({"handler": "mqtt", "show_advanced_options": false});
        let flow = self.server.post_json("/api/config/config_entries/flow", &flow)?;
        let id = flow["flow_id"].as_str().context("no flow")?;
        let broker = json!({"broker": "127.0.0.1", "port": self.rig.broker.port});
        let done = self
            .server
            .post_json(&format!("/api/config/config_entries/flow/{id}"), &broker)?;
        ensure!(done["type"] == "create_entry", "{done}");
        Ok(())
    }

    /// The state of an entity.
    fn state(&self, entity: &str) -> anyhow::Result<Value> {
        self.server.get_json(&format!("/api/states/{entity}"))
    }

    fn wait(&self, entity: &str, state: &str, patience: Duration) -> anyhow::Result<Value> {
        let mut seen = String::new();
        wait_for(&format!("{entity} is {state}"), patience, || {
            let now = self.state(entity)?;
            now["state"].as_str().unwrap_or_default().clone_into(&mut seen);
            Ok((seen == state).then_some(now))
        })
        .with_context(|| format!("it was {seen:?}"))
    }

    /// Who pauses it before is told that it is docked.
    fn off_the_dock(&self) -> anyhow::Result<()> {
        wait_for("off the dock", OFF_THE_DOCK, || {
            let vacuum = self.state("vacuum.robo")?;
            Ok((vacuum["attributes"]["docked"] == false).then_some(()))
        })
    }

    fn call(&self, service: &str, data: &Value) -> anyhow::Result<()> {
        self.server
            .post_json(&format!("/api/services/{service}"), data)
            .map(drop)
    }

    /// Names of all entities of the robot, and which of them are not available.
    fn entities(&self) -> anyhow::Result<(usize, Vec<String>)> {
        let all = self.server.get_json("/api/states")?;
        let ours = |state: &&Value| {
            let id = state["entity_id"].as_str().unwrap_or_default();
            id.split_once('.')
                .is_some_and(|(_, name)| name.starts_with("robo"))
        };
        let all: Vec<&Value> = all.as_array().into_iter().flatten().filter(ours).collect();
        let gone = all.iter().filter(|state| state["state"] == "unavailable");
        let gone = gone.map(|state| state["entity_id"].to_string()).collect();
        Ok((all.len(), gone))
    }

    fn all_there(&self, patience: Duration) -> anyhow::Result<usize> {
        let mut missing = Vec::new();
        wait_for("all entities are available", patience, || {
            let (count, gone) = self.entities()?;
            missing = gone;
            Ok((count > 0 && missing.is_empty()).then_some(count))
        })
        .with_context(|| missing.join(", "))
    }
}

fn shown(hub: &Hub, verdict: &mut Verdict) {
    let docked_or_idle = wait_for("the vacuum is found", Duration::from_secs(30), || {
        let vacuum = hub.state("vacuum.robo")?;
        Ok((vacuum["state"] != "unknown").then_some(vacuum))
    });
    verdict.check(
        "the vacuum is found by discovery",
        docked_or_idle.and_then(|vacuum| {
            let speeds = &vacuum["attributes"]["fan_speed_list"];
            ensure!(speeds.as_array().is_some_and(|list| list.len() == 4), "{vacuum}");
            Ok(())
        }),
    );
    let count = hub.all_there(Duration::from_secs(20));
    if let Ok(count) = &count {
        verdict.figure("entities", f64::from(u32::try_from(*count).unwrap_or(0)));
    }
    verdict.check(
        "every entity is available",
        count.and_then(|count| {
            ensure!(count >= 20, "only {count}");
            Ok(())
        }),
    );
    let battery = hub.state("sensor.robo_battery");
    verdict.check(
        "the battery is shown in percent",
        battery.and_then(|battery| {
            let charge: f64 = battery["state"].as_str().unwrap_or_default().parse()?;
            ensure!(
                charge > 0.0 && battery["attributes"]["unit_of_measurement"] == "%",
                "{battery}"
            );
            Ok(())
        }),
    );
    let error = hub.wait("sensor.robo_error", "none", SOON);
    verdict.check("no error is shown", error.map(drop));
    let picture = hub.state("camera.robo_map").and_then(|camera| {
        let path = camera["attributes"]["entity_picture"]
            .as_str()
            .context("no picture")?;
        let picture = hub.server.get(path)?;
        ensure!(
            picture.body.starts_with(b"\x89PNG"),
            "{} {}",
            picture.code,
            picture.text()
        );
        Ok(())
    });
    verdict.check("the map is shown", picture);
    let log = hub.program.as_ref().map(Program::said).unwrap_or_default();
    let complaint = log
        .lines()
        .find(|line| line.contains("ERROR") && line.contains("mqtt"));
    verdict.check(
        "it complains of nothing that was said",
        match complaint {
            None => Ok(()),
            Some(line) => Err(anyhow::anyhow!("{line}")),
        },
    );
}

fn ordered(hub: &Hub, verdict: &mut Verdict) -> anyhow::Result<()> {
    let robo = json!({"entity_id": "vacuum.robo"});
    let mut order = |service: &str, data: &Value, state: &str| {
        let done = hub
            .call(service, data)
            .and_then(|()| hub.wait("vacuum.robo", state, SOON));
        verdict.check(&format!("{service} leads to {state}"), done.map(drop));
    };
    order("vacuum/start", &robo, "cleaning");
    hub.off_the_dock()?;
    order("vacuum/pause", &robo, "paused");
    order("vacuum/return_to_base", &robo, "returning");
    order("vacuum/stop", &robo, "idle");
    let rooms = json!({
        "entity_id": "vacuum.robo", "command": "clean", "params": {"parts": [{"room": 1}, {"room": 2}], "passes": 1},
    });
    order("vacuum/send_command", &rooms, "cleaning");
    hub.off_the_dock()?;
    order("vacuum/stop", &robo, "idle");
    let speed = json!({"entity_id": "vacuum.robo", "fan_speed": "quiet"});
    hub.call("vacuum/set_fan_speed", &speed)?;
    let chosen = wait_for("the fan speed shows", SOON, || {
        let vacuum = hub.state("vacuum.robo")?;
        Ok((vacuum["attributes"]["fan_speed"] == "quiet").then_some(()))
    });
    verdict.check("the fan speed is chosen", chosen);
    let ended = wait_for("the end of a run shows", SOON, || {
        let event = hub.state("event.robo_run_ended")?;
        Ok((event["attributes"]["event_type"] == "stopped").then_some(()))
    });
    verdict.check("the end of a run is an event", ended);
    let lifted = hub.rig.home.hand(r#"{"c":"lift"}"#);
    let shown = lifted.and_then(|()| hub.wait("sensor.robo_error", "lifted", SOON));
    verdict.check("a lifted robot is an error", shown.map(drop));
    let put_down = hub.rig.home.hand(r#"{"c":"put-down"}"#);
    let shown = put_down.and_then(|()| hub.wait("sensor.robo_error", "none", SOON));
    verdict.check("and no more when it stands", shown.map(drop));
    Ok(())
}

fn broken(hub: &mut Hub, times: u32, verdict: &mut Verdict) -> anyhow::Result<()> {
    let before = hub.all_there(SOON)?;
    let mut slowest = Duration::ZERO;
    for _ in 0..times {
        hub.rig.broker.kill();
        sleep(Duration::from_millis(700));
        hub.rig.broker.start_again()?;
        let begun = Instant::now();
        let back = hub.all_there(Duration::from_secs(30));
        verdict.check("all is back after the broker was killed", back.map(drop));
        slowest = slowest.max(begun.elapsed());
    }
    verdict.figure("back_after_broker_s", slowest.as_secs_f64());
    hub.rig.home.kill_daemon();
    verdict.check(
        "without its daemon the robot is unavailable",
        hub.wait("vacuum.robo", "unavailable", SOON).map(drop),
    );
    hub.rig.home.start_daemon()?;
    let begun = Instant::now();
    let back = hub.all_there(BACK);
    verdict.figure("back_after_daemon_s", begun.elapsed().as_secs_f64());
    verdict.check("it is back within ten seconds", back.map(drop));
    hub.program = None;
    hub.start()?;
    let after = hub.all_there(Duration::from_secs(30));
    verdict.check(
        "after a restart of Home Assistant all is there, and no ghost",
        after.and_then(|after| {
            ensure!(after == before, "{before} entities before, {after} after");
            Ok(())
        }),
    );
    Ok(())
}
