//! Cyclone DDS in Python, with messages by the definitions of ROS 2 itself, reads the robot and drives it.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use rvac_api::Update;
use serde_json::Value;

use crate::Arguments;
use crate::home::Home;
use crate::process::{Server, core_share, resident_mib};
use crate::program::{output, python_package, wait_for};
use crate::verdict::Verdict;

/// Of nobody else on this machine, one hopes: each process of ours takes one of a hundred.
const FIRST_DOMAIN: u32 = 100;
/// Finds peers on this machine without multicast, which loopback often lacks.
const CYCLONE: &str = "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast><Interfaces>\
    <NetworkInterface address=\"127.0.0.1\"/></Interfaces></General><Discovery><ParticipantIndex>auto\
    </ParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";
/// The daemon's lease, a beat of the robot, and the readings of 20 a second in which the peer sees it.
const STANDS_WITHIN_S: f64 = 0.4 + 0.5;

/// The peer, as a command each time.
struct Peer<'a> {
    python: &'a Path,
    domain: String,
}

impl Peer<'_> {
    fn tell(&self, work: &str, more: &[&str]) -> anyhow::Result<Value> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/ros2.py");
        let mut command = Command::new(self.python);
        command.arg(script).arg(work).arg(&self.domain).args(more);
        let told = output(command.env("CYCLONEDDS_URI", CYCLONE))?;
        Ok(serde_json::from_str(told.trim())?)
    }

    fn drive(&self, speeds: [&str; 2]) -> anyhow::Result<Value> {
        self.tell("drive", &[speeds[0], speeds[1], "3"])
    }

    fn call(&self, service: &str) -> anyhow::Result<Value> {
        self.tell("call", &[service])
    }
}

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let python = arguments.ros2_python.as_deref().context("--ros2-python")?;
    verdict.version(Some(&python_package(python, "cyclonedds")?));
    let mut home = Home::start()?;
    let domain = (FIRST_DOMAIN + std::process::id() % 100).to_string();
    let mut command = Command::new(arguments.ros2.as_ref().context("--ros2")?);
    command.arg("--vthal").arg(home.socket());
    command.args([
        "--domain",
        &domain,
        "--network",
        "127.0.0.1",
        "--middleware",
        "cyclone",
    ]);
    let bridge = Server::start(command)?;
    let peer = Peer { python, domain };
    let seen = peer.tell("see", &["6"])?;
    verdict.check("each topic comes, in the frames of REP-105", frames(&seen));
    verdict.check("the map has the floor that the daemon tells", floor(&home, &seen));
    driven(&peer, verdict)?;
    verdict.check("a stop holds against a stream of commands", stopped(&home, &peer));
    served(&home, (&peer, &bridge), verdict)?;
    docked(&home, &peer, verdict)?;
    verdict.check("a daemon that was killed is seen", back_again(&mut home, &peer));
    Ok(())
}

fn frames(seen: &Value) -> anyhow::Result<()> {
    for topic in ["/tf", "/odom", "/map", "/battery_state", "/diagnostics"] {
        ensure!(
            seen[topic]["count"].as_u64().is_some_and(|count| count > 0),
            "nothing on {topic}: {seen}"
        );
    }
    let odom = &seen["/odom"];
    ensure!(odom["frame"] == "odom" && odom["child"] == "base_link", "{odom}");
    ensure!(
        odom["age_s"].as_f64().is_some_and(|age| age.abs() < 1.0),
        "{odom}"
    );
    ensure!(
        seen["/tf"]["links"] == serde_json::json!([["map", "odom"], ["odom", "base_link"]]),
        "{}",
        seen["/tf"]
    );
    let battery = &seen["/battery_state"];
    ensure!(
        battery["percentage"]
            .as_f64()
            .is_some_and(|share| share > 0.0 && share <= 1.0),
        "{battery}"
    );
    Ok(())
}

fn floor(home: &Home, seen: &Value) -> anyhow::Result<()> {
    let told = home.told("home")?;
    let Ok(Update::Home(view)) = serde_json::from_str(&told) else {
        anyhow::bail!("the daemon tells no home: {}", &told[..told.len().min(200)]);
    };
    let free: u64 = view
        .cells
        .chunks_exact(2)
        .filter(|run| run[0] == 1)
        .map(|run| u64::from(run[1]))
        .sum();
    let map = &seen["/map"];
    ensure!(map["frame"] == "map", "{map}");
    ensure!(
        free > 1000 && map["free"].as_u64() == Some(free),
        "{free} free, {map}"
    );
    let corner = f64::from(view.x) * view.cell_m;
    ensure!(
        map["origin"][0]
            .as_f64()
            .is_some_and(|x| (x - corner).abs() < 1e-6),
        "{map}"
    );
    Ok(())
}

