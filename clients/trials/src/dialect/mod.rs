//! The REST interface that Valetudo's clients speak: asked, followed and driven by a client in Python, and the map drawn by a package that
//! Home Assistant's cameras draw it with. The card bundle of Valetudo's own project is on no registry that a test may use.

mod hand;
mod hostile;
mod map;
mod rig;

use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use serde_json::{Value, json};

use crate::Arguments;
use crate::program::{Program, output, wait_for};
use crate::verdict::Verdict;
use map::Frame;
use rig::{DialectRig, PASSWORD, SOON, STATE};

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let mut rig = DialectRig::start(arguments)?;
    let version = output(Command::new(&rig.python).arg("--version"))?;
    verdict.version(Some(version.trim().trim_start_matches("Python ")));
    wait_for("a map", SOON, || {
        let map = rig.read("robot/state/map")?;
        Ok((map["layers"] != json!([])).then_some(()))
    })?;
    verdict.check(
        "it says what it is, and never that it is Valetudo's",
        identity(&rig),
    );
    verdict.check(
        "who has no password, or another page, is kept out",
        strangers(&rig),
    );
    map::drawn(&rig, arguments, verdict);
    verdict.check("rooms are cleaned, and each state is pushed", rooms(&rig));
    verdict.check("a zone is cleaned where it lies", zone(&rig));
    verdict.check("it drives to a place and stands there", place(&rig));
    verdict.check("rooms get names, and walls come and go", changes(&rig));
    verdict.check("what cannot be is refused in words", refusals(&rig));
    verdict.check("a silent client stops the robot", hand::drive(&rig));
    verdict.check("the oldest of six followers leaves", crowd(&rig));
    let growth = hostile::attack(&rig);
    if let Ok(growth_mib) = &growth {
        verdict.figure("growth_under_attack_mib", *growth_mib);
    }
    verdict.check("hostile peers move nothing and fill nothing", growth.map(drop));
    hostile::load(&rig, verdict)?;
    // The daemon goes on with a job whose end is not in its newest checkpoint; it makes one each second.
    sleep(Duration::from_secs(2));
    rig.home.kill_daemon();
    verdict.check(
        "without its daemon the robot is in error",
        rig.wait_for_state(&["error"]),
    );
    rig.home.start_daemon()?;
    verdict.check(
        "it comes back with its daemon",
        rig.wait_for_state(&["idle", "docked"]),
    );
    Ok(())
}

fn identity(rig: &DialectRig) -> anyhow::Result<()> {
    let robot = rig.read("robot")?;
    ensure!(
        robot["implementation"] == "LibreRVAC" && robot["modelName"] == "sr8730",
        "{robot}"
    );
    let names = rig.read("robot/capabilities")?;
    let names = names.as_array().context("no list")?;
    let has = |name: &str| names.iter().any(|own| own == name);
    ensure!(
        has("MapSegmentationCapability") && has("LocateCapability") && !has("MapResetCapability"),
        "{names:?}"
    );
    let version = rig.read("valetudo/version")?;
    let release = version["release"].as_str().context("no release")?;
    ensure!(release.starts_with("LibreRVAC "), "{version}");
    let rooms = rig.read("robot/capabilities/MapSegmentationCapability")?;
    let view = rig.home_view()?;
    let count = view["rooms"].as_array().context("no rooms")?.len();
    ensure!(
        rooms.as_array().map(Vec::len) == Some(count) && count == 2,
        "{rooms}"
    );
    Ok(())
}

fn strangers(rig: &DialectRig) -> anyhow::Result<()> {
    for password in ["", "long enougH"] {
        let mut client = rig.client(password, &["read", STATE]);
        let told: Value = serde_json::from_str(&output(&mut client)?)?;
        ensure!(told[STATE]["code"] == 401, "{password:?}: {told}");
    }
    for (header, code) in [
        ("Host: evil.example", "421"),
        ("Host: localhost\r\nOrigin: http://evil.example", "403"),
    ] {
        let answer = hostile::raw(
            rig,
            &format!("GET /api/v2/robot HTTP/1.1\r\n{header}\r\nConnection: close\r\n\r\n"),
        )?;
        ensure!(
            answer.starts_with(&format!("HTTP/1.1 {code}")),
            "{header}: {answer}"
        );
    }
    Ok(())
}

