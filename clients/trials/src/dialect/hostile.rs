//! Peers that mean no good, and what the server takes.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::thread::sleep;
use std::time::Duration;

use anyhow::ensure;

use super::rig::{DialectRig, SOON, STATE};
use crate::process::{core_share, resident_mib};
use crate::program::wait_for;
use crate::verdict::Verdict;

/// A board of a robot has little of both. These are for a development build, which is larger than what a package holds.
const RESIDENT_MIB_MAX: f64 = 16.0;
const SHARE_MAX: f64 = 0.08;
/// Hostile peers may cost so much, and no more.
const GROWTH_MIB_MAX: f64 = 4.0;

/// `robo:long enough`.
const LOGIN: &str = "Authorization: Basic cm9ibzpsb25nIGVub3VnaA==\r\nHost: localhost\r\n";

/// Bytes as they are, and what comes back.
pub(super) fn raw(rig: &DialectRig, request: &str) -> anyhow::Result<String> {
    let mut stream = TcpStream::connect(("127.0.0.1", rig.port))?;
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    stream.write_all(request.as_bytes())?;
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).ok(); // A server that resets has said what it had to say.
    Ok(String::from_utf8_lossy(&answer).into_owned())
}

/// Peers that send what is none, hold connections open, and read nothing.
pub(super) fn attack(rig: &DialectRig) -> anyhow::Result<f64> {
    let before = resident_mib(rig.server.id(), "VmRSS")?;
    let mut held = Vec::new();
    for number in 0..200 {
        // One that the server does not take is closed, which is as well.
        let Ok(mut stream) = TcpStream::connect(("127.0.0.1", rig.port)) else {
            continue;
        };
        let words = match number % 3 {
            0 => format!("GET /api/v2/robot/state/map/sse HTTP/1.1\r\n{LOGIN}\r\n"),
            1 => format!(
                "PUT /api/v2/robot/capabilities/BasicControlCapability HTTP/1.1\r\n{LOGIN}Content-Type: application/json\r\nContent-Length: 60000\r\n\r\n{{"
            ),
            _ => "GET /api/v2/robot HT".to_owned(),
        };
        stream.write_all(words.as_bytes()).ok();
        held.push(stream);
    }
    sleep(Duration::from_secs(3));
    drop(held);
    wait_for("a seat is free", SOON, || {
        let answer = raw(
            rig,
            &format!("GET /api/v2/robot HTTP/1.1\r\nConnection: close\r\n{LOGIN}\r\n"),
        )?;
        Ok(answer.starts_with("HTTP/1.1 200").then_some(()))
    })?;
    for (request, codes) in &no_commands() {
        let answer = raw(rig, request)?;
        let code = answer.split(' ').nth(1).unwrap_or_default();
        let shown: String = request.chars().take(200).collect();
        ensure!(codes.contains(code) && !code.is_empty(), "{shown}: {answer}");
    }
    let told = rig.read(STATE)?;
    ensure!(told[0]["value"] != "cleaning", "it moves: {told}");
    let after = resident_mib(rig.server.id(), "VmRSS")?;
    ensure!(after - before < GROWTH_MIB_MAX, "{before} MiB became {after}");
    Ok(after - before)
}

/// Requests that ask for nothing that can be done, and the codes that say so.
fn no_commands() -> Vec<(String, &'static str)> {
    let put = "PUT /api/v2/robot/capabilities/BasicControlCapability HTTP/1.1\r\nConnection: close\r\nContent-Type: application/json\r\n";
    let body = |text: &str| format!("{put}{LOGIN}Content-Length: {}\r\n\r\n{text}", text.len());
    let deep = "[".repeat(50_000);
    vec![
        (
            format!("GET /api/v2/{} HTTP/1.1\r\n{LOGIN}\r\n", "x".repeat(64 << 10)),
            "431 414 400",
        ),
        (
            format!(
                "GET /api/v2/robot/capabilities/{} HTTP/1.1\r\nConnection: close\r\n{LOGIN}\r\n",
                "%1f".repeat(2_000)
            ),
            "404",
        ),
        (body(r#"{"action":["start"]}"#), "400"),
        (body(r#"{"action":"start","action":"start""#), "400"),
        (body(&deep), "400"),
        (body("null"), "400"),
        (format!("{put}{LOGIN}Content-Length: 99999999\r\n\r\n"), "400 413"),
        (
            format!("{put}{LOGIN}Content-Length: 18\r\nContent-Length: 3\r\n\r\n{{\"action\":\"start\"}}"),
            "400",
        ),
        (
            body(r#"{"action":"start"}"#).replace("application/json", "text/plain"),
            "415",
        ),
    ]
}

/// What the server takes at telemetry of 50 Hz with somebody who follows the map.
pub(super) fn load(rig: &DialectRig, verdict: &mut Verdict) -> anyhow::Result<()> {
    let id = rig.server.id();
    let rest = core_share(id, || {
        sleep(Duration::from_secs(8));
        Ok(())
    })?;
    rig.action("start")?;
    rig.wait_for_state(&["cleaning"])?;
    let cleaning = core_share(id, || rig.told(&["follow", "robot/state", "10"]).map(drop))?;
    rig.action("stop")?;
    for (name, share) in [("rest_core_share", rest), ("cleaning_core_share", cleaning)] {
        verdict.figure(name, share);
        verdict.holds(&format!("{name} is below {SHARE_MAX}"), share < SHARE_MAX, &share);
    }
    let resident = resident_mib(id, "VmRSS")?;
    verdict.figure("resident_mib", resident);
    verdict.holds("its memory is small", resident < RESIDENT_MIB_MAX, &resident);
    Ok(())
}