fn driven(peer: &Peer<'_>, verdict: &mut Verdict) -> anyhow::Result<()> {
    let told = peer.drive(["-0.15", "0.0"])?;
    let way_m = told["way_m"].as_f64().unwrap_or_default();
    let stood_after_s = told["stood_after_s"].as_f64().unwrap_or(f64::INFINITY);
    verdict.figure("driven_m", way_m);
    verdict.figure("stood_after_s", stood_after_s);
    verdict.holds("it drives by /cmd_vel", (0.35..=0.6).contains(&way_m), &told);
    verdict.holds(
        "the robot stands when its commander falls silent",
        (0.0..=STANDS_WITHIN_S).contains(&stood_after_s),
        &told,
    );
    let told = peer.drive(["nan", "0.5"])?;
    let way_m = told["way_m"].as_f64().unwrap_or(f64::INFINITY);
    verdict.holds("what is no number moves nothing", way_m < 0.005, &told);
    Ok(())
}

/// A person stops the robot while commands go on for seconds.
fn stopped(home: &Home, peer: &Peer<'_>) -> anyhow::Result<()> {
    let told = std::thread::scope(|scope| {
        let driving = scope.spawn(|| peer.tell("drive", &["-0.1", "0.0", "6"]));
        let stop = wait_for("a driver", Duration::from_secs(15), || {
            let status = home.told("status")?;
            Ok(status.contains(r#""driver":"rvac-ros2""#).then_some(()))
        })
        .and_then(|()| {
            // So that it has moved.
            std::thread::sleep(Duration::from_secs(1));
            home.order(r#"{"c":"stop"}"#)
        });
        let told = driving.join().map_err(|_| anyhow::anyhow!("the peer failed"))?;
        stop.and(told)
    })?;
    let stood_after_s = told["stood_after_s"].as_f64().unwrap_or(f64::INFINITY);
    ensure!(
        stood_after_s < -2.0 && told["way_m"].as_f64().is_some_and(|way| way > 0.0),
        "{told}"
    );
    Ok(())
}

fn served(home: &Home, (peer, bridge): (&Peer<'_>, &Server), verdict: &mut Verdict) -> anyhow::Result<()> {
    let told = peer.call("clean")?;
    verdict.holds("a service starts a job", told["success"] == true, &told);
    verdict.check(
        "the job is seen in /diagnostics",
        wait_for("cleaning", Duration::from_secs(30), || {
            let seen = peer.tell("see", &["1.5"])?;
            let robot = &seen["/diagnostics"]["parts"]["vacuum: robot"];
            Ok(robot[1]
                .as_str()
                .is_some_and(|text| text.starts_with("cleaning"))
                .then_some(()))
        }),
    );
    let share = core_share(bridge.id(), || peer.tell("see", &["4"]).map(drop))?;
    verdict.figure("cleaning_core_share", share);
    verdict.figure("resident_mib", resident_mib(bridge.id(), "VmRSS")?);
    let told = peer.call("clean")?;
    let message = told["message"].as_str().unwrap_or_default();
    verdict.holds(
        "a refusal comes with its name",
        told["success"] == false && message.contains(": "),
        &told,
    );
    let told = peer.call("stop")?;
    verdict.holds("a service ends it", told["success"] == true, &told);
    home.order(r#"{"c":"stop"}"#)
}

/// The status of a goal: `STATUS_SUCCEEDED` and `STATUS_CANCELED` of `action_msgs/GoalStatus`.
const SUCCEEDED: i64 = 4;
const CANCELED: i64 = 5;

fn docked(home: &Home, peer: &Peer<'_>, verdict: &mut Verdict) -> anyhow::Result<()> {
    // Away from its dock first.
    home.order(r#"{"c":"start"}"#)?;
    std::thread::sleep(Duration::from_secs(20));
    home.order(r#"{"c":"stop"}"#)?;
    let told = peer.tell("dock", &["1.5"])?;
    verdict.holds(
        "a goal of DockRobot can be cancelled",
        told["status"] == CANCELED && told["success"] == false,
        &told,
    );
    let status = home.told("status")?;
    verdict.holds(
        "then the robot stands",
        status.contains(r#""state":"idle""#),
        &status,
    );
    let told = peer.tell("dock", &["0"])?;
    verdict.holds(
        "a goal of DockRobot brings it home",
        told["status"] == SUCCEEDED && told["success"] == true,
        &told,
    );
    Ok(())
}

fn back_again(home: &mut Home, peer: &Peer<'_>) -> anyhow::Result<()> {
    home.kill_daemon();
    let told = peer.call("dock")?;
    ensure!(told["success"] == false, "{told}");
    home.start_daemon()?;
    wait_for("odometry again", Duration::from_secs(20), || {
        let seen = peer.tell("see", &["2"])?;
        Ok(seen["/odom"]["count"]
            .as_u64()
            .is_some_and(|count| count > 5)
            .then_some(()))
    })
}