fn rooms(rig: &DialectRig) -> anyhow::Result<()> {
    let log = rig.home.scratch.join("follow.log");
    let mut follower = Program::start(rig.client(PASSWORD, &["follow", STATE, "22"]), log)?;
    sleep(Duration::from_millis(500));
    let body =
        json!({"action": "start_segment_action", "segment_ids": ["2"], "iterations": 1, "customOrder": true});
    rig.order("MapSegmentationCapability", &body)?;
    rig.wait_for_state(&["cleaning"])?;
    rig.action("pause")?;
    rig.wait_for_state(&["paused"])?;
    rig.action("start")?;
    rig.wait_for_state(&["cleaning"])?;
    // Away from the dock, so that it has a way home.
    sleep(Duration::from_secs(5));
    rig.action("home")?;
    rig.wait_for_state(&["returning", "docked"])?;
    rig.action("stop")?;
    wait_for("the follower ends", Duration::from_secs(40), || {
        Ok((!follower.lives()).then_some(()))
    })?;
    let said = follower.said();
    let told: Value = serde_json::from_str(&said).with_context(|| said.clone())?;
    let events = told["events"].as_array().context("no events")?;
    let mut values: Vec<&str> = events
        .iter()
        .filter(|event| event["name"] == "StateAttributesUpdated")
        .filter_map(|event| event["data"][0]["value"].as_str())
        .collect();
    values.dedup();
    let wanted = ["cleaning", "paused", "cleaning", "returning"];
    let follows = values.windows(wanted.len()).any(|some| some == wanted);
    ensure!(follows, "{values:?}");
    ensure!(
        told["life"].as_u64().is_some_and(|life| life >= 1),
        "no sign of life: {told}"
    );
    Ok(())
}

