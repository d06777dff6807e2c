//! Notifications and the calendar, taken and read by Python: its HTTP server, its reader of mails, and the package icalendar.

use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::Arguments;
use crate::home::Home;
use crate::http::Site;
use crate::process::{self, beside};
use crate::program::{Program, free_port, output, wait_for};
use crate::verdict::Verdict;

/// Every morning.
const SCHEDULE: &str = r#"{"c":"add-schedule","name":"Mornings","job":{"clean":{}},"when":{"weekly":{"days":["mo","tu","we","th","fr","sa","su"],"at":"07:30"}}}"#;
const SOON: Duration = Duration::from_secs(15);

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/receiver.py")
}

/// What a mail or calendar says, as Python reads it.
pub(crate) fn read(python: &Path, kind: &str, file: &Path) -> anyhow::Result<Value> {
    let told = output(Command::new(python).arg(script()).arg(kind).arg(file))?;
    Ok(serde_json::from_str(told.trim())?)
}

pub(crate) fn trial(arguments: &Arguments, verdict: &mut Verdict) -> anyhow::Result<()> {
    let python = arguments.python.clone().unwrap_or_else(|| "python3".into());
    let version = output(Command::new(&python).arg("--version"))?;
    verdict.version(Some(version.trim().trim_start_matches("Python ")));
    let home = Home::start()?;
    let port = free_port()?;
    let heard = home.scratch.join("heard");
    let mut command = Command::new(&python);
    command.arg(script()).arg(port.to_string()).arg(&heard);
    let _receiver = Program::start(command, home.scratch.join("receiver.log"))?;
    let bridge = bridge(&home, port)?;
    home.order(SCHEDULE).context("a schedule")?;
    home.order(r#"{"c":"start"}"#)?;
    std::thread::sleep(Duration::from_secs(3));
    home.order(r#"{"c":"stop"}"#)?;
    told_over_http(&heard, verdict);
    let mail = home.scratch.join("mail");
    let mail = wait_for("a mail", SOON, || Ok(mail.is_file().then(|| mail.clone())));
    verdict.check(
        "a mail has text and picture",
        mail.and_then(|file| {
            let mail = read(&python, "mail", &file)?;
            ensure!(
                mail["picture"] == true && mail["to"] == "me@home.example",
                "{mail}"
            );
            ensure!(mail["defects"].as_array().is_some_and(Vec::is_empty), "{mail}");
            ensure!(
                mail["text"].as_str().is_some_and(|text| text.contains("m²")),
                "{mail}"
            );
            Ok(())
        }),
    );
    verdict.check(
        "the calendar has the past run and those to come",
        calendar(&home, &python, bridge.port()?),
    );
    Ok(())
}

/// What the two targets of HTTP were sent.
fn told_over_http(heard: &Path, verdict: &mut Verdict) {
    let requests = wait_for("two requests", SOON, || {
        let text = std::fs::read_to_string(heard).unwrap_or_default();
        let requests: Vec<Value> = text
            .lines()
            .map_while(|line| serde_json::from_str(line).ok())
            .collect();
        Ok((requests.len() >= 2).then_some(requests))
    });
    let requests = requests.unwrap_or_default();
    let find = |path: &str| {
        requests
            .iter()
            .find(|one| one["path"] == path)
            .with_context(|| format!("nothing on {path}"))
    };
    verdict.check(
        "a topic of ntfy gets title, message and picture",
        find("/topic").and_then(|one| {
            ensure!(one["picture"] == true && one["priority"] == "default", "{one}");
            ensure!(
                one["title"].as_str().is_some_and(|title| title.contains("Robo")),
                "{one}"
            );
            ensure!(
                one["message"].as_str().is_some_and(|text| !text.is_empty()),
                "{one}"
            );
            Ok(())
        }),
    );
    verdict.check(
        "a webhook gets JSON with the picture",
        find("/hook").and_then(|one| {
            ensure!(one["picture"] == true && one["told"]["event"] == "ended", "{one}");
            Ok(())
        }),
    );
}

fn bridge(home: &Home, port: u16) -> anyhow::Result<process::Server> {
    let sendmail = home.scratch.join("sendmail");
    let mail = home.scratch.join("mail");
    // Whole when it appears.
    let text = format!("#!/bin/sh\ncat > {0}.part && mv {0}.part {0}\n", mail.display());
    std::fs::write(&sendmail, text)?;
    std::fs::set_permissions(&sendmail, std::fs::Permissions::from_mode(0o755))?;
    let configuration = format!(
        "vthal = {:?}\nname = \"Robo\"\n[calendar]\nport = 0\n\
         [[target]]\nkind = \"ntfy\"\nurl = \"http://127.0.0.1:{port}/topic\"\n\
         [[target]]\nkind = \"webhook\"\nurl = \"http://127.0.0.1:{port}/hook\"\nwhen = [\"ended\"]\n\
         [[target]]\nkind = \"mail\"\nto = \"me@home.example\"\nsendmail = {:?}\n",
        home.socket().display().to_string(),
        sendmail.display().to_string(),
    );
    let file = home.scratch.join("rvac-hooks.toml");
    std::fs::write(&file, configuration)?;
    let mut command = Command::new(beside("rvac-hooks")?);
    command.arg("--config").arg(&file);
    process::Server::start(command)
}

fn calendar(home: &Home, python: &Path, port: u16) -> anyhow::Result<()> {
    let server = Site { port, token: None };
    let answer = server.get("/runs.ics")?;
    ensure!(
        answer.head.to_ascii_lowercase().contains("text/calendar"),
        "{}",
        answer.head
    );
    let file = home.scratch.join("runs.ics");
    std::fs::write(&file, &answer.body)?;
    let calendar = read(python, "calendar", &file)?;
    let events = calendar["events"].as_array().context("no events")?;
    ensure!(
        calendar["name"] == "Robo" && calendar["errors"] == 0,
        "{calendar}"
    );
    let coming = events
        .iter()
        .filter(|event| event["title"] == "Robo: Mornings")
        .count();
    ensure!(events.len() > coming && coming >= 7, "{calendar}");
    Ok(())
}
