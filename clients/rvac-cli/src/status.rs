//! What the robot is doing and how sure it is, in words.

use std::io::{Write as _, stdout};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_api::{DeviceTable, Lacking, Status, Topic, Update};

use crate::arguments::{StatusOptions, WatchOptions};
use crate::home::sureness;
use crate::plain::one_line;
use crate::socket::{Connection, Message};

/// Status comes at once, the device table twice a second.
const PATIENCE: Duration = Duration::from_secs(10);

/// Prints status and device table once.
pub(crate) fn print(options: &StatusOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&options.daemon)?;
    // Views come in this order; a daemon without a robot has no estimate.
    connection.watch(vec![Topic::Status, Topic::Estimate, Topic::Device])?;
    let deadline = Instant::now() + PATIENCE;
    let (mut hello, mut status, mut estimate, mut device) = (None, None, None, None);
    while status.is_none() || device.is_none() {
        let Some(message) = connection.receive_until(deadline)? else {
            bail!("vthal told no status within {} s", PATIENCE.as_secs());
        };
        match &message.update {
            Some(Update::Hello { robot, .. }) => hello = robot.is_some().then_some(message),
            Some(Update::Status(_)) => status = Some(message),
            Some(Update::Estimate(_)) => estimate = Some(message),
            Some(Update::Device(_)) => device = Some(message),
            Some(Update::Failed(failure)) => bail!("refused ({}): {}", failure.reason, failure.text),
            _ => {}
        }
    }
    // What a robot is, is for people; programs ask for it with hello.
    let hello = hello.filter(|_| !options.json);
    for message in [status, estimate, device, hello].into_iter().flatten() {
        if !options.json && in_words(&message).is_none() {
            continue;
        }
        writeln!(
            stdout(),
            "{}",
            if options.json {
                message.text
            } else {
                in_words(&message).unwrap_or_default()
            }
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints changes line by line.
pub(crate) fn watch(options: &WatchOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&options.daemon)?;
    connection.watch(vec![
        Topic::Status,
        Topic::Device,
        Topic::Pose,
        Topic::Estimate,
        Topic::Decisions,
        Topic::Log,
    ])?;
    let mut lines_left = options.lines.unwrap_or(u64::MAX);
    while lines_left > 0 {
        let message = connection.receive()?;
        let line = if options.json {
            Some(message.text)
        } else {
            in_words(&message).map(|line| one_line(&line))
        };
        if let Some(line) = line {
            writeln!(stdout(), "{line}")?;
            lines_left -= 1;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn in_words(message: &Message) -> Option<String> {
    match message.update.as_ref()? {
        Update::Status(status) => Some(status_in_words(status)),
        Update::Device(device) => Some(device_in_words(device)),
        Update::Hello { robot, .. } => lacking_in_words(&robot.as_ref()?.lacking),
        Update::Pose(pose) => Some(format!(
            "pose      x {:.2} m, y {:.2} m, heading {:.0} deg",
            pose.x,
            pose.y,
            pose.heading.to_degrees()
        )),
        Update::Estimate(estimate) => Some(format!("estimate  {}", sureness(estimate))),
        Update::Decision(decision) => Some(format!("decided   {:.3} {}", decision.t, decision.text)),
        Update::Log(entry) => Some(format!(
            "log       {:.3} {:?} {}: {}",
            entry.t, entry.level, entry.part, entry.text
        )),
        Update::Failed(failure) => Some(format!("refused   {}: {}", failure.reason, failure.text)),
        _ => None,
    }
}

fn status_in_words(status: &Status) -> String {
    let mut line = format!("status    {} ({})", status.state, status.reason);
    if let Some(strategy) = &status.strategy {
        line += &format!(", pattern {strategy}");
    }
    line += &format!(
        ", {:.1} min, {:.1} m2 cleaned, {:.1} m driven, {} bumps",
        status.job_s / 60.0,
        status.swept_m2,
        status.path_m,
        status.bumps
    );
    if let Some(room) = &status.room {
        line += &format!(", in {}", room.title());
    }
    if !status.inhibits.is_empty() {
        line += &format!(", held by {}", status.inhibits.join(", "));
    }
    if let Some(driver) = &status.driver {
        line += &format!(", driven by {driver}");
    }
    line
}

/// What the robot lacks until somebody measures something; nothing if it lacks nothing.
fn lacking_in_words(lacking: &[Lacking]) -> Option<String> {
    let lines: Vec<String> = lacking
        .iter()
        .map(|one| format!("lacks     {}: measure {}", one.ability, one.values.join(", ")))
        .collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

fn device_in_words(device: &DeviceTable) -> String {
    let link = &device.link;
    let mut line = format!(
        "device    link {}, {:.1} % bad",
        if link.up { "up" } else { "down" },
        100.0 * link.bad_share
    );
    if let Some(round_trip_ms) = link.round_trip_ms {
        line += &format!(", {round_trip_ms:.1} ms round trip");
    }
    if let Some(battery) = &device.battery {
        line += &format!(
            ", battery {:.0} % {:.1} V {} ",
            100.0 * battery.charge,
            battery.voltage_v,
            battery.state
        );
    }
    let line = line.trim_end().to_owned();
    if device.docked {
        line + ", on the dock"
    } else {
        line
    }
}
