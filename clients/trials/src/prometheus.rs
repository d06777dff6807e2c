//! A real Prometheus that collects the robot's figures, and its linter.

use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::Arguments;
use crate::home::Home;
use crate::http::Site;
use crate::process::{self, beside};
use crate::program::{Program, free_port, version_in, wait_for};
use crate::verdict::Verdict;

/// Dashboard whose every question must be one that Prometheus answers.
const DASHBOARD: &str = "../../packaging/grafana/librervac.json";
/// Figures of this that have an answer only after a stop or a day.
const LATER: [&str; 2] = ["rvac_stops_total", "rvac_wear_ratio"];

pub(crate) fn trial(_arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let version = version_in(Command::new("prometheus").arg("--version"))?;
    verdict.version(version.as_deref());
    let home = Home::start()?;
    let mut command = Command::new(beside("rvac-metrics")?);
    command.arg("--vthal").arg(home.socket()).args(["--port", "0"]);
    let bridge = process::Server::start(command)?;
    let port = bridge.port()?;
    let figures = Site { port, token: None };
    let page = wait_for("the battery is on the page", Duration::from_secs(10), || {
        let page = figures.get("/metrics")?.text();
        Ok(page.contains("rvac_battery_charge_ratio ").then_some(page))
    })?;
    verdict.check("promtool finds nothing wrong", linted(&home, &page));
    let prometheus = collecting(&home, port)?;
    let asked = Site {
        port: prometheus.1,
        token: None,
    };
    verdict.check(
        "it collects the figures",
        wait_for("an answer", Duration::from_secs(15), || {
            let charge = value_of(&asked, "rvac_battery_charge_ratio")?;
            Ok(charge.filter(|charge| *charge > 0.0).map(drop))
        }),
    );
    sleep(Duration::from_secs(2));
    verdict.check("it answers each question of the dashboard", dashboard(&asked));
    home.order(r#"{"c":"start"}"#)?;
    verdict.check(
        "it sees the robot clean",
        wait_for("cleaning", Duration::from_secs(20), || {
            let cleans = value_of(&asked, "rvac_activity{activity=\"cleaning\"}")?;
            Ok(cleans.filter(|cleans| *cleans > 0.5).map(drop))
        }),
    );
    home.order(r#"{"c":"stop"}"#)?;
    verdict.check(
        "it counts the run that ended",
        wait_for("a run", Duration::from_secs(20), || {
            let runs = value_of(&asked, "rvac_runs_total{result=\"stopped\"}")?;
            Ok(runs.filter(|runs| *runs > 0.5).map(drop))
        }),
    );
    drop(home);
    verdict.check(
        "without its daemon the robot has no figures",
        wait_for("down", Duration::from_secs(15), || {
            let up = value_of(&asked, "rvac_daemon_up")?;
            Ok(up.filter(|up| *up < 0.5).map(drop))
        }),
    );
    Ok(())
}

fn linted(home: &Home, page: &str) -> anyhow::Result<()> {
    let file = home.scratch.join("page");
    std::fs::write(&file, page)?;
    let lint = Command::new("promtool")
        .args(["check", "metrics"])
        .stdin(Stdio::from(std::fs::File::open(&file)?))
        .output()
        .context("cannot start promtool")?;
    let said = String::from_utf8_lossy(&lint.stderr).into_owned();
    ensure!(lint.status.success() && said.trim().is_empty(), "{said}");
    Ok(())
}

/// Prometheus, and its port.
fn collecting(home: &Home, of: u16) -> anyhow::Result<(Program, u16)> {
    let port = free_port()?;
    let file = home.scratch.join("prometheus.yml");
    let text = format!(
        "scrape_configs:\n  - job_name: librervac\n    scrape_interval: 1s\n    static_configs:\n      - targets: [\"127.0.0.1:{of}\"]\n        labels: {{robot: robo}}\n"
    );
    std::fs::write(&file, text)?;
    let mut command = Command::new("prometheus");
    command.arg(format!("--config.file={}", file.display()));
    command.arg(format!(
        "--storage.tsdb.path={}",
        home.scratch.join("prometheus").display()
    ));
    command.arg(format!("--web.listen-address=127.0.0.1:{port}"));
    // It is awaited by what it answers.
    Ok((
        Program::start(command, home.scratch.join("prometheus.log"))?,
        port,
    ))
}

fn answer_of(server: &Site, question: &str) -> anyhow::Result<Value> {
    let question: String = question
        .bytes()
        .map(|byte| match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'_' => char::from(byte).to_string(),
            byte => format!("%{byte:02x}"),
        })
        .collect();
    let answer = server.get_json(&format!("/api/v1/query?query={question}"))?;
    ensure!(answer["status"] == "success", "{answer}");
    Ok(answer["data"]["result"].clone())
}

fn value_of(server: &Site, question: &str) -> anyhow::Result<Option<f64>> {
    let answer = answer_of(server, question)?;
    Ok(answer[0]["value"][1]
        .as_str()
        .and_then(|value| value.parse().ok()))
}

fn dashboard(server: &Site) -> anyhow::Result<()> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(DASHBOARD);
    let dashboard: Value = serde_json::from_slice(&std::fs::read(file)?)?;
    let panels = dashboard["panels"].as_array().context("no panels")?;
    let mut questions = 0;
    for target in panels
        .iter()
        .filter_map(|panel| panel["targets"].as_array())
        .flatten()
    {
        let question = target["expr"]
            .as_str()
            .context("no question")?
            .replace("$robot", ".*");
        questions += 1;
        let answer = answer_of(server, &question).with_context(|| question.clone())?;
        // Nothing is the matter, and nothing has stopped yet.
        let may_be_empty =
            question.starts_with("rvac_trouble") || LATER.iter().any(|name| question.contains(name));
        ensure!(may_be_empty || answer[0].is_object(), "no answer to {question}");
    }
    ensure!(questions >= 10, "only {questions} questions");
    Ok(())
}