/// The daemon writes down that a zone was cleaned; that it lies where it was drawn shows in the floor that was swept.
fn zone(rig: &DialectRig) -> anyhow::Result<()> {
    let view = rig.home_view()?;
    let dock = Frame::of(&view)?.place(&view["dock"])?;
    let corner =
        |dx: f64, dy: f64| json!({"x": (dock[0] + dx).round().to_string(), "y": (dock[1] + dy).round()});
    let points = json!({"pA": corner(-140.0, -40.0), "pB": corner(-60.0, -40.0), "pC": corner(-60.0, 40.0), "pD": corner(-140.0, 40.0)});
    let body = json!({"action": "clean", "zones": [{"points": points}], "iterations": 1});
    rig.order("ZoneCleaningCapability", &body)?;
    rig.wait_for_state(&["cleaning"])?;
    let swept = wait_for("floor is swept", Duration::from_secs(60), || {
        let map: Value = serde_json::from_str(&rig.home.told("map")?)?;
        let many = map["swept"].as_array().is_some_and(|swept| swept.len() > 400);
        Ok(many.then_some(map))
    })?;
    rig.action("stop")?;
    let frame = Frame::of(&view)?;
    let cell_m = swept["cell_m"].as_f64().context("no cell")?;
    let cells: Vec<f64> = swept["swept"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect();
    let inside = cells
        .chunks_exact(2)
        .filter_map(|cell| match cell {
            [x, y] => frame.place(&json!({"x": x * cell_m, "y": y * cell_m})).ok(),
            _ => None,
        })
        // The robot is as wide as this beyond the zone.
        .filter(|[x, y]| {
            (dock[0] - 180.0..dock[0] + 20.0).contains(x) && (dock[1] - 80.0..dock[1] + 80.0).contains(y)
        })
        .count();
    ensure!(
        inside * 2 * 10 > cells.len() * 9,
        "{inside} of {} cells",
        cells.len() / 2
    );
    Ok(())
}

/// It drives to the place and stands there.
fn place(rig: &DialectRig) -> anyhow::Result<()> {
    let view = rig.home_view()?;
    let [x, y] = Frame::of(&view)?.place(&view["dock"])?;
    let coordinates = json!({"x": (x - 250.0).round(), "y": y.round()});
    let body = json!({"action": "goto", "coordinates": coordinates});
    rig.order("GoToLocationCapability", &body)?;
    rig.wait_for_state(&["moving"])?;
    rig.wait_for_state(&["idle"])
}

fn changes(rig: &DialectRig) -> anyhow::Result<()> {
    let name = json!({"action": "rename_segment", "segment_id": 1, "name": "Kitchen"});
    rig.order("MapSegmentRenameCapability", &name)?;
    let view = rig.home_view()?;
    ensure!(view["rooms"].to_string().contains("Kitchen"), "{}", view["rooms"]);
    let wall = json!({"points": {"pA": {"x": 300, "y": 300}, "pB": {"x": 340, "y": 400}}});
    let both = |walls: Value| json!({"virtualWalls": walls, "restrictedZones": []});
    rig.order("CombinedVirtualRestrictionsCapability", &both(json!([wall])))?;
    let view = rig.home_view()?;
    let frame = Frame::of(&view)?;
    let ends = &view["no_go"][0]["shape"]["wall"];
    let [x_m, y_m] = [&ends[1][0], &ends[1][1]].map(|value| value.as_f64().unwrap_or(f64::NAN));
    let [x, y] = frame.place(&json!({"x": x_m, "y": y_m}))?;
    ensure!(
        (x - 340.0).abs() < 0.1 && (y - 400.0).abs() < 0.1,
        "{ends} is {x} {y}"
    );
    let told = rig.read("robot/capabilities/CombinedVirtualRestrictionsCapability")?;
    ensure!(told == both(json!([wall])), "{told}");
    rig.order("CombinedVirtualRestrictionsCapability", &told)?;
    ensure!(
        rig.home_view()?["no_go"] == view["no_go"],
        "the same list changed something"
    );
    rig.order("CombinedVirtualRestrictionsCapability", &both(json!([])))?;
    ensure!(rig.home_view()?["no_go"].is_null(), "the wall is still there");
    Ok(())
}

fn refusals(rig: &DialectRig) -> anyhow::Result<()> {
    let room = json!({"action": "start_segment_action", "segment_ids": [99]});
    for (capability, body, code, word) in [
        ("MapSegmentationCapability", room, 400, "no-such-room"),
        ("MapSegmentationCapability", json!([]), 400, "action"),
        (
            "BasicControlCapability",
            json!({"action": "fly"}),
            400,
            "start, stop",
        ),
        (
            "FanSpeedControlCapability/preset",
            json!({"name": "turbo"}),
            400,
            "medium",
        ),
        (
            "GoToLocationCapability",
            json!({"action": "goto"}),
            400,
            "coordinates",
        ),
        ("MapResetCapability", json!({"action": "reset"}), 404, "no such"),
        ("NothingCapability", json!({}), 404, "no such"),
        ("MapSegmentationCapability/properties", json!({}), 405, "GET"),
        (
            "MapSnapshotCapability",
            json!({"action": "restore", "id": "77"}),
            400,
            "77",
        ),
    ] {
        let told = rig.put(capability, &body)?;
        let text = told["text"].as_str().unwrap_or_default();
        ensure!(
            told["code"] == code && text.contains(word),
            "{capability} {body}: {told}"
        );
    }
    let half = json!({"virtualWalls": []});
    let told = rig.put("CombinedVirtualRestrictionsCapability", &half)?;
    ensure!(told["code"] == 400, "{told}");
    Ok(())
}

fn crowd(rig: &DialectRig) -> anyhow::Result<()> {
    let told = rig.told(&["crowd", "robot/state/map", "6"])?;
    ensure!(told == json!({"left": [0]}), "{told}");
    Ok(())
}
