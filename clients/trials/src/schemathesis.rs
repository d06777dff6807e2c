//! schemathesis makes hundreds of requests out of the panel server's own description, right ones and wrong ones, and compares every answer with
//! it.

use std::process::Command;

use anyhow::Context as _;

use crate::Arguments;
use crate::home::Home;
use crate::process::{Server, beside};
use crate::verdict::Verdict;

/// Requests for each address and way of being wrong.
const EXAMPLES: &str = "50";

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let program = arguments.schemathesis.as_ref().context("--schemathesis")?;
    let version = String::from_utf8(Command::new(program).arg("--version").output()?.stdout)?;
    verdict.version(version.split_whitespace().last());
    let home = Home::start()?;
    let assets = home.scratch.join("assets");
    std::fs::create_dir_all(&assets)?;
    std::fs::write(assets.join("index.html"), "<!doctype html><title>panel</title>")?;
    let mut serve = Command::new(beside("panel-server")?);
    serve.arg("--vthal").arg(home.socket());
    serve.arg("--assets").arg(&assets).args(["--port", "0"]);
    let server = Server::start(serve)?;
    let site = format!("http://127.0.0.1:{}", server.port()?);
    let said = Command::new(program)
        // It leaves what it found where it stands.
        .current_dir(home.scratch.join(""))
        .arg("run")
        .arg(format!("{site}/api/openapi.json"))
        .args([
            "--max-examples",
            EXAMPLES,
            "--request-timeout",
            "10",
            "--no-color",
        ])
        .args(["--header", "X-Rvac: 1", "--header", &format!("Origin: {site}")])
        // On the robot's own computer, without pairing, everybody is an administrator; and no request is the beginning of a WebSocket.
        .args(["--exclude-checks", "ignored_auth", "--exclude-path", "/api/ws"])
        .output()?;
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    if let Some(cases) = text.lines().find_map(|line| line.split_once(" generated, ")) {
        verdict.figure("requests", cases.0.trim().parse().unwrap_or_default());
    }
    verdict.holds(
        "every answer is one that the description has",
        said.status.success(),
        &findings(&text),
    );
    Ok(())
}

/// The part of the report that a person reads.
fn findings(text: &str) -> &str {
    text.find("FAILURES")
        .and_then(|at| text.get(at..))
        .unwrap_or(text)
}
